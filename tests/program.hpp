#pragma once
// For tests of files and of the whole program: a folder that goes away, and a started program with its answers.

#include <filesystem>
#include <string>
#include <vector>

namespace greenwater::test {

/// An empty folder of its own, removed with everything in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

std::string text_in(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

struct Answer {
  int code = -1;  // exit code; 128 + signal when it was killed
  std::string out, err;
};

/// True when the program is built.
bool program_is_there();

/// Runs the program in `folder` on one thread and waits for it. `signal_when`: as soon as this file is there, the
/// program gets SIGTERM.
Answer run_program(const std::vector<std::string>& arguments, const TemporaryFolder& folder,
                   const std::string& signal_when = {});

/// A small dam break that runs in less than a second, with frames and two probes.
std::string small_case();

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace greenwater::test
