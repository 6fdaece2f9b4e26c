#pragma once
// A case file with the changes from the command line, ready to be asked. It knows no key: read_scene() does.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/place.hpp"
#include "io/section.hpp"

namespace greenwater {

/// A value from the command line that replaces or adds one in the case.
struct CaseOption {
  std::string shown;  ///< as typed, for messages: `--set mps.spacing=0.002`
  std::string key;    ///< dotted path; items of a list by number from 0: `probe.0.every_time`
  std::string value;  ///< TOML, or a text without quotes
};

/// `KEY=VALUE` taken apart. Throws CaseError when it is not of that form.
CaseOption set_option(const std::string& argument);

class CaseFile {
 public:
  /// Reads the file. Throws CaseError when it cannot be read or is not TOML, with place and cure.
  explicit CaseFile(const std::filesystem::path& path, const std::vector<CaseOption>& options = {});
  /// The same from a text in memory; `name` stands for the file in messages.
  CaseFile(std::string text, const std::string& name, const std::vector<CaseOption>& options);

  /// The whole case, to be asked key by key.
  Section root() { return Section(*resolved_); }

  /// Call after the last question: every key that nobody asked for is a CaseError, all of them in one message.
  void finish() const;

  /// The resolved case as TOML: every value with every default, SI, with unit and origin behind it; reads back to the
  /// same scene.
  std::string resolved() const;

  const std::string& name() const { return name_; }  ///< as given
  const std::string& text() const { return text_; }  ///< byte for byte
  /// The options as typed, for the record.
  const std::vector<std::string>& options() const { return options_; }

 private:
  std::string name_, text_;
  std::vector<std::string> options_;
  std::unique_ptr<CaseNode> tree_;
  std::unique_ptr<ResolvedTable> resolved_;
};

}  // namespace greenwater
