#include "io/log.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "io/clock.hpp"

namespace greenwater {
namespace {

constexpr int rows_per_header = 40;
constexpr const char* yellow = "\033[33m";

std::string progress_text(const Progress& progress) {
  return fmt::format("step {}  t {:.5f} of {:.5g} s  {:5.1f} %  {:.1f} ms/step  left {}  ends {}", progress.step,
                     progress.time, progress.end, 100 * progress.fraction, progress.ms_per_step,
                     duration_text(progress.eta), finish_text(std::chrono::system_clock::now(), progress.eta));
}

/// Cut to the width of the terminal: a line that wraps cannot be written over.
std::string fitted(const std::string& text) {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? text.substr(0, size.ws_col - 1U) : text;
}

}  // namespace

Log::Log(const LogOptions& options)
    : options_(options), live_(isatty(STDOUT_FILENO) != 0), last_progress_(std::chrono::steady_clock::now()) {
  options_.color = color_allowed(options.color, STDOUT_FILENO);
}

Log::~Log() { clear_live_line(); }

void Log::open(const std::filesystem::path& path) {
  file_.emplace(path);
  file_->write(before_open_);
  file_->flush();
  before_open_.clear();
}

void Log::say(const std::string& line) {
  if (options_.verbosity != Verbosity::quiet) to_terminal(line);
  to_file(line);
}

void Log::note(const std::string& line) {
  if (options_.verbosity == Verbosity::verbose) to_terminal(line);
  to_file(line);
}

void Log::thermo(const std::string& header, const std::string& line) {
  if (rows_++ % rows_per_header == 0) note(header);
  note(line);
}

void Log::progress(const Progress& progress) {
  using namespace std::chrono_literals;
  if (options_.verbosity != Verbosity::normal) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_progress_ < (live_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10s))) return;
  last_progress_ = now;
  const std::string text = progress_text(progress);
  if (!live_) return to_terminal(text);
  std::fputs(("\r" + fitted(text) + "\033[K").c_str(), stdout);
  std::fflush(stdout);
  live_line_ = true;
}

void Log::warn(const Notice& notice, std::int64_t step) {
  const std::string line = fmt::format("W {:6d}  {}", step, notice.text);
  for (Counted& known : counted_) {
    if (known.kind != notice.kind) continue;
    known.count += notice.count;
    if (notice.each) note(line);
    return;
  }
  counted_.push_back({notice.kind, notice.count, step});
  if (options_.verbosity != Verbosity::quiet) to_terminal(line, yellow);
  to_file(line);
}

std::vector<std::string> Log::warning_counts() const {
  std::vector<std::string> lines;
  for (const Counted& known : counted_) {
    lines.push_back(
        fmt::format("warning   {}: {} time(s), first at step {}", known.kind, known.count, known.first_step));
  }
  return lines;
}

std::int64_t Log::warnings() const {
  std::int64_t sum = 0;
  for (const Counted& known : counted_) sum += known.count;
  return sum;
}

void Log::to_file(const std::string& line) {
  if (!file_) {
    before_open_ += line + '\n';
    return;
  }
  file_->write(line + '\n');
  file_->flush();
}

void Log::to_terminal(const std::string& line, const char* color) {
  clear_live_line();
  const bool painted = options_.color && *color != '\0';
  fmt::print(stdout, "{}{}{}\n", painted ? color : "", line, painted ? "\033[0m" : "");
  std::fflush(stdout);
}

void Log::clear_live_line() {
  if (!live_line_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
  live_line_ = false;
}

bool color_allowed(bool wanted, int file_descriptor) {
  const char* forbidden = std::getenv("NO_COLOR");
  return wanted && (forbidden == nullptr || *forbidden == '\0') && isatty(file_descriptor) != 0;
}

}  // namespace greenwater
