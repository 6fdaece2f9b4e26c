#pragma once
// One structure of a scene: its body, its supports and loads, and its march in substeps.

#include <memory>

#include "app/scene.hpp"
#include "app/simulation.hpp"
#include "fem/march.hpp"
#include "fem/modes.hpp"

namespace greenwater {

class Structure {
 public:
  /// Ready for steps of `step` [s], in equal substeps: not longer than the case's time_step, or without one than safety x
  /// critical, and so many at least. Throws CaseError when it cannot be built, or when time_step is at or above the
  /// critical step.
  Structure(const Scene& scene, const StructureCase& given, double step, int least_substeps = 1);

  void advance() { march_->advance(substeps_); }

  const StructureCase& given() const { return given_; }
  const Solid& solid() const { return *solid_; }
  const Supports& supports() const { return supports_; }
  const March& march() const { return *march_; }
  March& march() { return *march_; }
  MarchOptions march_options() const { return {substep_, damping_, 0}; }
  int substeps() const { return substeps_; }

  double sample(const ProbeCase& probe) const;
  SolidPicture picture() const;
  /// What it is, for people, with its first frequencies and what the damping means for them.
  std::vector<std::string> plan() const;

 private:
  void choose_substeps(double step, int least);
  void choose_damping();
  Modes modes(int count) const;
  std::vector<std::string> frequency_lines() const;
  double stress_at(const Point& place, const std::string& component) const;

  StructureCase given_;
  std::unique_ptr<Solid> solid_;  // where it is, as the march keeps a reference
  Supports supports_;
  double critical_ = 0;  // [s]
  int substeps_ = 1;
  double damping_ = 0, substep_ = 0;  // [1/s], [s]
  bool loaded_ = false;
  std::unique_ptr<March> march_;
};

/// What a structure probe measures.
ProbeHead structure_probe_head(const ProbeCase& probe);

}  // namespace greenwater
