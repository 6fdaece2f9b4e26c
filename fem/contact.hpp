#pragma once
// Contact of a structure with rigid walls, by penalty and without friction: a node of its surface that is through a wall
// by d is pushed back along the wall's normal with k d.

#include <Eigen/Dense>
#include <functional>
#include <span>
#include <vector>

#include "core/wall_faces.hpp"
#include "fem/solid.hpp"

namespace greenwater {

/// The faces that a structure may touch.
struct ContactWalls {
  int dim = 2;  // 2: segments, 3: triangles
  /// Writes where they are at a time [s].
  std::function<void(double, std::vector<FaceCorners>&)> place;
};

class Contact {
 public:
  /// A node near a face.
  struct Pair {
    int node = 0, face = 0;
    int side = 0;        // of the node: 1 where the normal of the face points, -1 behind it, 0: not known yet
    bool faces = false;  // it is not past the ends of the face
  };
  /// What changes in time, to be kept and put back with the structure's.
  struct State {
    std::vector<Pair> near;  // by node, then face: closer than a margin at the last look, but for those that lay on it
    double way = 0;          // how far a node has come towards a wall since then, at most [m]
    double power = 0;        // of the walls at the last step [W]
  };

  /// k = stiffness M omega_max^2, M the mass of the node: a part of what the mesh itself has as stiffest. Keeps a reference
  /// to the solid. Throws CaseError for a stiffness not above 0.
  Contact(const Solid& solid, ContactWalls walls, double stiffness);

  /// The critical step [s] of a structure with these springs, from that without: omega^2 <= omega_max^2 + c k/M, where c
  /// is 1 at one wall and not above 3 anywhere, as no more faces push a node. Of those that it is through and whose normals
  /// are within 30 degrees only the deepest pushes.
  static double critical_step(double alone, double stiffness);
  double stiffness() const { return stiffness_; }

  /// At the first instant; `critical` is that of the structure without springs [s]. A node's side of a face is that at
  /// rest, or where it comes round an end of the face, and it never touches a face on which it lies at rest.
  State begin(double time, double critical);
  /// Walls go in straight lines from where they are at `from` to where they are at `to` [s].
  void prepare(double from, double to);

  /// Where the march is.
  struct Instant {
    double time, step;         // [s]
    const Eigen::VectorXd& u;  // [m]
    const Eigen::VectorXd& v;  // mean over a step [m/s]
  };
  /// Adds the force that holds the springs to f [N], after a step that led to u with v. Learns on which side nodes are that
  /// are past the ends of a face; and, as soon as nodes and walls can have moved by half of the margin, which are near:
  /// only then it may allocate.
  void push(State& state, const Instant& now, Eigen::VectorXd& f) const;
  /// Of the springs [J], before a step that leads from u with v: k d(n) d(n+1) / 2, as that of the body.
  double energy(const State& state, const Instant& now) const;
  /// Of the walls that move, on the springs [W].
  double power(const State& state, const Instant& now) const;

 private:
  /// A face at some time.
  struct Plane {
    Plane(const FaceCorners& corner, int corners);
    /// Of a place above it, on the side of the normal [m].
    double height(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
    /// Whether the foot of a place on the plane is on the face, or at most `slack` [m] past its ends.
    bool faced_by(const Eigen::Vector3d& x, double slack) const;

    int ends;  // of a segment 2, of a triangle 3: there inwards . x = begin
    Eigen::Vector3d normal, inwards[3];
    double offset, begin[3];
  };
  struct Touch;
  template <class Visit>
  void for_nodes(const State& state, const Instant& now, const Visit& visit) const;
  template <class Visit>
  void for_touches(const State& state, const Instant& now, const Visit& visit) const;
  void learn_sides(std::span<Pair> of_node, const Instant& now, std::span<const Touch> touches) const;
  void look_around(State& state, double time, const Eigen::VectorXd& u) const;
  Eigen::Vector3d place_of(int node, const Eigen::VectorXd& u) const;
  FaceCorners corners(int face, double time) const;
  Plane plane_of(int face, double time) const;
  template <class Use>
  auto with_plane(int face, double time, const Use& use) const;
  bool lies(int node, int face) const;

  const Solid& solid_;
  ContactWalls walls_;
  double stiffness_;
  std::vector<int> nodes_;                  // of the surface
  double margin_ = 0, slack_ = 0;           // of nearness; past the ends of faces [m]
  Eigen::VectorXd spring_;                  // k of each node [N/m]
  std::vector<std::pair<int, int>> lying_;  // nodes that lie on faces at rest, ascending
  double from_ = 0, to_ = 0;                // [s]
  std::vector<FaceCorners> at_from_, at_to_;
  std::vector<Plane> standing_;  // of walls that do not move in that span
  double speed_ = 0;             // of the walls in that span, at most [m/s]
};

}  // namespace greenwater
