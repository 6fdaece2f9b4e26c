#pragma once
// What the fluid has room for at the start: its region, less what solids take.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "app/scene.hpp"
#include "core/interior.hpp"

namespace greenwater {

class Room {
 public:
  explicit Room(const Scene& scene);

  /// Whether a place is in the region and in no solid.
  bool holds(const Point& x) const { return in_region(x) && !in_solid(x); }
  /// Whether it is in or on a plate, a structure, or a closed geometry that the region is `without`.
  bool in_solid(const Point& x) const;
  /// Whether the region's edge, or a solid's, comes nearer to a place than `distance` [m]. Round a structure that is no
  /// plate it may say so too soon. The straight ends of the region (sides of a box, level) do not count.
  bool edge_within(const Point& x, double distance) const;

  /// Area [m^2] or volume [m^3]. Exact up to rounding without solids; else cells that an edge cuts are halved six times
  /// in 2-D, four times in 3-D, and what is left is told by one random place each: an error of some 0.002 cells for the
  /// root of the edge's length (in 3-D: area) in cells. Cells are as long as a particle distance.
  double measure() const;

 private:
  struct Solid {
    std::function<bool(const Point&)> holds;
    std::function<bool(const Point&, double)> edge_within;
    bool has_volume = true;
  };
  struct Cell {
    Point centre, half;
  };

  void add_plate(const PlateCase& plate);
  void add_structure(const StructureCase& structure);
  bool in_region(const Point& x) const;
  double region_measure() const;
  double part_of(const Cell& cell, int halvings, std::uint64_t& number) const;

  int dimension_;
  double spacing_;
  FluidCase fluid_;
  std::optional<Interior> inside_;  // of the closed shape that is filled, where it is no box
  std::vector<Solid> solids_;
};

/// The inside of the closed polyline or mesh of this name; nothing where it is none.
std::optional<Interior> interior_named(const Scene& scene, const std::string& name);

}  // namespace greenwater
