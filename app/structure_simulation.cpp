#include "app/structure_simulation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/region.hpp"

namespace greenwater {
namespace {

constexpr const char* energy_names[] = {"kinetic", "strain", "contact", "lost", "loads", "supports", "balance"};

std::array<double, 7> values_of(const Energies& e) {
  return {e.kinetic, e.strain, e.contact, e.lost, e.loads, e.supports, e.balance()};
}

/// The largest of the lengths of all nodes' vectors.
double longest(const Solid& solid, const Eigen::VectorXd& values) {
  double most = 0;
  for (Eigen::Index i = 0; i < values.size(); i += solid.dim())
    most = std::max(most, values.segment(i, solid.dim()).norm());
  return most;
}

}  // namespace

StructureSimulation::StructureSimulation(const Scene& scene)
    : scene_(scene), step_(scene.step), structures_(build_structures(scene)) {}

void StructureSimulation::step() {
  Region region("structures");
  for (Structure& structure : structures_) structure.advance();
  ++steps_;
}

std::vector<std::string> StructureSimulation::history_header() const {
  std::vector<std::string> header{"step", "time[s]"};
  for (const Structure& structure : structures_) {
    const std::string of = "_" + structure.given().name;
    for (const char* name : energy_names) header.push_back(name + of + "[J]");
    header.push_back("displacement" + of + "[m]");
    header.push_back("speed" + of + "[m/s]");
  }
  return header;
}

std::string StructureSimulation::thermo_header() const {
  return fmt::format("{:>9} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}", "step", "time[s]", "kinetic[J]", "strain[J]",
                     "balance[J]", "u_max[m]", "v_max[m/s]");
}

RunFacts StructureSimulation::run_facts() {
  RunFacts facts;
  facts.step = steps_;
  facts.time = time();
  facts.history = {static_cast<double>(steps_), time()};
  double kinetic = 0, strain = 0, balance = 0, u_max = 0, v_max = 0;
  for (const Structure& structure : structures_) {
    const Energies energies = structure.march().energies();
    const double u = longest(structure.solid(), structure.march().displacement());
    const double v = longest(structure.solid(), structure.march().velocity());
    for (const double value : values_of(energies)) facts.history.push_back(value);
    facts.history.push_back(u);
    facts.history.push_back(v);
    kinetic += energies.kinetic;
    strain += energies.strain;
    balance += energies.balance();
    u_max = std::max(u_max, u);
    v_max = std::max(v_max, v);
    facts.work += static_cast<double>(structure.solid().mesh().elements.size()) * structure.substeps();
  }
  facts.finite = std::isfinite(kinetic) && std::isfinite(strain);
  facts.thermo = fmt::format("{:9d} {:11.7f} {:11.4e} {:11.4e} {:11.4e} {:11.4e} {:11.4e}", steps_, time(), kinetic,
                             strain, balance, u_max, v_max);
  return facts;
}

double StructureSimulation::sample(std::size_t probe) {
  const ProbeCase& given = scene_.probes[probe];
  return structures_[given.structure].sample(given);
}

ProbeHead StructureSimulation::probe_head(std::size_t probe) const {
  return structure_probe_head(scene_.probes[probe]);
}

Picture StructureSimulation::picture() const {
  Picture picture;
  for (const Structure& structure : structures_) picture.solids.push_back(structure.picture());
  return picture;
}

std::vector<std::string> StructureSimulation::plan() const {
  std::vector<std::string> lines;
  for (const Structure& structure : structures_)
    for (const std::string& line : structure.plan()) lines.push_back(line);
  lines.push_back(
      fmt::format("plan      {:.0f} steps of {:.6g} s", std::ceil(scene_.end / step_ * (1 - 1e-12)), step_));
  return lines;
}

}  // namespace greenwater
