#pragma once
// A .msh file line by line, and complaints about its lines.

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "io/data_file.hpp"

namespace greenwater {

/// What a line is for, in messages: `node tag 3 of 8`, or without a number `the line of counts in $Nodes`.
struct MshItem {
  const char* what;
  std::int64_t number = 0, count = 0;
};
std::ostream& operator<<(std::ostream& out, const MshItem& item);

/// The lines of the file that are not blank, one after the other, in words between blanks. Members throw CaseError that
/// points at the line and says how to mend the file.
class MshLines {
 public:
  explicit MshLines(const DataFile& file) : file_(file) {}

  /// To the next line; false at the end of the file, where it stays.
  bool next();
  /// To the next line, which is one of a section and has from `least` to `most` words.
  void record(const MshItem& item, std::size_t least, std::size_t most);
  void record(const MshItem& item, std::size_t words) { record(item, words, words); }
  /// To the next line, which ends the section.
  void end_section(const std::string& section);
  /// Past the end of a section that nobody reads.
  void skip_section(const std::string& section);

  std::string_view line() const { return line_; }
  const std::vector<std::string_view>& words() const { return words_; }
  int number() const { return number_; }
  DataSpot spot(std::size_t word) const;
  /// The word in quotes, cut where it is long.
  std::string quote(std::size_t word) const;

  /// A word as a number; `what` it is stands in the complaint.
  std::int64_t whole(std::size_t word, const char* what) const;
  std::int64_t whole_from(std::int64_t least, std::int64_t most, std::size_t word, const char* what) const;
  /// How many of something: not more than the file has bytes.
  std::int64_t count(std::size_t word, const char* what) const;
  double coordinate(std::size_t word) const;

 private:
  void split();
  /// Throws when this is the last line of the file, without a newline: it is not what it should be because there is no
  /// more of it.
  void refuse_if_last() const;

  const DataFile& file_;
  std::size_t at_ = 0;  // where the next line begins; beyond the end of the text when the last one has no newline
  int number_ = 0;
  std::string_view line_;
  std::vector<std::string_view> words_;
};

}  // namespace greenwater
