#pragma once
// A structure as the coupling sees it.

#include <cmath>

#include "coupling/wet_surface.hpp"
#include "fem/march.hpp"

namespace greenwater {

/// What it points to must outlive it.
struct ElasticBody {
  const Solid* solid = nullptr;
  const Supports* supports = nullptr;
  March* march = nullptr;
  MarchOptions options;  // of the march
  WetSurface surface;
  int first_face = 0;  // of the surface's faces among those of the fluid
};

/// Steps of the structure in one step dt of the fluid.
inline int substeps(const ElasticBody& body, double dt) {
  return static_cast<int>(std::lround(dt / body.options.step));
}

}  // namespace greenwater
