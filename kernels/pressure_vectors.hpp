#pragma once
// What both solvers of the pressure do to it before they begin.

#include "core/fields.hpp"

namespace greenwater {

/// p = 0 where the surface is.
void hold_surface(const FlagField& fixed, const ScalarField& p, int count);

/// p = 0
void clear_pressure(const ScalarField& p, int count);

}  // namespace greenwater
