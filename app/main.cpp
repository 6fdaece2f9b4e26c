// greenwater: the command line in, an exit code out. The verbs are in run.cpp, plan.cpp, info.cpp and bench/.

#include <unistd.h>

#include <iostream>

#include "app/command_line.hpp"
#include "app/failure.hpp"
#include "app/info.hpp"
#include "app/machine.hpp"
#include "app/plan.hpp"
#include "app/run.hpp"
#include "app/simulation.hpp"
#include "bench/bench.hpp"
#include "core/kokkos.hpp"

namespace {

using namespace greenwater;

/// Reads the case and everything that can be known without computing.
Scene checked_scene(CaseFile& file) {
  Scene scene = read_scene(file);
  require_memory(plan_of(scene), machine_memory(), scene);
  return scene;
}

int check(const RunOptions& options) {
  CaseFile file(options.case_path, options.case_options);
  const Scene scene = checked_scene(file);
  const Runtime runtime(options.threads);
  const auto simulation = make_simulation(scene);  // what cannot be built is a wrong case too
  std::cout << "case      " << scene.name << (scene.title.empty() ? "" : ": ") << scene.title << '\n';
  for (const std::string& line : simulation->plan()) std::cout << line << '\n';
  std::cout << "exit 0 (the case is good; nothing was written)\n";
  return 0;
}

int run(const RunOptions& options) {
  CaseFile file(options.case_path, options.case_options);
  const Scene scene = checked_scene(file);
  const Runtime runtime(options.threads);
  return run_case(options, scene, file);
}

int info(bool json) {
  const Runtime runtime(0);
  std::cout << info_text(json);
  return 0;
}

int obey(const Command& command) {
  switch (command.verb) {
    case Command::Verb::run: return run(command.run);
    case Command::Verb::check: return check(command.run);
    case Command::Verb::info: return info(command.json);
    case Command::Verb::bench: return run_bench(command.bench);
    case Command::Verb::nothing: return 0;
  }
  return 1;
}

int complain(const Failure& failure, bool color) {
  constexpr const char *red = "\033[31m", *plain = "\033[0m";
  const bool painted = color_allowed(color, STDERR_FILENO);
  std::cerr << (painted ? red : "") << failure.message << (painted ? plain : "") << "\nexit " << failure.code << " ("
            << failure.kind << ")\n";
  return failure.code;
}

}  // namespace

int main(int argc, char** argv) {
  Command command;
  try {
    command = parse_command_line(argc, argv);
    return obey(command);
  } catch (...) {
    return complain(failure_of(std::current_exception()), command.run.color);
  }
}
