#include "io/nesting.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace greenwater {
namespace {

/// Of a name without quotes, or round it.
bool may_stand_between_dots(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == ' ' || c == '\t';
}

/// Goes through a text character by character and past comments and strings.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  char here() const { return text_[at_]; }
  TooDeep place() const { return {line_, column_}; }

  void next() {
    const char c = text_[at_++];
    const bool continues = (static_cast<unsigned char>(c) & 0xC0) == 0x80;  // a character of UTF-8
    column_ += continues ? 0 : 1;
    if (c != '\n') return;
    ++line_;
    column_ = 1;
  }

  void skip_comment() {
    while (!at_end() && here() != '\n') next();
  }

  /// In the one quote or the three that it began with; one that is not closed ends with its line.
  void skip_string() {
    const char quote = here();
    const bool has_lines = text_.substr(at_, 3) == std::string(3, quote);
    const std::string end(has_lines ? 3 : 1, quote);
    skip(end.size());
    while (!at_end() && (has_lines || here() != '\n')) {
      if (text_.substr(at_, end.size()) == end) return skip(end.size());
      skip(quote == '"' && here() == '\\' ? 2 : 1);
    }
  }

 private:
  void skip(std::size_t count) {
    for (std::size_t k = 0; k < count && !at_end(); ++k) next();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

}  // namespace

void check_nesting(std::string_view text, const std::function<void(const TooDeep&)>& refuse) {
  int brackets = 0, names = 1;  // open; joined by dots
  for (Scan scan(text); !scan.at_end();) {
    const char c = scan.here();
    if (c == '#') {
      scan.skip_comment();
      continue;
    }
    if (c == '"' || c == '\'') {
      scan.skip_string();
      continue;
    }
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
    if (c == '.')
      ++names;
    else if (!may_stand_between_dots(c))
      names = 1;
    if (brackets > most_levels || names > most_levels) return refuse(scan.place());
    scan.next();
  }
}

}  // namespace greenwater
