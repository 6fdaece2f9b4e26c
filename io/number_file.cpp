#include "io/number_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "io/data_file.hpp"
#include "io/number_text.hpp"

namespace greenwater {
namespace {

struct Word {
  std::string_view text;
  DataSpot spot;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
bool is_comma(char c) { return c == ',' || c == ';'; }

/// Bytes that begin a character of UTF-8.
int characters(std::string_view text) {
  return static_cast<int>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// The words of a line; between two commas, and behind a last one, there is a word even if it is empty.
std::vector<Word> words_of(std::string_view line, int number) {
  std::vector<Word> words;
  bool wants_word = false;  // a comma came last
  for (std::size_t at = 0; at <= line.size();) {
    while (at < line.size() && is_blank(line[at])) ++at;
    std::size_t end = at;
    while (end < line.size() && !is_blank(line[end]) && !is_comma(line[end])) ++end;
    const bool ends_line = at == line.size();
    const bool comma_at_once = !ends_line && is_comma(line[at]);
    if (end > at || wants_word || comma_at_once) {
      words.push_back(
          {line.substr(at, end - at),
           {number, characters(line.substr(0, at)) + 1, std::max(1, characters(line.substr(at, end - at)))}});
    }
    if (ends_line) break;
    while (end < line.size() && is_blank(line[end])) ++end;
    wants_word = end < line.size() && is_comma(line[end]);
    at = wants_word ? end + 1 : end;
  }
  return words;
}

bool is_header(const std::vector<Word>& words) {
  double value = 0;
  return std::all_of(words.begin(), words.end(),
                     [&](const Word& w) { return parse_number(w.text, value) == NumberText::none; });
}

double number(const DataFile& file, const Word& word) {
  double value = 0;
  const NumberText kind = parse_number(word.text, value);
  if (word.text.empty()) refuse(file, word.spot, "a number is missing here; delete the comma or write the number");
  require_at(file, word.spot, kind != NumberText::none, '"', word.text,
             "\" is not a number; write for example 0.25 or 2.5e-1, and comments behind a #");
  require_at(file, word.spot, kind != NumberText::too_large && std::isfinite(value), word.text,
             " is not a finite number; correct it or delete the row");
  return value;
}

std::vector<double> numbers(const DataFile& file, const std::vector<Word>& words, std::size_t columns) {
  std::vector<double> row;
  for (const Word& word : words) row.push_back(number(file, word));
  if (row.size() == columns) return row;
  const DataSpot spot = row.size() > columns ? words[columns].spot : words.back().spot;
  const bool decimal_comma = row.size() == 2 * columns;
  refuse(file, spot, "each row needs ", columns, columns == 1 ? " number" : " numbers", ", found ", row.size(),
         decimal_comma ? "; is that a decimal comma? write 0.25, not 0,25" : "; correct the row");
}

}  // namespace

std::vector<NumberRow> read_number_rows(const std::filesystem::path& path, std::size_t columns, const Place& place) {
  const DataFile file = read_data_file(path, place);
  require_at(file, {}, !looks_binary(file.text), "this is not a text file; save the table as CSV in UTF-8");
  std::vector<NumberRow> rows;
  const std::string_view text = file.text;
  std::size_t at = text.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0;  // byte order mark
  for (int line = 1; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view content = text.substr(at, end - at);
    at = end + 1;
    const std::vector<Word> words = words_of(content.substr(0, content.find('#')), line);
    if (words.empty() || (rows.empty() && is_header(words))) continue;
    rows.push_back({line, numbers(file, words, columns)});
  }
  require_at(file, {}, !rows.empty(), "no rows of numbers; write ", columns, columns == 1 ? " number" : " numbers",
             " in each row");
  return rows;
}

std::vector<std::vector<double>> read_number_file(const std::filesystem::path& path, std::size_t columns,
                                                  const Place& place) {
  std::vector<std::vector<double>> values;
  for (NumberRow& row : read_number_rows(path, columns, place)) values.push_back(std::move(row.value));
  return values;
}

}  // namespace greenwater
