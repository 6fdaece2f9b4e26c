// The one file that knows the TOML library: text to CaseNode.

#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>

#include "io/case_node.hpp"
#include "io/nesting.hpp"

namespace greenwater {
namespace {

/// Makes the places of one file.
struct Text {
  std::string file;
  std::shared_ptr<const std::vector<std::string>> lines;

  Place at(const toml::source_region& region) const {
    Place place{file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), 1, lines};
    if (region.end.line == region.begin.line && region.end.column > region.begin.column) {
      place.length = static_cast<int>(region.end.column - region.begin.column);
    }
    return place;
  }
};

Text split(const std::string& text, const std::string& file) {
  auto lines = std::make_shared<std::vector<std::string>>();
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    lines->push_back(line);
  }
  return {file, std::move(lines)};
}

[[noreturn]] void refuse_depth(const Place& place) {
  refuse(place, "names, lists or tables lie in each other more than ", most_levels,
         " deep here, and no case needs more than a few; mend the dots or the brackets");
}

void require_shallow(const std::string& text, const Text& places) {
  check_nesting(text, [&](const TooDeep& at) { refuse_depth({places.file, at.line, at.column, 1, places.lines}); });
}

CaseNode convert(const toml::node& source, const Text& text, int level = 0);

void convert_table(const toml::table& table, const Text& text, int level, CaseNode& node) {
  node.kind = CaseNode::Kind::table;
  for (const auto& [key, value] : table) {
    CaseNode child = convert(value, text, level + 1);
    child.key = std::string(key.str());
    child.key_place = text.at(key.source());
    node.children.push_back(std::move(child));
  }
  std::stable_sort(node.children.begin(), node.children.end(), [](const CaseNode& a, const CaseNode& b) {
    return std::pair(a.key_place.line, a.key_place.column) < std::pair(b.key_place.line, b.key_place.column);
  });
}

CaseNode convert(const toml::node& source, const Text& text, int level) {
  CaseNode node;
  node.place = text.at(source.source());
  if (level > most_levels) refuse_depth(node.place);
  if (const auto* table = source.as_table()) {
    convert_table(*table, text, level, node);
  } else if (const auto* list = source.as_array()) {
    node.kind = CaseNode::Kind::list;
    for (const auto& item : *list) node.children.push_back(convert(item, text, level + 1));
  } else if (const auto* words = source.as_string()) {
    node.kind = CaseNode::Kind::text;
    node.text = words->get();
  } else if (const auto* whole = source.as_integer()) {
    node.kind = CaseNode::Kind::whole;
    node.whole = whole->get();
  } else if (const auto* real = source.as_floating_point()) {
    node.kind = CaseNode::Kind::real;
    node.real = real->get();
  } else if (const auto* flag = source.as_boolean()) {
    node.kind = CaseNode::Kind::flag;
    node.flag = flag->get();
  } else {
    node.kind = CaseNode::Kind::date;
  }
  return node;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// A point without a digit on that side of it (-1 before, +1 behind), and with one on the other.
bool lonely_point(std::string_view value, int side) {
  for (std::size_t i = 1; i < value.size(); ++i) {  // value[0] is the equals sign
    const char before = value[i - 1], behind = i + 1 < value.size() ? value[i + 1] : ' ';
    const char lacking = side < 0 ? before : behind, other = side < 0 ? behind : before;
    if (value[i] == '.' && !is_digit(lacking) && is_digit(other)) return true;
  }
  return false;
}

bool starts_with_word(std::string_view value) {
  const auto first = value.find_first_not_of(" \t", 1);
  return !value.empty() && first != std::string_view::npos && is_letter(value[first]);
}

/// What to do about a syntax error, from the library's words and the line that it stands on.
std::string cure(const std::string& fault, const std::string& line) {
  const std::string value = line.substr(std::min(line.find('='), line.size()));
  if (fault.find("redefine") != std::string::npos) return "; a key or table stands only once: delete or rename one";
  if (line.starts_with('[') && fault.find("expected ']'") != std::string::npos) return "; close the bracket: [name]";
  if (value.empty() && line.find('[') == std::string::npos)
    return "; a line is `key = value`, `[table]` or `# comment`";
  if (lonely_point(value, -1)) return "; write a digit before the point: 0.5, not .5";
  if (lonely_point(value, 1)) return "; write a digit after the point: 5.0, not 5.";
  if (starts_with_word(value)) return "; a text needs quotes: key = \"text\"";
  if (std::count(line.begin(), line.end(), '"') % 2 == 1) return "; a closing quote is missing";
  if (fault.find("end-of-file") != std::string::npos)
    return "; the file ends here: is it whole? close the bracket, or copy the rest again";
  return {};
}

std::string plain(std::string_view description) {
  std::string text(description);
  const std::string noise = "Error while parsing ";
  if (text.starts_with(noise)) text = "in " + text.substr(noise.size());
  return text;
}

toml::table parsed(const std::string& text, const Text& places) {
  try {
    return toml::parse(text, places.file);
  } catch (const toml::parse_error& fault) {
    const Place place = places.at(fault.source());
    const auto row = static_cast<std::size_t>(place.line);
    const std::string line = row >= 1 && row <= places.lines->size() ? (*places.lines)[row - 1] : "";
    const std::string what = plain(fault.description());
    refuse(place, "not valid TOML: ", what, cure(what, line));
  }
}

void mark_as_option(CaseNode& node, const Place& option) {
  node.origin = Origin::option;
  node.place = node.key_place = option;
  for (CaseNode& child : node.children) mark_as_option(child, option);
}

CaseNode plain_value(const std::string& value) {
  CaseNode node;
  const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), node.real);
  const bool number = fault == std::errc() && end == value.data() + value.size() && !value.empty();
  node.kind = number ? CaseNode::Kind::real : CaseNode::Kind::text;
  node.text = value;
  return node;
}

}  // namespace

CaseNode parse_toml(const std::string& text, const std::string& file_name) {
  const Text places = split(text, file_name);
  require_shallow(text, places);
  return convert(parsed(text, places), places);
}

CaseNode parse_option_value(const std::string& value, const std::string& option) {
  CaseNode node;
  const Text places{option, nullptr};
  check_nesting(value, [&](const TooDeep&) { refuse_depth({option, 0, 0, 1, nullptr}); });
  try {
    const toml::table table = toml::parse("value = " + value + "\n");
    node = table.size() == 1 ? convert(*table.get("value"), places) : plain_value(value);
  } catch (const toml::parse_error&) {
    node = plain_value(value);
  }
  mark_as_option(node, Place{option, 0, 0, 1, nullptr});
  return node;
}

}  // namespace greenwater
