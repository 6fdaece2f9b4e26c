#include "io/thermo.hpp"

#include <fmt/format.h>

#include "io/clock.hpp"

namespace greenwater {

std::string thermo_header() {
  return fmt::format("{:>8} {:>10} {:>10} {:>4} {:>8} {:>9} {:>7} {:>9} {:>9} {:>6} {:>9} {:>9}", "step", "time[s]",
                     "dt[s]", "it", "resid", "umax[m/s]", "cfl", "E/E0[-]", "n_err[-]", "lost", "ms/step", "eta");
}

std::string thermo_line(const StepFacts& facts, double ms_per_step, double eta) {
  return fmt::format("{:8d} {:10.7f} {:10.3e} {:4d} {:8.1e} {:9.3f} {:7.3f} {:9.5f} {:9.5f} {:6d} {:9.1f} {:>9}",
                     facts.step, facts.time, facts.dt, facts.iterations, facts.residual, facts.max_speed, facts.cfl,
                     facts.energy_ratio, facts.density_error, facts.lost, ms_per_step, duration_text(eta));
}

std::vector<std::string> history_header(int dimension) {
  const std::string energy = dimension == 2 ? "[J/m]" : "[J]";
  return {"step",           "time[s]",        "dt[s]",   "iterations", "residual[-]", "umax[m/s]", "cfl[-]",
          "E_kin" + energy, "E_pot" + energy, "E/E0[-]", "n_err[-]",   "particles",   "lost",      "ms_per_step"};
}

std::vector<double> history_row(const StepFacts& facts, double ms_per_step) {
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
          static_cast<double>(facts.lost),
          ms_per_step};
}

}  // namespace greenwater
