#pragma once
// What was asked for in a case, and what came out of it: the book that Section keeps.

#include <memory>
#include <string>
#include <vector>

#include "io/case_node.hpp"

namespace greenwater {

struct ResolvedValue {
  std::string key, text;  ///< as TOML
  std::string unit;       ///< SI, "-" without dimension, empty for what is no number
  Origin origin = Origin::preset;
};

struct ResolvedTable {
  enum class Kind { root, table, list_item };

  std::string name;  ///< own key
  Kind kind = Kind::root;
  ResolvedTable* parent = nullptr;
  const CaseNode* node = nullptr;  ///< nullptr: not in the case, all presets
  std::vector<std::string> asked;  ///< keys that somebody wanted to know, here or not
  std::vector<ResolvedValue> values;
  std::vector<std::unique_ptr<ResolvedTable>> tables;

  /// `[mps.pressure]`, `[[probe]]`, or `the case` for the root.
  std::string header() const;
  std::string path() const;  ///< `mps.pressure`
  bool was_asked(const std::string& key) const;
  void ask(const std::string& key);
  ResolvedTable& add(const std::string& key, Kind how, const CaseNode* where);
};

/// Every table with every value, its unit and its origin, as a case that reads back to the same.
std::string resolved_text(const ResolvedTable& root, const std::string& file_name);

/// One complaint for each key of the case that nobody asked for, with what may have been meant; empty when all is well.
std::vector<std::string> unknown_keys(const ResolvedTable& root);

/// The complaint about one such key.
std::string unknown_key(const CaseNode& node, const ResolvedTable& table, const std::string& meant);

}  // namespace greenwater
