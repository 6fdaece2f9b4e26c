#pragma once
// Walls by mirror symmetry, without ghost particles: a particle near a wall sees the images of its neighbours, and of
// itself, in the wall. A plate of no thickness is wet on both sides, and the fluid sees itself round its free end.
//
// What sees what is a question of paths. Two particles see each other when the straight line between them meets no wall.
// A particle sees the image of another when a path by way of one or more walls, out of each at the angle at which it
// goes in, leads there and meets no other wall: unfolded, that path is the line to the image. From any particle one path
// leaves in every direction, and has one end: so the images fill what the walls take away, at any angle of a corner, and
// n = n^0 there too. Every path is the same backwards; and as each pair is always looked at from the one with the lower
// index, both get the same answer to the last bit, which makes the pressure matrix symmetric.
//
// A wall that bends is cut into many panels, each with its own speed. A path by way of another wall's corner and the
// second or third of them (2-D) is made with the plane of the first: so near to a corner they are as good as flat.
//
// Where a path passes close to the edge of a corner that is not right-angled, a slightly other path goes round the edge
// the other way and ends elsewhere. There both images count in shares that make up one, so that nothing jumps when a
// particle moves; in a right-angled corner both are the same image.

#include "core/wall_faces.hpp"
#include "kernels/cell_grid.hpp"

namespace greenwater {

/// A value on a panel that changes linearly along it: value + gradient (x - point of the panel).
struct LinearField {
  coord value[3], gradient[3][3];

  template <int Dim>
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> at(const Vec<Dim, coord>& from_point) const {
    Vec<Dim, coord> v;
    for (int d = 0; d < Dim; ++d) {
      v[d] = value[d];
      for (int e = 0; e < Dim; ++e) v[d] += gradient[d][e] * from_point[e];
    }
    return v;
  }
};

/// A segment (2-D) or triangle (3-D) of a panel.
struct Piece {
  coord corner[3][3];  // [m]
  coord inward[3][3];  // unit, in the panel: a point q of the panel is in it when (q - corner[e]) . inward[e] >= 0
};

/// The field that has these values at the corners of a piece, from its first corner; along the normal it does not change.
template <int Dim>
KOKKOS_INLINE_FUNCTION LinearField linear_field(const Piece& piece, const coord (&value)[3][3]) {
  coord way[2][3] = {}, product[2][2] = {};  // along two sides, and their inner products
  for (int a = 0; a < Dim - 1; ++a)
    for (int d = 0; d < Dim; ++d) way[a][d] = piece.corner[a + 1][d] - piece.corner[0][d];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int d = 0; d < Dim; ++d) product[a][b] += way[a][d] * way[b][d];
  if (Dim == 2) product[1][1] = 1;
  const coord per_det = 1 / (product[0][0] * product[1][1] - product[0][1] * product[1][0]);
  LinearField field{};
  for (int d = 0; d < Dim; ++d) {
    field.value[d] = value[0][d];
    for (int e = 0; e < Dim; ++e)
      for (int a = 0; a < Dim - 1; ++a) {
        const coord dual = product[1 - a][1 - a] * way[a][e] - product[0][1] * way[1 - a][e];
        field.gradient[d][e] += (value[a + 1][d] - value[0][d]) * dual * per_det;
      }
  }
  return field;
}

/// A stretch of a panel's rim (2-D: an end, a = b).
struct Rim {
  coord a[3], b[3];  // [m]
};

/// A plane stretch of wall: all pieces that lie in one plane, touch and move alike, but of a body that bends each on its
/// own. In it one particle has one image.
struct Panel {
  coord normal[3];              // unit
  coord point[3];               // its first corner [m]
  coord middle[3], extent;      // of its bounds, and no corner is farther from there [m]
  int first_piece, last_piece;  // its pieces, the last one excluded
  int first_rim, last_rim;      // its rim; a panel of very many pieces has none noted, and first_rim = -1
  int first_joint, last_joint;  // its corners, as places in MirrorWalls::joint_of_panel
  int body;                     // named geometry
  int face;                     // the first of its faces
  bool no_slip, moves, bends;
  LinearField velocity;      // [m/s], mean over the step that led here
  LinearField acceleration;  // [m/s^2]
};

/// The inside of a corner between two panels that do not stand at right angles; its angle is at most 180 degrees, or on the
/// outer side of a wall that bends a little more.
struct Joint {
  int panel[2];
  coord point[3], edge[3];  // a point of the edge [m], and its direction (2-D: along z)
  coord low, high;          // where the edge begins and ends, from the point [m]
  coord along[2][3];        // unit, from the edge into each panel
  coord across[3];          // unit, from the first panel into the corner
  coord angle;              // between the panels [rad]
  coord blend;              // how far past the edge paths still have a share [rad]
};

/// One way to make an image: x' = map x + shift. The path goes from the particle to `length` walls, in turn the two of
/// the joint (or the one panel), beginning with `panel`; and to those in `also`, at right angles to all others, whenever
/// it comes to them.
struct Mirror {
  coord map[3][3];
  coord shift[3];  // [m]
  int length;
  int panel;    // -1 when length is 0
  int joint;    // -1: none
  int also[3];  // -1: none
  int reverse;  // the mirror of the path backwards
  bool moves, no_slip;
};

/// x' = map x + shift
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec<Dim, coord> image_position(const Mirror& m, const Vec<Dim, coord>& x) {
  Vec<Dim, coord> y;
  for (int d = 0; d < Dim; ++d) {
    y[d] = m.shift[d];
    for (int e = 0; e < Dim; ++e) y[d] += m.map[d][e] * x[e];
  }
  return y;
}

/// The mirrors of a scene, and for each cell of the grid those that a particle in it can reach. Views may be longer than
/// what is used, so that walls that move allocate nothing.
struct MirrorWalls {
  int count = 0;  // mirrors; 0: no walls, and then nothing here is allocated
  int panels = 0;
  Kokkos::View<Panel*, Device> panel;
  Kokkos::View<Piece*, Device> piece;
  Kokkos::View<Rim*, Device> rim;
  Kokkos::View<Joint*, Device> joint;
  IndexField joint_of_panel;
  Kokkos::View<Mirror*, Device> mirror;  // mirror k < panels is that of panel k alone; then corners
  IndexField first, reach;               // of cell c: reach(first(c)) ... reach(first(c + 1) - 1), ascending;
                                         // after the last cell: all of them
  coord tolerance = 0;                   // panels are that much longer than they are [m]
};

/// How the corners of one body's faces go, on the device: all its faces bend, and they stand one after the other.
struct CornerMotion {
  int body = 0, first_face = 0;
  IndexField corner_of_face;  // (dim f + e) the corner that corner e of face first_face + f is
  CoordField velocity;        // (corner, d) mean over the step [m/s]
  CoordField acceleration;    // (corner, d) [m/s^2]
};

/// Gives the panels of that body these velocities and accelerations; where they are stays. One launch.
void set_wall_motion(const MirrorWalls& walls, int dim, const CornerMotion& motion);

/// Makes panels, joints and mirrors of the faces as they stand now and bins them into the grid; memory is kept and only
/// grown. Throws CaseError when two panels meet at less than 5 degrees.
void make_mirror_walls(MirrorWalls& made, const WallFaces& faces, const GridShape& grid, coord spacing);

}  // namespace greenwater
