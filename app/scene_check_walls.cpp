// How the walls of a scene fit together, at t = 0.

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/scene_shape.hpp"

namespace greenwater {
namespace {

using Flat = std::array<double, 2>;

bool is_open(const BoxCase& box, const std::string& side) {
  return std::find(box.open.begin(), box.open.end(), side) != box.open.end();
}

struct Check {
  const Scene& scene;
  std::size_t axes = static_cast<std::size_t>(scene.dimension);
  double slack = 1e-6 * scene.mps.spacing;  // round-off of typed numbers
};

/// A plate stands in a box or on its side; it may leave through an open side.
bool plate_fits(const Check& check, const Shape& plate, const Point& base, const BoxCase& box) {
  const Words sides = box_sides(check.scene.dimension);
  for (std::size_t d = 0; d < check.axes; ++d) {
    const bool foot = base[d] >= box.min[d] - check.slack && base[d] <= box.max[d] + check.slack;
    const bool low = plate.bounds.min[d] >= box.min[d] - check.slack || is_open(box, sides[2 * d]);
    const bool high = plate.bounds.max[d] <= box.max[d] + check.slack || is_open(box, sides[2 * d + 1]);
    if (!foot || !low || !high) return false;
  }
  return true;
}

void check_plates_in_boxes(const Check& check) {
  const Scene& scene = check.scene;
  if (scene.boxes.empty()) return;
  for (const Shape& shape : shapes_of(scene)) {
    const auto plate = std::find_if(scene.plates.begin(), scene.plates.end(),
                                    [&](const PlateCase& p) { return &p == shape.geometry; });
    if (plate == scene.plates.end() || plate->motion) continue;  // a moving one may come from outside
    const bool held = std::any_of(scene.boxes.begin(), scene.boxes.end(),
                                  [&](const BoxCase& box) { return plate_fits(check, shape, plate->base, box); });
    const BoxCase& first = scene.boxes.front();
    require_at(plate->place, held, "the plate \"", plate->name, "\", which reaches from ",
               shown_point(shape.bounds.min, scene.dimension), " to ", shown_point(shape.bounds.max, scene.dimension),
               " m, is not inside the box \"", first.name, "\" from ", shown_point(first.min, scene.dimension), " to ",
               shown_point(first.max, scene.dimension), " m; move or shrink the plate, or open a side of the box");
  }
}

/// Pressure is read a thousandth of a spacing off a wall: on the other side of a thinner plate already, so that its force
/// would count twice. Sides that are nearer to each other than round-off are neither one wall nor two.
void check_thickness(const Check& check) {
  constexpr double thinnest = 2e-3;  // x spacing
  const double least = thinnest * check.scene.mps.spacing;
  for (const PlateCase& plate : check.scene.plates)
    require_at(plate.thickness_place, plate.thickness == 0 || plate.thickness >= least, "thickness = ", plate.thickness,
               " m of the plate \"", plate.name, "\" is none beside mps.spacing = ", check.scene.mps.spacing,
               " m; take thickness = 0, which is a plate wet on both sides, or at least ", least, " m");
}

// A plate without thickness gets a little, for the sake of the test, and touching is no overlap.
constexpr double thin = 4e-3, touch = 2e-3;  // x spacing

std::vector<Flat> solid_section(const Check& check, PlateCase plate) {
  const double least = thin * check.scene.mps.spacing;
  if (plate.thickness < least) {
    plate.thickness = least;
    plate.base_side = "centre";
  }
  return plate_section(plate, check.scene.dimension);
}

/// Convex shapes are apart when the normal of one of their edges separates them.
bool an_edge_separates(const std::vector<Flat>& a, const std::vector<Flat>& b, double slack) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Flat &from = a[k], &to = a[(k + 1) % a.size()];
    const Flat normal{to[1] - from[1], from[0] - to[0]};
    const auto along = [&](const Flat& x) { return x[0] * normal[0] + x[1] * normal[1]; };
    const auto less = [&](const Flat& x, const Flat& y) { return along(x) < along(y); };
    const auto [a_low, a_high] = std::minmax_element(a.begin(), a.end(), less);
    const auto [b_low, b_high] = std::minmax_element(b.begin(), b.end(), less);
    const double room = slack * std::hypot(normal[0], normal[1]);
    if (along(*a_high) <= along(*b_low) + room || along(*b_high) <= along(*a_low) + room) return true;
  }
  return false;
}

bool overlap(const Check& check, const PlateCase& a, const PlateCase& b) {
  const double slack = touch * check.scene.mps.spacing;
  if (check.axes == 3 && std::fabs(a.base[1] - b.base[1]) >= (a.width + b.width) / 2 - slack) return false;
  const auto first = solid_section(check, a), second = solid_section(check, b);
  return !an_edge_separates(first, second, slack) && !an_edge_separates(second, first, slack);
}

void check_plates_apart(const Check& check) {
  const auto& plates = check.scene.plates;
  for (std::size_t i = 0; i < plates.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      require_at(plates[i].place, !overlap(check, plates[i], plates[j]), "the plates \"", plates[j].name, "\" and \"",
                 plates[i].name, "\" overlap: move one of them, or make one plate of both");
}

[[noreturn]] void refuse_crossing(const GeometryCase& a, const GeometryCase& b, const std::string& where) {
  const bool in_order = a.place.line < b.place.line;
  const GeometryCase &first = in_order ? a : b, &second = in_order ? b : a;
  const std::string whose = &a == &b ? text_of("the walls of \"", a.name, "\" cross each other at ")
                                     : text_of("the walls of \"", first.name, "\" and \"", second.name, "\" cross at ");
  refuse(second.place, whose, where, " m: let one end where it meets the other, or open the side that is crossed");
}

struct Segment {
  Flat from, to;
  const GeometryCase* geometry;
  bool of_plate = false;
};

void add_segments(const PolylineCase& line, std::vector<Segment>& segments) {
  const auto flat = [](const Point& x) { return Flat{x[0], x[1]}; };
  for (std::size_t k = 1; k < line.points.size(); ++k)
    segments.push_back({flat(line.points[k - 1]), flat(line.points[k]), &line});
  if (line.closed) segments.push_back({flat(line.points.back()), flat(line.points.front()), &line});
}

void add_segments(const BoxCase& box, std::vector<Segment>& segments) {
  const Flat a{box.min[0], box.min[1]}, b{box.max[0], box.min[1]}, c{box.max[0], box.max[1]}, d{box.min[0], box.max[1]};
  if (!is_open(box, "bottom")) segments.push_back({a, b, &box});
  if (!is_open(box, "right")) segments.push_back({b, c, &box});
  if (!is_open(box, "top")) segments.push_back({c, d, &box});
  if (!is_open(box, "left")) segments.push_back({d, a, &box});
}

/// Where two segments cut through each other; touching is no cut.
std::optional<Flat> crossing(const Segment& a, const Segment& b, double slack) {
  const auto side = [](const Segment& s, const Flat& x) {
    const double dx = s.to[0] - s.from[0], dy = s.to[1] - s.from[1];
    return (dx * (x[1] - s.from[1]) - dy * (x[0] - s.from[0])) / std::hypot(dx, dy);
  };
  const auto between = [&](double one, double other) {
    return (one > slack && other < -slack) || (one < -slack && other > slack);
  };
  const double from = side(b, a.from), to = side(b, a.to);
  if (!between(from, to) || !between(side(a, b.from), side(a, b.to))) return {};
  const double s = from / (from - to);
  return Flat{a.from[0] + s * (a.to[0] - a.from[0]), a.from[1] + s * (a.to[1] - a.from[1])};
}

void check_crossings_2d(const Check& check) {
  std::vector<Segment> segments;
  for (const BoxCase& box : check.scene.boxes) add_segments(box, segments);
  for (const PolylineCase& line : check.scene.polylines) add_segments(line, segments);
  for (const PlateCase& plate : check.scene.plates) {
    const auto corners = plate_section(plate, 2);
    for (std::size_t k = 1; k < corners.size(); ++k) segments.push_back({corners[k - 1], corners[k], &plate, true});
  }
  const auto left = [](const Segment& s) { return std::min(s.from[0], s.to[0]); };
  std::stable_sort(segments.begin(), segments.end(),
                   [&](const Segment& a, const Segment& b) { return left(a) < left(b); });
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double right = std::max(segments[i].from[0], segments[i].to[0]);
    for (std::size_t j = i + 1; j < segments.size() && left(segments[j]) < right; ++j) {
      if (segments[i].of_plate && segments[j].of_plate) continue;  // see check_plates_apart()
      if (const auto at = crossing(segments[i], segments[j], check.slack))
        refuse_crossing(*segments[i].geometry, *segments[j].geometry, shown_point({(*at)[0], (*at)[1], 0}, 2));
    }
  }
}

/// One side of a box in 3-D: the axis that it stands across, and where.
struct Side {
  std::size_t axis;
  double at;
};

std::vector<Side> walls_of(const BoxCase& box) {
  const Words names = box_sides(3);
  std::vector<Side> sides;
  for (std::size_t d = 0; d < 3; ++d) {
    if (!is_open(box, names[2 * d])) sides.push_back({d, box.min[d]});
    if (!is_open(box, names[2 * d + 1])) sides.push_back({d, box.max[d]});
  }
  return sides;
}

void check_sides(const Check& check, const BoxCase& a, const BoxCase& b) {
  const auto within = [&](const BoxCase& box, const Side& side) {
    return side.at > box.min[side.axis] + check.slack && side.at < box.max[side.axis] - check.slack;
  };
  for (const Side& p : walls_of(a))
    for (const Side& q : walls_of(b)) {
      if (p.axis == q.axis || !within(b, p) || !within(a, q)) continue;
      const std::size_t third = 3 - p.axis - q.axis;
      const double low = std::max(a.min[third], b.min[third]), high = std::min(a.max[third], b.max[third]);
      if (high - low <= check.slack) continue;
      Point at{};
      at[p.axis] = p.at;
      at[q.axis] = q.at;
      at[third] = (low + high) / 2;
      refuse_crossing(a, b, shown_point(at, 3));
    }
}

void check_crossings_3d(const Check& check) {
  const auto& boxes = check.scene.boxes;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) check_sides(check, boxes[j], boxes[i]);
}

}  // namespace

void check_walls(const Scene& scene) {
  const Check check{scene};
  check_thickness(check);
  check_plates_in_boxes(check);
  check_plates_apart(check);
  scene.dimension == 2 ? check_crossings_2d(check) : check_crossings_3d(check);
}

}  // namespace greenwater
