#pragma once
// The inside of a closed outline in 2-D, or of a closed surface in 3-D: what water fills. Host only.

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/real.hpp"
#include "core/triangle_mesh.hpp"

namespace greenwater {

/// Two edges of a closed outline, numbered from 0 at the first corner, that cross, touch or fold back on each other;
/// nothing when it has an inside as an Interior wants it. Looks at all pairs.
std::optional<std::array<std::size_t, 2>> crossing_edges(const std::vector<std::array<coord, 3>>& outline);

/// Inside is what lies in an odd number of closed parts: a body within a tank is outside. Every question is answered in
/// a time that grows with the logarithm of the number of edges or triangles, but for measures, which look at all.
class Interior {
 public:
  using Corner = std::array<coord, 3>;

  /// 2-D: the corners in either sense, the last one is joined to the first; z is not looked at. The outline must not
  /// cross itself: see crossing_edges().
  explicit Interior(const std::vector<Corner>& outline);
  /// 3-D: a mesh without holes and faults (core/mesh_faults.hpp).
  explicit Interior(const TriangleMesh& mesh);

  /// Points nearer to the surface than rounding may be taken for either side, all others are right: also where the line
  /// above them meets edges and corners.
  bool holds(const Corner& point) const;
  /// To the surface, from either side [m]; `cap` when it is farther away than that, which is found out sooner.
  coord distance(const Corner& point, coord cap = std::numeric_limits<coord>::infinity()) const;

  /// Area [m^2] or volume [m^3].
  coord measure() const;
  /// Of what lies below a level along the last axis, by clipping: exact up to rounding.
  coord measure_below(coord level) const;

  MeshBounds bounds() const { return {nodes_.front().low, nodes_.front().high}; }
  int dimension() const { return dimension_; }

 private:
  using Element = std::array<Corner, 3>;  // a segment in 2-D: two corners
  struct Node {                           // of a tree of boxes, each in two halves
    Corner low, high;
    int begin = 0, end = 0;  // elements
    int right = 0;           // the other half; the first one follows at once; 0: a leaf
  };

  void build();
  int build_node(int begin, int end);
  bool is_above(const Element& element, const Corner& point) const;
  coord squared_distance(const Element& element, const Corner& point) const;
  coord part_below(const Element& element, coord level) const;

  int dimension_;
  std::vector<Element> elements_;
  std::vector<Node> nodes_;
};

}  // namespace greenwater
