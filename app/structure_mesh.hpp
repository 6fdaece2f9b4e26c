#pragma once
// Meshes of structures from what a case says of their shape.

#include "app/scene.hpp"

namespace greenwater {

/// Elements along the axes of a plate or a box: thickness, height, width of a plate; x, y, z of a box. Two numbers make
/// quadrilaterals, for 2-D scenes only; three make hexahedra.
using Divisions = std::vector<std::int64_t>;

/// A plate, free of stress where it leans. Parts: left, right (its faces), bottom, top (its ends), and of hexahedra front,
/// back (its sides). In a 2-D scene hexahedra go along z, half of the width on either side.
SolidMesh mesh_of(const PlateCase& plate, int dimension, const Divisions& divisions);

/// A box from `min` to `max` [m] with the same parts; bottom and top are at the ends of the scene's upright axis. In a 2-D
/// scene hexahedra go `width` [m] along z, half of it on either side.
SolidMesh mesh_of_box(const Point& min, const Point& max, double width, int dimension, const Divisions& divisions);

}  // namespace greenwater
