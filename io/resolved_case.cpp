#include "io/resolved_case.hpp"

#include <algorithm>
#include <sstream>

#include "io/suggest.hpp"
#include "io/toml_text.hpp"

namespace greenwater {
namespace {

std::string_view origin_name(Origin origin) {
  switch (origin) {
    case Origin::file: return "case";
    case Origin::option: return "command line";
    case Origin::preset: return "default";
  }
  return "";
}

void print(std::ostream& out, const ResolvedTable& table) {
  const bool only_groups = table.values.empty() && !table.tables.empty();  // [geometry], [effects]
  if (table.kind != ResolvedTable::Kind::root && !only_groups) out << '\n' << table.header() << '\n';
  for (const ResolvedValue& value : table.values) {
    out << toml_key(value.key) << " = " << value.text << "  # ";
    if (!value.unit.empty()) out << value.unit << "; ";
    out << origin_name(value.origin) << '\n';
  }
  for (const auto& inner : table.tables) print(out, *inner);
}

const ResolvedTable& root_of(const ResolvedTable& table) { return table.parent ? root_of(*table.parent) : table; }

/// A table other than `from` in which the key is at home.
const ResolvedTable* home_of(const std::string& key, const ResolvedTable& table, const ResolvedTable& from) {
  if (&table != &from && table.was_asked(key)) return &table;
  for (const auto& inner : table.tables) {
    if (const auto* found = home_of(key, *inner, from)) return found;
  }
  return nullptr;
}

std::string what_may_be_meant(const std::string& key, const ResolvedTable& table) {
  const std::string near = nearest(key, table.asked);
  if (!near.empty()) return "did you mean \"" + near + "\"?";
  if (const auto* home = home_of(key, root_of(table), table)) return "it is a key of " + home->header();
  std::vector<std::string> known = table.asked;
  std::sort(known.begin(), known.end());
  return "known here: " + listed(known);
}

void collect(const ResolvedTable& table, std::vector<std::string>& complaints) {
  if (table.node && table.node->kind == CaseNode::Kind::table) {
    for (const CaseNode& child : table.node->children) {
      if (!table.was_asked(child.key))
        complaints.push_back(unknown_key(child, table, what_may_be_meant(child.key, table)));
    }
  }
  for (const auto& inner : table.tables) collect(*inner, complaints);
}

}  // namespace

std::string ResolvedTable::path() const {
  if (kind == Kind::root) return {};
  const std::string above = parent->path();
  return above.empty() ? toml_key(name) : above + '.' + toml_key(name);
}

std::string ResolvedTable::header() const {
  if (kind == Kind::root) return "the case";
  return kind == Kind::table ? '[' + path() + ']' : "[[" + path() + "]]";
}

bool ResolvedTable::was_asked(const std::string& key) const {
  return std::find(asked.begin(), asked.end(), key) != asked.end();
}

void ResolvedTable::ask(const std::string& key) {
  if (!was_asked(key)) asked.push_back(key);
}

ResolvedTable& ResolvedTable::add(const std::string& key, Kind how, const CaseNode* where) {
  tables.push_back(std::make_unique<ResolvedTable>());
  ResolvedTable& table = *tables.back();
  table.name = key;
  table.kind = how;
  table.parent = this;
  table.node = where;
  return table;
}

std::string resolved_text(const ResolvedTable& root, const std::string& file_name) {
  std::ostringstream out;
  out << "# Every value of " << toml_text(file_name) << " as it was used, in SI units (m, kg, s, Pa, N, rad).\n"
      << "# Behind each: its unit, and where it came from (case, command line, default).\n";
  print(out, root);
  return out.str();
}

std::string unknown_key(const CaseNode& node, const ResolvedTable& table, const std::string& meant) {
  const bool is_table = node.kind == CaseNode::Kind::table && table.kind == ResolvedTable::Kind::root;
  const std::string what =
      is_table ? "unknown table [" + toml_key(node.key) + "]" : "unknown key \"" + node.key + "\" in " + table.header();
  return complaint(node.key_place, what + "; " + meant);
}

std::vector<std::string> unknown_keys(const ResolvedTable& root) {
  std::vector<std::string> complaints;
  collect(root, complaints);
  return complaints;
}

}  // namespace greenwater
