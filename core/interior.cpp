#include "core/interior.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "core/point_math.hpp"

namespace greenwater {
namespace {

constexpr int leaf_size = 4;

coord to_segment(const Triple& a, const Triple& b, const Triple& x) {  // squared
  const Triple along = difference(b, a), from_a = difference(x, a);
  const coord squared = dot(along, along);
  const coord part = squared > 0 ? std::clamp(dot(from_a, along) / squared, coord(0), coord(1)) : 0;
  const Triple away = difference(from_a, scaled(along, part));
  return dot(away, away);
}

coord to_triangle(const std::array<Triple, 3>& t, const Triple& x) {  // squared
  const Triple normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  const coord squared = dot(normal, normal);
  bool above = squared > 0;
  for (std::size_t s = 0; above && s < 3; ++s) {
    above = dot(cross(difference(t[(s + 1) % 3], t[s]), difference(x, t[s])), normal) >= 0;
  }
  if (above) {
    const coord height = dot(difference(x, t[0]), normal);
    return height * height / squared;
  }
  return std::min({to_segment(t[0], t[1], x), to_segment(t[1], t[2], x), to_segment(t[2], t[0], x)});
}

/// Whether the line from (x, y) towards +x meets the edge, seen along z. The answer belongs to the edge, bit for bit: it
/// is the same in both triangles of the edge and whichever way they run along it. A line along z therefore meets each
/// closed surface an even number of times, also when it passes through edges and corners.
bool crosses(Triple a, Triple b, const Triple& point) {
  if (b < a) std::swap(a, b);
  if ((a[1] <= point[1]) == (b[1] <= point[1])) return false;
  // Beside the edge the answer is exact, as that is where the boxes of the tree end.
  if (point[0] < a[0]) return true;
  if (point[0] > b[0]) return false;
  const coord side = (b[0] - a[0]) * (point[1] - a[1]) - (point[0] - a[0]) * (b[1] - a[1]);
  return b[1] > a[1] ? side > 0 : side < 0;
}

/// Height of the plane of a triangle at (x, y), within the triangle's heights: steep ones would let it jump.
coord height_at(const std::array<Triple, 3>& t, const Triple& point) {
  const auto [low, high] = std::minmax({t[0][2], t[1][2], t[2][2]});
  const Triple normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  const coord drop = normal[0] * (point[0] - t[0][0]) + normal[1] * (point[1] - t[0][1]);
  const coord height = t[0][2] - drop / normal[2];
  return height > low ? std::min(height, high) : low;  // low also for 0/0
}

/// 3 x the middle of an element, to compare with others.
Triple middle(const std::array<Triple, 3>& element) { return sum(sum(element[0], element[1]), element[2]); }

/// Where an edge meets a level along `axis`.
Triple at_level(const Triple& a, const Triple& b, std::size_t axis, coord level) {
  Triple x = sum(a, scaled(difference(b, a), (level - a[axis]) / (b[axis] - a[axis])));
  x[axis] = level;
  return x;
}

/// Positive when x lies to the left of the way from a to b.
coord left_of(const Triple& a, const Triple& b, const Triple& x) {
  return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
}

bool lies_on(const Triple& a, const Triple& b, const Triple& x) {
  const auto between = [](coord p, coord q, coord c) { return std::min(p, q) <= c && c <= std::max(p, q); };
  return left_of(a, b, x) == 0 && between(a[0], b[0], x[0]) && between(a[1], b[1], x[1]);
}

bool meet(const Triple& a, const Triple& b, const Triple& c, const Triple& d) {
  const auto apart = [](coord p, coord q) { return (p > 0 && q < 0) || (p < 0 && q > 0); };
  if (apart(left_of(a, b, c), left_of(a, b, d)) && apart(left_of(c, d, a), left_of(c, d, b))) return true;
  return lies_on(a, b, c) || lies_on(a, b, d) || lies_on(c, d, a) || lies_on(c, d, b);
}

}  // namespace

std::optional<std::array<std::size_t, 2>> crossing_edges(const std::vector<std::array<coord, 3>>& outline) {
  const std::size_t n = outline.size();
  const auto corner = [&](std::size_t i) -> const Triple& { return outline[i % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    // Neighbours share a corner; they may not run over each other.
    const bool folds =
        lies_on(corner(i), corner(i + 1), corner(i + 2)) || lies_on(corner(i + 1), corner(i + 2), corner(i));
    if (folds) return std::array{i, next};
    for (std::size_t k = i + 2; k < n; ++k) {
      const bool neighbours = (k + 1) % n == i;
      if (!neighbours && meet(corner(i), corner(i + 1), corner(k), corner(k + 1))) return std::array{i, k};
    }
  }
  return {};
}

Interior::Interior(const std::vector<Corner>& outline) : dimension_(2) {
  expect(outline.size() >= 3);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    Corner a = outline[i], b = outline[(i + 1) % outline.size()];
    a[2] = b[2] = 0;
    elements_.push_back({a, b, b});
  }
  build();
}

Interior::Interior(const TriangleMesh& mesh) : dimension_(3) {
  expect(!mesh.triangles.empty());
  for (const auto& t : mesh.triangles) {
    Element element;
    for (std::size_t c = 0; c < 3; ++c) element[c] = mesh.vertices[static_cast<std::size_t>(t[c])];
    elements_.push_back(element);
  }
  build();
}

void Interior::build() {
  nodes_.reserve(elements_.size());
  build_node(0, static_cast<int>(elements_.size()));
}

int Interior::build_node(int begin, int end) {
  const auto first = elements_.begin() + begin, last = elements_.begin() + end;
  Node node{(*first)[0], (*first)[0], begin, end, 0};
  Corner low = middle(*first), high = low;
  for (auto element = first; element != last; ++element) {
    const Corner m = middle(*element);
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], m[d]);
      high[d] = std::max(high[d], m[d]);
      for (const Corner& x : *element) {
        node.low[d] = std::min(node.low[d], x[d]);
        node.high[d] = std::max(node.high[d], x[d]);
      }
    }
  }
  const int number = static_cast<int>(nodes_.size());
  nodes_.push_back(node);
  if (end - begin <= leaf_size) return number;
  std::size_t axis = 0;
  for (std::size_t d = 1; d < 3; ++d)
    if (high[d] - low[d] > high[axis] - low[axis]) axis = d;
  const int half = begin + (end - begin) / 2;
  std::nth_element(first, elements_.begin() + half, last,
                   [&](const Element& a, const Element& b) { return middle(a)[axis] < middle(b)[axis]; });
  build_node(begin, half);
  const int right = build_node(half, end);
  nodes_[static_cast<std::size_t>(number)].right = right;
  return number;
}

bool Interior::is_above(const Element& element, const Corner& point) const {
  if (dimension_ == 2) {
    Corner a = element[0], b = element[1];
    if (b < a) std::swap(a, b);
    if ((a[0] <= point[0]) == (b[0] <= point[0])) return false;
    return a[1] + (b[1] - a[1]) * ((point[0] - a[0]) / (b[0] - a[0])) > point[1];
  }
  const bool hit = crosses(element[0], element[1], point) !=
                   (crosses(element[1], element[2], point) != crosses(element[2], element[0], point));
  return hit && height_at(element, point) > point[2];
}

bool Interior::holds(const Corner& point) const {
  const std::size_t up = dimension_ == 2 ? 1 : 2;
  bool inside = false;
  std::array<int, 64> waiting;  // depth of the tree: at most 31
  int count = 0;
  waiting[static_cast<std::size_t>(count++)] = 0;
  while (count > 0) {
    const int number = waiting[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    bool on_line = node.high[up] >= point[up];
    for (std::size_t d = 0; d < up; ++d) on_line = on_line && node.low[d] <= point[d] && point[d] <= node.high[d];
    if (!on_line) continue;
    if (node.right == 0) {
      for (int e = node.begin; e < node.end; ++e) inside ^= is_above(elements_[static_cast<std::size_t>(e)], point);
      continue;
    }
    waiting[static_cast<std::size_t>(count++)] = node.right;
    waiting[static_cast<std::size_t>(count++)] = number + 1;
  }
  return inside;
}

coord Interior::squared_distance(const Element& element, const Corner& point) const {
  return dimension_ == 2 ? to_segment(element[0], element[1], point) : to_triangle(element, point);
}

coord Interior::distance(const Corner& point, coord cap) const {
  Corner x = point;
  if (dimension_ == 2) x[2] = 0;
  const auto to_box = [&](int number) {
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    coord squared = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const coord away = std::max({node.low[d] - x[d], coord(0), x[d] - node.high[d]});
      squared += away * away;
    }
    return squared;
  };
  coord nearest = cap * cap;
  std::array<std::pair<coord, int>, 64> waiting;
  int count = 0;
  waiting[static_cast<std::size_t>(count++)] = {to_box(0), 0};
  while (count > 0) {
    const auto [away, number] = waiting[static_cast<std::size_t>(--count)];
    if (away >= nearest) continue;
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    if (node.right == 0) {
      for (int e = node.begin; e < node.end; ++e) {
        nearest = std::min(nearest, squared_distance(elements_[static_cast<std::size_t>(e)], x));
      }
      continue;
    }
    std::pair<coord, int> a{to_box(number + 1), number + 1}, b{to_box(node.right), node.right};
    if (a.first < b.first) std::swap(a, b);  // the nearer one is looked at first
    waiting[static_cast<std::size_t>(count++)] = a;
    waiting[static_cast<std::size_t>(count++)] = b;
  }
  return std::min(cap, std::sqrt(nearest));
}

coord Interior::part_below(const Element& element, coord level) const {
  // Divergence of (0, .., z - L) over what lies below L: the lid at L adds nothing, and what is left is the integral of
  // (z - L) n_z over the surface below L, exact for each flat piece.
  const std::size_t up = dimension_ == 2 ? 1 : 2, corners = dimension_ == 2 ? 2 : 3;
  std::array<Triple, 6> piece;
  std::size_t count = 0;
  for (std::size_t c = 0; c < corners; ++c) {
    const Triple &a = element[c], &b = element[(c + 1) % corners];
    if (a[up] <= level) piece[count++] = a;
    const bool next_is_side = dimension_ == 3 || c == 0;
    if (next_is_side && (a[up] <= level) != (b[up] <= level)) piece[count++] = at_level(a, b, up, level);
  }
  if (dimension_ == 2) {  // n_y ds = -dx
    if (count < 2) return 0;
    return -(piece[1][0] - piece[0][0]) * ((piece[0][1] - level) + (piece[1][1] - level)) / 2;
  }
  coord whole = 0;
  for (std::size_t c = 2; c < count; ++c) {  // n_z dA = area seen along z
    const Triple &a = piece[0], &b = piece[c - 1], &d = piece[c];
    const coord twice = (b[0] - a[0]) * (d[1] - a[1]) - (d[0] - a[0]) * (b[1] - a[1]);
    whole += twice / 2 * ((a[2] - level) + (b[2] - level) + (d[2] - level)) / 3;
  }
  return whole;
}

coord Interior::measure_below(coord level) const {
  const std::size_t up = dimension_ == 2 ? 1 : 2;
  const Node& all = nodes_.front();
  const coord lid = std::min(level, all.high[up]);
  if (lid <= all.low[up]) return 0;
  accum below = 0;
  for (const Element& element : elements_) below += part_below(element, lid);
  return std::abs(below);
}

coord Interior::measure() const { return measure_below(nodes_.front().high[dimension_ == 2 ? 1 : 2]); }

}  // namespace greenwater
