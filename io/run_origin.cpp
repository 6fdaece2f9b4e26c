#include "io/run_origin.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/build_facts.hpp"

namespace greenwater {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* program_name = "greenwater";

Json build() {
  const BuildFacts& facts = build_facts();
  return {{"version", std::string(facts.version)},
          {"git", std::string(facts.git)},
          {"compiler", std::string(facts.compiler)},
          {"build_type", std::string(facts.build_type)},
          {"flags", std::string(facts.flags)}};
}

Json kokkos() {
  const BuildFacts& facts = build_facts();
  return {{"version", std::string(facts.kokkos_version)},
          {"devices", std::string(facts.kokkos_devices)},
          {"arch", std::string(facts.kokkos_arch)},
          {"kernels", std::string(facts.kokkos_kernels)}};
}

}  // namespace

std::string manifest_text(const RunOrigin& origin, const std::optional<RunEnd>& end) {
  Json manifest;
  manifest["program"] = program_name;
  manifest["build"] = build();
  manifest["kokkos"] = kokkos();
  manifest["backend"] = origin.backend;
  manifest["threads"] = origin.threads;
  manifest["host"] = host_name();
  manifest["environment"] = run_environment();
  manifest["command_line"] = origin.command_line;
  manifest["case"] = {{"name", origin.case_name}, {"file", origin.case_file}, {"options", origin.case_options}};
  manifest["started"] = utc_text(origin.started);
  manifest["state"] = end ? "ended" : "running";
  if (end) {
    manifest["finished"] = utc_text(end->finished);
    manifest["steps"] = end->steps;
    manifest["time"] = end->time;
    manifest["exit"] = end->exit_code;
    manifest["outcome"] = end->outcome;
    if (!end->message.empty()) manifest["message"] = end->message;
  }
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool is_run_folder(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "manifest.json");
  if (!stream) return false;
  const Json manifest = Json::parse(stream, nullptr, false);
  return manifest.is_object() && manifest.contains("program") && manifest["program"] == program_name;
}

ResultsOrigin results_origin(const RunOrigin& origin, const std::string& case_text) {
  const BuildFacts& facts = build_facts();
  ResultsOrigin results;
  results.attributes = {{"program", program_name},
                        {"version", std::string(facts.version)},
                        {"git", std::string(facts.git)},
                        {"kokkos", std::string(facts.kokkos_version)},
                        {"backend", origin.backend},
                        {"command_line", shell_text(origin.command_line)},
                        {"created", utc_text(origin.started)}};
  results.case_text = case_text;
  return results;
}

std::map<std::string, std::string> run_environment() {
  constexpr std::array prefixes{"OMP_", "KOKKOS_", "GOMP_", "KMP_", "GREENWATER_", "HDF5_"};
  std::map<std::string, std::string> found;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const auto equals = text.find('=');
    const bool ours = std::any_of(prefixes.begin(), prefixes.end(), [&](const char* p) { return text.starts_with(p); });
    if (ours && equals != std::string::npos) found[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return found;
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string shell_text(const std::vector<std::string>& words) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_./=:,+@%").find(c) != std::string::npos;
  };
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace greenwater
