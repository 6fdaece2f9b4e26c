#include "app/info.hpp"

#include <fmt/format.h>

#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "app/machine.hpp"
#include "core/build_facts.hpp"
#include "core/kokkos.hpp"
#include "core/real.hpp"
#include "io/run_origin.hpp"
#include "io/toml_text.hpp"

namespace greenwater {
namespace {

struct Fact {
  std::string name, text;
  bool number = false;
};

Fact words(const std::string& name, std::string_view text) { return {name, std::string(text), false}; }
Fact number(const std::string& name, double value) { return {name, fmt::format("{:.15g}", value), true}; }

std::vector<Fact> facts() {
  const BuildFacts& build = build_facts();
  return {words("version", build.version),
          words("git", build.git),
          words("compiler", build.compiler),
          words("build_type", build.build_type),
          words("flags", build.flags),
          words("kokkos_version", build.kokkos_version),
          words("kokkos_devices", build.kokkos_devices),
          words("kokkos_arch", build.kokkos_arch),
          words("kokkos_kernels", build.kokkos_kernels),
          words("backend", Runtime::space_name()),
          number("threads", Runtime::concurrency()),
          words("precision", sizeof(real) == sizeof(float) ? "single" : "double"),
          words("host", host_name()),
          number("processors", machine_processors()),
          number("memory_bytes", machine_memory()),
          number("most_particles", std::numeric_limits<int>::max()),
          words("dimensions", "2 3")};
}

}  // namespace

std::string info_text(bool json) {
  std::string text = json ? "{" : "greenwater\n";
  for (const Fact& fact : facts()) {
    if (json) {  // TOML's escapes are JSON's
      text += fmt::format("{}\"{}\": {}", text.size() > 1 ? ",\n " : "", fact.name,
                          fact.number ? fact.text : toml_text(fact.text));
    } else {
      text += fmt::format("  {:<16} {}\n", fact.name, fact.text);
    }
  }
  return json ? text + "}\n" : text;
}

}  // namespace greenwater
