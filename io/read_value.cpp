#include "io/read_value.hpp"

#include <cmath>

#include "io/quantity.hpp"
#include "io/suggest.hpp"

namespace greenwater {
namespace {

std::string in_unit(const std::string& unit) { return unit.empty() || unit == "-" ? "" : " [" + unit + "]"; }

double quantity(const CaseNode& node, const std::string& key, const std::string& unit) {
  try {
    return parse_quantity(node.text, unit);
  } catch (const CaseError& fault) {
    refuse(node.place, key, ": ", fault.what());
  }
}

void require_in(const Bounds& range, double value, const CaseNode& node, const std::string& key,
                const std::string& unit) {
  require_at(node.place, std::isfinite(value), key, " must be a finite number", in_unit(unit), ", not ", value);
  const bool low_enough = range.low_itself ? value >= range.low : value > range.low;
  require_at(node.place, low_enough, key, " = ", toml_number(value), in_unit(unit), " must be ",
             range.low_itself ? "at least " : "above ", range.low);
  require_at(node.place, value <= range.high, key, " = ", toml_number(value), in_unit(unit), " must be at most ",
             range.high);
}

const std::vector<CaseNode>& components(const CaseNode& node, const std::string& key, const std::string& unit,
                                        int dimension) {
  const auto& items = items_of(node, key);
  require_at(node.place, items.size() == static_cast<std::size_t>(dimension), key, " needs ", dimension, " components",
             in_unit(unit), " in ", dimension, "-D, found ", items.size());
  return items;
}

}  // namespace

void require_kind(const CaseNode& node, CaseNode::Kind kind, const std::string& key) {
  require_at(node.place, node.kind == kind, key, " must be ", kind_name(kind), ", not ", kind_name(node.kind));
}

const std::vector<CaseNode>& items_of(const CaseNode& node, const std::string& key) {
  require_at(node.place, node.kind == CaseNode::Kind::list, key, " must be a list in brackets, not ",
             kind_name(node.kind));
  return node.children;
}

double read_number(const CaseNode& node, const std::string& key, const std::string& unit, const Bounds& range) {
  require_at(node.place, node.is_number() || node.kind == CaseNode::Kind::text, key, " must be a number", in_unit(unit),
             ", not ", kind_name(node.kind));
  const double value = node.kind == CaseNode::Kind::text    ? quantity(node, key, unit)
                       : node.kind == CaseNode::Kind::whole ? static_cast<double>(node.whole)
                                                            : node.real;
  require_in(range, value, node, key, unit);
  return value;
}

std::int64_t read_count(const CaseNode& node, const std::string& key, std::int64_t low) {
  constexpr double most = 9e15;  // beyond this a double is no longer exact
  const bool whole =
      node.kind == CaseNode::Kind::whole || (node.kind == CaseNode::Kind::real && std::floor(node.real) == node.real);
  require_at(node.place, whole, key, " must be a whole number, not ",
             node.kind == CaseNode::Kind::real ? toml_number(node.real) : std::string(kind_name(node.kind)));
  if (node.kind == CaseNode::Kind::real) require_in({-most, most, true}, node.real, node, key, "-");
  const std::int64_t value = node.kind == CaseNode::Kind::whole ? node.whole : static_cast<std::int64_t>(node.real);
  require_at(node.place, value >= low, key, " = ", value, " must be at least ", low);
  return value;
}

bool read_flag(const CaseNode& node, const std::string& key) {
  require_kind(node, CaseNode::Kind::flag, key);
  return node.flag;
}

std::string read_text(const CaseNode& node, const std::string& key) {
  require_kind(node, CaseNode::Kind::text, key);
  return node.text;
}

std::string read_choice(const CaseNode& node, const std::string& key, const Words& allowed) {
  const std::string word = read_text(node, key);
  for (const std::string& known : allowed) {
    if (word == known) return word;
  }
  const std::string near = nearest(word, allowed);
  refuse(node.place, key, " cannot be \"", word, "\"; ", near.empty() ? "" : "did you mean \"" + near + "\"? ",
         "known: ", listed(allowed));
}

Point read_point(const CaseNode& node, const std::string& key, const std::string& unit, int dimension) {
  Point point{};
  const auto& items = components(node, key, unit, dimension);
  for (std::size_t d = 0; d < items.size(); ++d) point[d] = read_number(items[d], key, unit, any_number);
  return point;
}

std::string read_formula(const CaseNode& node, const std::string& key, const std::string& unit) {
  require_at(node.place, node.is_number() || node.kind == CaseNode::Kind::text, key,
             " must be a number or a formula in quotes", in_unit(unit), ", not ", kind_name(node.kind));
  return node.kind == CaseNode::Kind::text ? node.text : toml_number(read_number(node, key, unit, any_number));
}

Formulas read_formulas(const CaseNode& node, const std::string& key, const std::string& unit, int dimension) {
  Formulas texts{"0", "0", "0"};
  const auto& items = components(node, key, unit, dimension);
  for (std::size_t d = 0; d < items.size(); ++d) texts[d] = read_formula(items[d], key, unit);
  return texts;
}

}  // namespace greenwater
