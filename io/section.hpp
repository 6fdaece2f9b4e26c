#pragma once
// One table of a case, asked key by key. Each question fills in the default, checks kind, unit and range, converts to
// SI, and is remembered: what nobody asked for is a misspelt key, what was answered is the resolved case.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/resolved_case.hpp"
#include "io/toml_text.hpp"

namespace greenwater {

/// Which numbers are allowed; all of them must be finite.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_itself = true;  ///< `low` is allowed too
};
inline const Bounds any_number{};
inline const Bounds positive{0, std::numeric_limits<double>::infinity(), false};
inline Bounds at_least(double low) { return {low, std::numeric_limits<double>::infinity(), true}; }
inline Bounds between(double low, double high) { return {low, high, true}; }

/// What a key is when the case does not say: a value (the default), or an example (the key is mandatory, and the
/// complaint about its absence shows the example).
template <class T>
struct Preset {
  Preset(T preset) : value(std::move(preset)) {}  // NOLINT: a plain value is a default
  Preset(T shown, bool is_mandatory) : value(std::move(shown)), mandatory(is_mandatory) {}
  T value;
  bool mandatory = false;
};
template <class T>
Preset<T> example(T shown) {
  return {std::move(shown), true};
}

using Words = std::vector<std::string>;
using Formulas = std::array<std::string, 3>;

/// A table of the case, there or not: an absent one answers with its defaults, and with a complaint for what is
/// mandatory. Every getter throws CaseError with `file:line:column`, the table, the key, its unit and the cure.
class Section {
 public:
  explicit Section(ResolvedTable& table) : table_(&table) {}

  /// A number in SI; the case may write it with another unit of the same kind, as a text: "3 mm".
  double number(const std::string& key, const std::string& unit, const Bounds& range, const Preset<double>& preset);
  std::int64_t count(const std::string& key, std::int64_t low, const Preset<std::int64_t>& preset);
  /// A list of them.
  std::vector<std::int64_t> counts(const std::string& key, std::int64_t low,
                                   const Preset<std::vector<std::int64_t>>& preset);
  bool flag(const std::string& key, const Preset<bool>& preset);
  std::string text(const std::string& key, const Preset<std::string>& preset);
  std::string choice(const std::string& key, const Words& allowed, const Preset<std::string>& preset);
  /// A list of words; a word alone is a list of one.
  Words choices(const std::string& key, const Words& allowed, const Preset<Words>& preset);
  /// A file that must be named: beside the case where it is relative. The resolved case has its whole path, because it
  /// lies elsewhere. `shown`: for the complaint when it is missing.
  std::filesystem::path file(const std::string& key, const std::string& shown);

  /// `dimension` numbers, each also as a quantity; the rest of the point is 0.
  Point vector(const std::string& key, const std::string& unit, int dimension, const Preset<Point>& preset);
  std::vector<Point> points(const std::string& key, const std::string& unit, int dimension,
                            const Preset<std::vector<Point>>& preset);
  /// A number, or a formula as a text, which is not looked at here.
  std::string formula(const std::string& key, const std::string& unit, const Preset<std::string>& preset);
  /// `dimension` of them.
  Formulas formulas(const std::string& key, const std::string& unit, int dimension, const Preset<Formulas>& preset);

  /// A table inside this one; absent ones answer too.
  Section table(const std::string& key);
  /// The same where presence says something by itself.
  std::optional<Section> table_if_present(const std::string& key);
  /// `[[key]]`, in the order of the case.
  std::vector<Section> list(const std::string& key);
  /// `[key.NAME]` for any NAME, in the order of the case.
  std::vector<std::pair<std::string, Section>> named(const std::string& key);

  bool has(const std::string& key) const;
  /// As has(), for a key that may be left out: it counts as known where others are misspelt.
  bool offers(const std::string& key);
  /// As offers(), but an empty list counts as nothing.
  bool offers_some(const std::string& key);
  std::string header() const { return table_->header(); }
  Place place() const;                        ///< of the table
  Place place(const std::string& key) const;  ///< of the key's value; of the table when the key is absent

 private:
  const CaseNode* find(const std::string& key) const;
  const CaseNode* ask(const std::string& key);
  template <class T, class Read, class Print>
  T answer(const std::string& key, const std::string& unit, const Preset<T>& preset, Read read, Print print);
  [[noreturn]] void missing(const std::string& key, const std::string& unit, const std::string& shown) const;

  ResolvedTable* table_;
};

}  // namespace greenwater
