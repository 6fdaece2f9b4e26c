#include "tests/program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace greenwater::test {
namespace {

/// As the build says, or where it lies beside the tests.
const std::string& program_path() {
  static const std::string path = [] {
    const char* given = std::getenv("GREENWATER_PROGRAM");
    if (given != nullptr) return std::string(given);
    return (std::filesystem::canonical("/proc/self/exe").parent_path().parent_path() / "app/greenwater").string();
  }();
  return path;
}

[[noreturn]] void become_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                                 const std::filesystem::path& answers) {
  std::vector<char*> words{const_cast<char*>(program_path().c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const int out = open((answers / "out").c_str(), O_CREAT | O_WRONLY, 0644);
  const int err = open((answers / "err").c_str(), O_CREAT | O_WRONLY, 0644);
  if (chdir(folder.c_str()) != 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(err, STDERR_FILENO) < 0) _exit(99);
  close(STDIN_FILENO);
  setenv("OMP_NUM_THREADS", "1", 1);
  execv(program_path().c_str(), words.data());
  _exit(98);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "greenwater_test_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

bool program_is_there() { return access(program_path().c_str(), X_OK) == 0; }

Answer run_program(const std::vector<std::string>& arguments, const TemporaryFolder& folder,
                   const std::string& signal_when) {
  const TemporaryFolder answers;
  const pid_t child = fork();
  if (child == 0) become_program(arguments, folder.path(), answers.path());
  int status = 0;
  bool signalled = signal_when.empty();
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (!signalled && std::filesystem::exists(folder / signal_when)) {
      kill(child, SIGTERM);
      signalled = true;
    }
    usleep(2000);
  }
  Answer answer;
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  answer.out = text_in(answers / "out");
  answer.err = text_in(answers / "err");
  return answer;
}

std::string small_case() {
  return R"(format = 1
[case]
name = "small"
[time]
end = "20 ms"
[geometry.tank]
type = "box"
min = [0.0, 0.0]
max = [0.4, 0.4]
open = ["top"]
[geometry.plate]
type = "plate"
base = [0.3, 0.0]
height = 0.05
[[fluid]]
region = { type = "box", min = [0.0, 0.0], max = [0.1, 0.2] }
[mps]
spacing = 0.02
time_step = "2.3 ms"
[output]
every_time = 0.005
history_every_steps = 2
[[probe]]
name = "front"
kind = "wave_front"
[[probe]]
name = "load"
kind = "wall_force"
wall = "plate"
every_time = 0.01
)";
}

}  // namespace greenwater::test
