#pragma once
// A scene of structures without fluid.

#include "app/build_coupling.hpp"

namespace greenwater {

class StructureSimulation : public Simulation {
 public:
  /// Throws CaseError when the scene cannot be built.
  explicit StructureSimulation(const Scene& scene);

  void step() override;
  double time() const override { return static_cast<double>(steps_) * step_; }
  std::int64_t steps() const override { return steps_; }

  std::vector<std::string> history_header() const override;
  std::string thermo_header() const override;
  RunFacts run_facts() override;

  double sample(std::size_t probe) override;
  ProbeHead probe_head(std::size_t probe) const override;
  Picture picture() const override;
  std::vector<std::string> plan() const override;

  const Structure& structure(std::size_t i) const { return structures_[i]; }

 private:
  Scene scene_;
  double step_;  // [s]
  std::vector<Structure> structures_;
  std::int64_t steps_ = 0;
};

}  // namespace greenwater
