#include "io/case_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

#include "io/nesting.hpp"

namespace greenwater {
namespace {

std::string read_whole(const std::filesystem::path& path) {
  constexpr std::uintmax_t largest = 64U << 20U;  // bytes; a case is text written by people
  std::error_code fault;
  const auto kind = std::filesystem::status(path, fault).type();
  require(kind != std::filesystem::file_type::not_found, path.string(), ": error: no such case file");
  require(kind == std::filesystem::file_type::regular, path.string(), ": error: not a file; give the .toml itself");
  const auto size = std::filesystem::file_size(path, fault);
  require(!fault && size <= largest, path.string(), ": error: too large for a case file");
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (size > 0) text << stream.rdbuf();
  require(stream.good() && text.good(), path.string(), ": error: cannot be read: ", std::strerror(errno));
  return text.str();
}

constexpr std::size_t longest_quote = 60;  // characters of an option that makes no sense

std::vector<std::string> parts_of(const CaseOption& option) {
  std::vector<std::string> parts;
  std::istringstream stream(option.key);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  require(parts.size() <= static_cast<std::size_t>(most_levels), option.shown.substr(0, longest_quote),
          ": error: a path of ", parts.size(),
          " keys, and no case has more than a few; write for example --set "
          "mps.spacing=0.002");
  bool whole = !parts.empty() && option.key.back() != '.';
  for (const std::string& part : parts) whole = whole && !part.empty();
  require(whole, option.shown, ": error: not a dotted path of keys; write for example --set mps.spacing=0.002");
  return parts;
}

CaseNode& item_of(CaseNode& list, const std::string& number, const CaseOption& option) {
  std::size_t index = 0;
  const auto [end, fault] = std::from_chars(number.data(), number.data() + number.size(), index);
  const bool is_number = fault == std::errc() && end == number.data() + number.size();
  require(is_number && index < list.children.size(), option.shown, ": error: \"", list.key, "\" is a list with ",
          list.children.size(), " item(s), numbered from 0; write for example ", list.key, ".0 instead of ", list.key,
          '.', number);
  return list.children[index];
}

CaseNode& entry_of(CaseNode& table, const std::string& key, const CaseOption& option) {
  require(table.kind == CaseNode::Kind::table, option.shown, ": error: \"", table.key, "\" is ", kind_name(table.kind),
          ", it has no key \"", key, '"');
  if (CaseNode* found = table.child(key)) return *found;
  CaseNode made;
  made.key = key;
  made.origin = Origin::option;
  made.place = made.key_place = Place{option.shown, 0, 0, 1, nullptr};
  table.children.push_back(std::move(made));
  return table.children.back();
}

void apply(CaseNode& root, const CaseOption& option) {
  CaseNode* node = &root;
  for (const std::string& part : parts_of(option)) {
    node = node->kind == CaseNode::Kind::list ? &item_of(*node, part, option) : &entry_of(*node, part, option);
  }
  const std::string key = node->key;
  *node = parse_option_value(option.value, option.shown);
  node->key = key;
}

}  // namespace

CaseOption set_option(const std::string& argument) {
  const auto equals = argument.find('=');
  require(equals != std::string::npos && equals > 0, "--set ", argument,
          ": error: not KEY=VALUE; write for example --set mps.spacing=0.002");
  return {"--set " + argument, argument.substr(0, equals), argument.substr(equals + 1)};
}

CaseFile::CaseFile(const std::filesystem::path& path, const std::vector<CaseOption>& options)
    : CaseFile(read_whole(path), path.string(), options) {}

CaseFile::CaseFile(std::string text, const std::string& name, const std::vector<CaseOption>& options)
    : name_(name),
      text_(std::move(text)),
      tree_(std::make_unique<CaseNode>(parse_toml(text_, name))),
      resolved_(std::make_unique<ResolvedTable>()) {
  for (const CaseOption& option : options) {
    apply(*tree_, option);
    options_.push_back(option.shown);
  }
  tree_->place = Place{name, 0, 0, 1, nullptr};
  resolved_->node = tree_.get();
}

void CaseFile::finish() const {
  std::string all;
  for (const std::string& complaint : unknown_keys(*resolved_)) all += (all.empty() ? "" : "\n") + complaint;
  require(all.empty(), all);
}

std::string CaseFile::resolved() const { return resolved_text(*resolved_, name_); }

}  // namespace greenwater
