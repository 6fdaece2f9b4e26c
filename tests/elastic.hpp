#pragma once
// Water on elastic plates, for tests of the coupling.

#include "app/fluid_simulation.hpp"
#include "tests/case_text.hpp"
#include "tests/support.hpp"

namespace greenwater::test {

/// Water on a plate that is clamped at both ends and closes a tank from below (Fourey et al. 2017): span 1 m, 0.05 m
/// thick. What changes is put over the text by options.
inline std::string column_on_plate(double height = 2) {
  return text_of(R"(
format = 1
[case]
name = "column"
[time]
end = 1
[geometry.tank]
type = "box"
min = [0, 0]
max = [1, )",
                 height + 1, R"(]
open = ["top", "bottom"]
[[fluid]]
name = "water"
density = 1000
region = { type = "box", min = [0, 0], max = [1, )",
                 height, R"(] }
[mps]
spacing = 0.05
time_step = 2e-4
[[structure]]
name = "plate"
shape = "box"
min = [0, -0.05]
max = [1, 0]
young = 67.5e9
density = 2700
poisson = 0.34
clamp = ["left", "right"]
wet = ["top"]
[structure.fem]
divisions = [37, 4]
)");
}

inline CaseOption changed(const std::string& key, double value) { return set_option(text_of(key, "=", value)); }

}  // namespace greenwater::test
