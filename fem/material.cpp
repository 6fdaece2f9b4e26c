#include "fem/material.hpp"

#include "core/check.hpp"

namespace greenwater {

void check(const Material& material) {
  require(material.young > 0, "Young's modulus is ", material.young, " Pa; it has to be positive");
  require(material.density > 0, "the density of the structure is ", material.density, " kg/m3; it has to be positive");
  require(
      material.poisson > -1 && material.poisson < 0.5, "Poisson's ratio is ", material.poisson,
      "; it has to lie between -1 and 0.5, both excluded",
      material.poisson >= 0.5 ? ". Material that keeps its volume: take 0.499 and elements of mean dilatation" : "");
}

Lame lame(const Material& material) {
  const double e = material.young, nu = material.poisson;
  return {e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))};
}

Lame lame_plane_stress(const Material& material) {
  const auto [lambda, mu] = lame(material);
  return {2 * lambda * mu / (lambda + 2 * mu), mu};
}

}  // namespace greenwater
