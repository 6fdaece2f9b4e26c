#pragma once
// A case file as a tree of plain values that remember where they stand: what Section looks at.

#include <cstdint>
#include <string>
#include <vector>

#include "io/place.hpp"

namespace greenwater {

/// Where a value came from; printed beside it in the resolved case.
enum class Origin { file, option, preset };

struct CaseNode {
  enum class Kind { table, list, text, whole, real, flag, date };

  Kind kind = Kind::table;
  Origin origin = Origin::file;
  std::string key;  ///< own name; empty in a list and at the root
  Place key_place;  ///< of the key
  Place place;      ///< of the value
  std::string text;
  std::int64_t whole = 0;
  double real = 0;
  bool flag = false;
  std::vector<CaseNode> children;  ///< entries of a table in the order of the file, items of a list

  CaseNode* child(std::string_view name);
  const CaseNode* child(std::string_view name) const;
  bool is_number() const { return kind == Kind::whole || kind == Kind::real; }
};

/// "a number", "a text", "a table" ... for messages.
std::string_view kind_name(CaseNode::Kind kind);

/// The tree of a TOML text. Throws CaseError with place and cure when it is not TOML.
CaseNode parse_toml(const std::string& text, const std::string& file_name);

/// The value of `KEY=VALUE` read as TOML; what TOML does not know is taken as a text, so that the shell's quotes are
/// enough for `name=water` and `spacing=3 mm`. Its place is the option as typed.
CaseNode parse_option_value(const std::string& value, const std::string& option);

}  // namespace greenwater
