#include "io/section.hpp"

#include <algorithm>
#include <cmath>

#include "io/read_value.hpp"
#include "io/suggest.hpp"

namespace greenwater {
namespace {

/// Complains when one of the keys that stand in `table` is surely the wanted one, misspelt.
void refuse_near_miss(const ResolvedTable& table, const std::string& wanted) {
  if (!table.node || table.node->kind != CaseNode::Kind::table) return;
  for (const CaseNode& child : table.node->children) {
    if (table.was_asked(child.key) || nearest(child.key, {wanted}).empty()) continue;
    throw CaseError(unknown_key(child, table, "did you mean \"" + wanted + "\"?"));
  }
}

Place place_of(const ResolvedTable& table) {
  if (!table.node) return table.parent ? place_of(*table.parent) : Place{};
  Place place = table.node->key_place.file.empty() ? table.node->place : table.node->key_place;
  if (table.kind == ResolvedTable::Kind::root) place.line = place.column = 0;
  return place;
}

}  // namespace

const CaseNode* Section::find(const std::string& key) const {
  return table_->node ? table_->node->child(key) : nullptr;
}

const CaseNode* Section::ask(const std::string& key) {
  table_->ask(key);
  return find(key);
}

void Section::missing(const std::string& key, const std::string& unit, const std::string& shown) const {
  refuse_near_miss(*table_, key);
  const std::string line = toml_key(key) + " = " + shown;
  const std::string in_unit = unit.empty() || unit == "-" ? "" : " [" + unit + "]";
  if (table_->node) {
    refuse(place(), "missing key \"", key, '"', in_unit, " in ", header(), "; add for example: ", line);
  }
  if (table_->parent) refuse_near_miss(*table_->parent, table_->name);
  refuse(place(), "missing table ", header(), " with its key \"", key, '"', in_unit, "; add for example:\n    ",
         header(), "\n    ", line);
}

template <class T, class Read, class Print>
T Section::answer(const std::string& key, const std::string& unit, const Preset<T>& preset, Read read, Print print) {
  const CaseNode* node = ask(key);
  if (!node && preset.mandatory) missing(key, unit, print(preset.value));
  const T value = node ? read(*node) : preset.value;
  table_->values.push_back({key, print(value), unit, node ? node->origin : Origin::preset});
  return value;
}

double Section::number(const std::string& key, const std::string& unit, const Bounds& range,
                       const Preset<double>& preset) {
  return answer(
      key, unit, preset, [&](const CaseNode& node) { return read_number(node, key, unit, range); },
      [](double value) { return toml_number(value); });
}

std::int64_t Section::count(const std::string& key, std::int64_t low, const Preset<std::int64_t>& preset) {
  return answer(
      key, "-", preset, [&](const CaseNode& node) { return read_count(node, key, low); },
      [](std::int64_t value) { return toml_number(value); });
}

std::vector<std::int64_t> Section::counts(const std::string& key, std::int64_t low,
                                          const Preset<std::vector<std::int64_t>>& preset) {
  const auto read = [&](const CaseNode& node) {
    std::vector<std::int64_t> values;
    for (const CaseNode& item : items_of(node, key)) values.push_back(read_count(item, key, low));
    return values;
  };
  const auto print = [](const std::vector<std::int64_t>& values) {
    Words items;
    for (const std::int64_t value : values) items.push_back(toml_number(value));
    return toml_list(items);
  };
  return answer(key, "-", preset, read, print);
}

bool Section::flag(const std::string& key, const Preset<bool>& preset) {
  return answer(
      key, "", preset, [&](const CaseNode& node) { return read_flag(node, key); }, toml_flag);
}

std::string Section::text(const std::string& key, const Preset<std::string>& preset) {
  return answer(
      key, "", preset, [&](const CaseNode& node) { return read_text(node, key); },
      [](const std::string& value) { return toml_text(value); });
}

std::string Section::choice(const std::string& key, const Words& allowed, const Preset<std::string>& preset) {
  return answer(
      key, "", preset, [&](const CaseNode& node) { return read_choice(node, key, allowed); },
      [](const std::string& value) { return toml_text(value); });
}

Words Section::choices(const std::string& key, const Words& allowed, const Preset<Words>& preset) {
  const auto read = [&](const CaseNode& node) {
    Words words;
    if (node.kind == CaseNode::Kind::text) return Words{read_choice(node, key, allowed)};
    for (const CaseNode& item : items_of(node, key)) words.push_back(read_choice(item, key, allowed));
    return words;
  };
  return answer(key, "", preset, read, toml_texts);
}

Point Section::vector(const std::string& key, const std::string& unit, int dimension, const Preset<Point>& preset) {
  return answer(
      key, unit, preset, [&](const CaseNode& node) { return read_point(node, key, unit, dimension); },
      [&](const Point& value) { return toml_point(value, dimension); });
}

std::vector<Point> Section::points(const std::string& key, const std::string& unit, int dimension,
                                   const Preset<std::vector<Point>>& preset) {
  const auto read = [&](const CaseNode& node) {
    std::vector<Point> values;
    for (const CaseNode& item : items_of(node, key)) values.push_back(read_point(item, key, unit, dimension));
    return values;
  };
  const auto print = [&](const std::vector<Point>& values) {
    Words items;
    for (const Point& value : values) items.push_back(toml_point(value, dimension));
    return toml_list(items);
  };
  return answer(key, unit, preset, read, print);
}

std::filesystem::path Section::file(const std::string& key, const std::string& shown) {
  const CaseNode* node = ask(key);
  if (!node) missing(key, "", toml_text(shown));
  const std::string name = read_text(*node, key);
  require_at(node->place, !name.empty(), key, " is empty: it names a file");
  const std::filesystem::path path = beside_case(node->place, name);
  const std::string whole = std::filesystem::absolute(path).lexically_normal().string();
  table_->values.push_back({key, toml_text(whole), "", node->origin});
  return path;
}

std::string Section::formula(const std::string& key, const std::string& unit, const Preset<std::string>& preset) {
  return answer(
      key, unit, preset, [&](const CaseNode& node) { return read_formula(node, key, unit); },
      [](const std::string& value) { return toml_text(value); });
}

Formulas Section::formulas(const std::string& key, const std::string& unit, int dimension,
                           const Preset<Formulas>& preset) {
  const auto print = [&](const Formulas& values) {
    return toml_texts(Words(values.begin(), values.begin() + dimension));
  };
  return answer(
      key, unit, preset, [&](const CaseNode& node) { return read_formulas(node, key, unit, dimension); }, print);
}

Section Section::table(const std::string& key) {
  const CaseNode* node = ask(key);
  if (node) require_kind(*node, CaseNode::Kind::table, key);
  for (const auto& inner : table_->tables) {
    if (inner->name == key) return Section(*inner);
  }
  return Section(table_->add(key, ResolvedTable::Kind::table, node));
}

std::optional<Section> Section::table_if_present(const std::string& key) {
  table_->ask(key);
  if (!has(key)) return {};
  return table(key);
}

std::vector<Section> Section::list(const std::string& key) {
  std::vector<Section> sections;
  const CaseNode* node = ask(key);
  if (!node) return sections;
  require_at(node->key_place, node->kind == CaseNode::Kind::list, '"', key, "\" must be a list of tables; write [[",
             key, "]] above its keys");
  for (const CaseNode& item : node->children) {
    require_kind(item, CaseNode::Kind::table, key);
    sections.emplace_back(table_->add(key, ResolvedTable::Kind::list_item, &item));
  }
  return sections;
}

std::vector<std::pair<std::string, Section>> Section::named(const std::string& key) {
  std::vector<std::pair<std::string, Section>> sections;
  const CaseNode* node = ask(key);
  if (!node) return sections;
  Section group = table(key);
  for (const CaseNode& child : node->children) sections.emplace_back(child.key, group.table(child.key));
  return sections;
}

bool Section::has(const std::string& key) const { return find(key) != nullptr; }

bool Section::offers(const std::string& key) {
  table_->ask(key);
  return has(key);
}

bool Section::offers_some(const std::string& key) {
  const CaseNode* node = ask(key);
  return node != nullptr && (node->kind != CaseNode::Kind::list || !node->children.empty());
}

Place Section::place() const { return place_of(*table_); }

Place Section::place(const std::string& key) const {
  const CaseNode* node = find(key);
  return node ? node->place : place();
}

}  // namespace greenwater
