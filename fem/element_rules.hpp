#pragma once
// What all elements of a body have in common.

#include <array>

#include "fem/material.hpp"
#include "fem/solid.hpp"
#include "fem/tensor.hpp"

namespace greenwater::element {

struct Rules {
  Lame lame;  // of plane stress where that is wanted
  Law law = Law::linear;
  ElementKind kind = ElementKind::incompatible;
  Plane plane = Plane::strain;
};

/// xx, yy, zz, xy, yz, zx [Pa].
using Stress = std::array<double, 6>;

/// From the stress in the plane and that across it, or from the whole in 3-D.
template <int Dim>
Stress stress_of(const Tensor<Dim, double>& s, double across) {
  if constexpr (Dim == 2)
    return {s(0, 0), s(1, 1), across, s(0, 1), 0, 0};
  else
    return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

}  // namespace greenwater::element
