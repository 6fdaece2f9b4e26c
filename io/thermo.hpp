#pragma once
// The numbers of a step as one line of fixed columns: plain digits, '.' as the decimal sign.

#include <string>
#include <vector>

#include "io/step_facts.hpp"

namespace greenwater {

/// The heads of the columns, with units.
std::string thermo_header();
/// One line below them; `ms_per_step` is wall time [ms], `eta` the time left [s].
std::string thermo_line(const StepFacts& facts, double ms_per_step, double eta);

/// The columns of history.csv, with units; energies are per metre of depth in 2-D.
std::vector<std::string> history_header(int dimension);
std::vector<double> history_row(const StepFacts& facts, double ms_per_step);

}  // namespace greenwater
