#pragma once
// Structures without fluid from the text of a case.

#include "app/structure_simulation.hpp"
#include "core/check.hpp"
#include "tests/case_text.hpp"

namespace greenwater::test {

/// Why a case is refused; nothing when it is not.
inline std::string complaint_about(const std::string& text) {
  try {
    StructureSimulation simulation(scene_of_text(text));
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

}  // namespace greenwater::test
