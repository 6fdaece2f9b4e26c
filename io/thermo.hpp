#pragma once
// The numbers of a step as one line of fixed columns: plain digits, '.' as the decimal sign.

#include <string>
#include <vector>

#include "io/step_facts.hpp"

namespace greenwater {

/// The heads of the columns, with units, and one line below them.
std::string thermo_header();
std::string thermo_line(const StepFacts& facts);

/// The columns of history.csv, with units; energies are per metre of depth in 2-D.
std::vector<std::string> history_header(int dimension);
std::vector<double> history_row(const StepFacts& facts);

/// What stands behind the line of any run: wall time of a step [ms] and the time left [s].
std::string pace_header();
std::string pace_text(double ms_per_step, double eta);

}  // namespace greenwater
