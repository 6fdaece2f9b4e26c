#pragma once
// What one step has to tell.

#include <cstdint>
#include <string>
#include <vector>

namespace greenwater {

/// Something that the user should know, but that does not end the run. Notices of one kind are counted together.
struct Notice {
  std::string kind;  ///< short and always the same: cfl, stall, crossing
  std::string text;  ///< the whole sentence, with its numbers
  std::int64_t count = 1;
  bool each = false;  ///< not only the first of its kind is worth a line of the log
};

/// What any run tells after a step, ready for the log and for history.csv.
struct RunFacts {
  std::int64_t step = 0;
  double time = 0;              ///< [s]
  bool finite = true;           ///< all numbers of the state are numbers
  double work = 0;              ///< done in one step: particles, or elements times substeps
  std::vector<double> history;  ///< as many as the header has
  std::string thermo;           ///< the line below its header
  std::vector<Notice> notices;  ///< since the facts were last asked for
};

/// Of a step of the fluid.
struct StepFacts {
  std::int64_t step = 0;
  double time = 0;            ///< [s]
  double dt = 0;              ///< [s]
  int iterations = 0;         ///< of the pressure solve
  double residual = 0;        ///< of the pressure solve, relative [-]
  double max_speed = 0;       ///< [m/s]
  double cfl = 0;             ///< max_speed dt / spacing [-]
  double kinetic_energy = 0;  ///< [J/m] in 2-D, [J] in 3-D
  double potential_energy = 0;
  double energy_ratio = 1;   ///< kinetic + potential over their initial sum [-]
  double density_error = 0;  ///< root mean square of n/n0 - 1 inside the fluid [-]
  std::int64_t particles = 0;
  std::int64_t lost = 0;        ///< particles retired since the start
  std::vector<Notice> notices;  ///< since the facts were last asked for
};

}  // namespace greenwater
