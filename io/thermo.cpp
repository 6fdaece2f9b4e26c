#include "io/thermo.hpp"

#include <fmt/format.h>

#include "io/clock.hpp"

namespace greenwater {

std::string thermo_header() {
  return fmt::format("{:>8} {:>10} {:>10} {:>4} {:>8} {:>9} {:>7} {:>9} {:>9} {:>6}", "step", "time[s]", "dt[s]", "it",
                     "resid", "umax[m/s]", "cfl", "E/E0[-]", "n_err[-]", "lost");
}

std::string thermo_line(const StepFacts& facts) {
  return fmt::format("{:8d} {:10.7f} {:10.3e} {:4d} {:8.1e} {:9.3f} {:7.3f} {:9.5f} {:9.5f} {:6d}", facts.step,
                     facts.time, facts.dt, facts.iterations, facts.residual, facts.max_speed, facts.cfl,
                     facts.energy_ratio, facts.density_error, facts.lost);
}

std::vector<std::string> history_header(int dimension) {
  const std::string energy = dimension == 2 ? "[J/m]" : "[J]";
  return {"step",           "time[s]",        "dt[s]",   "iterations", "residual[-]", "umax[m/s]", "cfl[-]",
          "E_kin" + energy, "E_pot" + energy, "E/E0[-]", "n_err[-]",   "particles",   "lost"};
}

std::vector<double> history_row(const StepFacts& facts) {
  return {static_cast<double>(facts.step),
          facts.time,
          facts.dt,
          static_cast<double>(facts.iterations),
          facts.residual,
          facts.max_speed,
          facts.cfl,
          facts.kinetic_energy,
          facts.potential_energy,
          facts.energy_ratio,
          facts.density_error,
          static_cast<double>(facts.particles),
          static_cast<double>(facts.lost)};
}

std::string pace_header() { return fmt::format(" {:>9} {:>9}", "ms/step", "eta"); }

std::string pace_text(double ms_per_step, double eta) {
  return fmt::format(" {:9.3f} {:>9}", ms_per_step, duration_text(eta));
}

}  // namespace greenwater
