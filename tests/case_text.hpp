#pragma once
// Scenes from the text of a case.

#include <string>
#include <vector>

#include "app/scene.hpp"

namespace greenwater::test {

inline Scene scene_of_text(const std::string& text, const std::vector<CaseOption>& options = {}) {
  CaseFile file(text, "case.toml", options);
  return read_scene(file);
}

}  // namespace greenwater::test
