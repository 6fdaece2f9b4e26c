#pragma once
// From a structure of a case to its body, supports and loads: the only place that maps its words to finite elements.

#include <memory>
#include <optional>

#include "app/scene.hpp"
#include "fem/contact.hpp"
#include "fem/loads.hpp"
#include "fem/supports.hpp"

namespace greenwater {

/// What `build` makes; a complaint of the finite elements gets the place in the case.
template <class Build>
auto built_at(const Place& place, Build build) {
  try {
    return build();
  } catch (const CaseError& error) {
    refuse(place, error.what());
  } catch (const NumericsError& error) {  // before the first step it is the case that is wrong
    refuse(place, error.what());
  }
}

/// Throws CaseError for elements that cannot be.
std::unique_ptr<Solid> build_solid(const StructureCase& given);

/// Throws CaseError for a support without nodes.
Supports build_supports(const Scene& scene, const StructureCase& given);

/// Weight and all loads of the case; they keep a reference to the solid.
Loads build_loads(const Scene& scene, const Solid& solid, const StructureCase& given);

/// What it may touch, with a reference to the solid; nothing where the case names no walls.
std::optional<Contact> build_contact(const Scene& scene, const Solid& solid, const StructureCase& given);

/// A vector at every node, by formulas in x, y, z: as many numbers as the body has unknowns.
Eigen::VectorXd at_nodes(const Solid& solid, const VectorFormula& formulas);

}  // namespace greenwater
