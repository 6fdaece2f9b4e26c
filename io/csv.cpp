#include "io/csv.hpp"

#include <fmt/format.h>

#include "core/check.hpp"

namespace greenwater {

Csv::Csv(const std::filesystem::path& path, const std::vector<std::string>& header)
    : file_(path), columns_(header.size()) {
  file_.write(fmt::format("{}\n", fmt::join(header, ",")));
  file_.flush();
}

void Csv::row(const std::vector<double>& values) {
  constexpr std::chrono::seconds longest_wait{1};
  expect(values.size() == columns_);
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{:.9g}\n", fmt::join(values, ","));
  file_.write(line_);
  const auto now = std::chrono::steady_clock::now();
  if (now - flushed_ < longest_wait) return;
  file_.flush();
  flushed_ = now;
}

void Csv::close() { file_.close(); }

}  // namespace greenwater
