#include "io/gmsh_lines.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "io/number_text.hpp"

namespace greenwater {
namespace {

constexpr double largest_coordinate = 1e30;  // squares of it still fit into a double
constexpr std::size_t longest_quote = 40;    // characters of a wrong word in a message

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::ostream& operator<<(std::ostream& out, const MshItem& item) {
  out << item.what;
  if (item.number > 0) out << ' ' << item.number << " of " << item.count;
  return out;
}

bool MshLines::next() {
  const std::string_view text = file_.text;
  while (at_ < text.size()) {
    const std::size_t end = std::min(text.find('\n', at_), text.size());
    line_ = text.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    split();
    if (!words_.empty()) return true;
  }
  return false;
}

void MshLines::record(const MshItem& item, std::size_t least, std::size_t most) {
  const bool is_there = next();
  require_at(file_, {number_, 1, 1}, is_there, "the file is cut short: it ends where ", item,
             " should be; copy or save it again");
  if (words_[0][0] == '$') {
    refuse(file_, spot(0), item, " is missing: ", quote(0),
           " comes too early, so a count above is wrong or lines are lost; save the mesh again");
  }
  if (words_.size() >= least && words_.size() <= most) return;
  refuse_if_last();
  refuse(file_, spot(words_.size() < least ? words_.size() - 1 : most), item, " needs ",
         least < most ? "at least " : "", least, least == 1 ? " word" : " words", " in its line, found ", words_.size(),
         "; a count above is wrong or the line is damaged: save the mesh again");
}

void MshLines::end_section(const std::string& section) {
  const std::string wanted = "$End" + section.substr(1);
  const bool is_there = next();
  require_at(file_, {number_, 1, 1}, is_there, "the file is cut short: ", wanted, " is missing; copy or save it again");
  if (words_[0] == wanted) return;
  refuse_if_last();
  refuse(file_, spot(0), wanted, " is wanted here, found ", quote(0), ": ", section,
         " has more lines than it announces; save the mesh again");
}

void MshLines::skip_section(const std::string& section) {
  const std::string wanted = "$End" + section.substr(1);
  const DataSpot begin = spot(0);
  while (next()) {
    if (words_[0] == wanted) return;
  }
  refuse(file_, begin, "the file is cut short: ", section, " has no ", wanted, "; copy or save it again");
}

DataSpot MshLines::spot(std::size_t word) const {
  const std::string_view text = words_[word];
  return {number_, static_cast<int>(text.data() - line_.data()) + 1, static_cast<int>(text.size())};
}

std::string MshLines::quote(std::size_t word) const {
  return '"' + std::string(words_[word].substr(0, longest_quote)) + '"';
}

std::int64_t MshLines::whole(std::size_t word, const char* what) const {
  std::int64_t value = 0;
  if (parse_number(words_[word], value) == NumberText::number) return value;
  refuse(file_, spot(word), what, " must be a whole number, found ", quote(word), "; save the mesh again");
}

std::int64_t MshLines::whole_from(std::int64_t least, std::int64_t most, std::size_t word, const char* what) const {
  const std::int64_t value = whole(word, what);
  require_at(file_, spot(word), value >= least && value <= most, what, " must be from ", least, " to ", most,
             ", found ", value, "; save the mesh again");
  return value;
}

std::int64_t MshLines::count(std::size_t word, const char* what) const {
  const std::int64_t value = whole(word, what);
  require_at(file_, spot(word), value >= 0, what, " cannot be ", value, "; save the mesh again");
  require_at(file_, spot(word), value <= static_cast<std::int64_t>(file_.text.size()), what, ", ", value,
             ", is more than a file of ", file_.text.size(), " bytes can hold; copy or save it again");
  return value;
}

double MshLines::coordinate(std::size_t word) const {
  double value = 0;
  const NumberText kind = parse_number(words_[word], value);
  if (kind == NumberText::number && std::abs(value) <= largest_coordinate) return value;
  require_at(file_, spot(word), kind != NumberText::none, quote(word),
             " is not a number; a coordinate is written like 0.25 or 2.5e-1");
  refuse(file_, spot(word), "the coordinate ", quote(word),
         " is not a usable number; mend it in the program that wrote the file");
}

void MshLines::split() {
  words_.clear();
  for (std::size_t at = 0; at < line_.size();) {
    if (is_blank(line_[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < line_.size() && !is_blank(line_[end])) ++end;
    words_.push_back(line_.substr(at, end - at));
    at = end;
  }
}

void MshLines::refuse_if_last() const {
  require_at(file_, spot(words_.size() - 1), at_ <= file_.text.size(),
             "the file is cut short: it ends within this line; copy or save it again");
}

}  // namespace greenwater
