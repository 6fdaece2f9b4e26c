#include "io/stl.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "io/data_file.hpp"
#include "io/number_text.hpp"

namespace greenwater {
namespace {

using Corner = std::array<coord, 3>;

// The binary form: a title, the number of triangles, then for each 12 floats (normal, three corners) and two bytes.
constexpr std::size_t title_bytes = 80, head_bytes = title_bytes + 4, triangle_bytes = 50, normal_bytes = 12;
constexpr coord largest_coordinate = 1e30;  // squares of it still fit into a double

bool usable(coord x) { return std::abs(x) <= largest_coordinate; }  // false for what is not a number

void add_triangle(TriangleMesh& mesh, const std::array<Corner, 3>& corners) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

// ---- binary ----

std::uint32_t whole_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;  // little-endian, on every machine
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

coord float_at(const std::string& bytes, std::size_t at) { return std::bit_cast<float>(whole_at(bytes, at)); }

std::uint64_t announced_bytes(const std::string& bytes) {
  return head_bytes + std::uint64_t{triangle_bytes} * whole_at(bytes, title_bytes);
}

void require_announced_size(const DataFile& file) {
  const std::string& bytes = file.text;
  require_at(file, {}, bytes.size() >= head_bytes, "this is no STL file: a binary one has at least ", head_bytes,
             " bytes, this has ", bytes.size(), ", and a text one begins with \"solid\"; export the surface again");
  const std::uint64_t wanted = announced_bytes(bytes);
  if (wanted == bytes.size()) return;
  const std::uint32_t count = whole_at(bytes, title_bytes);
  const std::string numbers = text_of("byte ", title_bytes, " announces ", count, " triangles, which need ", wanted,
                                      " bytes, but the file has ", bytes.size());
  require_at(file, {}, wanted / 100 <= bytes.size(), "this is no STL file, or a damaged one: ", numbers,
             "; export the surface again");
  const std::size_t whole = (bytes.size() - head_bytes) / triangle_bytes;
  require_at(file, {}, wanted < bytes.size(), "the file is cut short after triangle ", whole, ": ", numbers,
             "; copy or export it again");
  refuse(file, {}, "the file is longer than its triangles: ", numbers, "; export the surface again");
}

TriangleMesh read_binary(const DataFile& file) {
  require_announced_size(file);
  TriangleMesh mesh;
  const std::uint32_t count = whole_at(file.text, title_bytes);
  mesh.triangles.reserve(count);
  mesh.vertices.reserve(std::size_t{3} * count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::size_t at = head_bytes + triangle_bytes * std::size_t{t} + normal_bytes;
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 9; ++c) {
      coord& x = corners[c / 3][c % 3];
      x = float_at(file.text, at + 4 * c);
      require_at(file, {}, usable(x), "triangle ", t + 1, " of ", count, " (byte ", at + 4 * c, "): corner ", c / 3 + 1,
                 " has the coordinate ", x,
                 ", which is not a usable number; mend it in the program that wrote the file");
    }
    add_triangle(mesh, corners);
  }
  return mesh;
}

// ---- text ----

/// The words of a text STL one after the other, each with its place.
class StlText {
 public:
  explicit StlText(const DataFile& file) : file_(file) { next(); }

  bool ended() const { return word_.empty(); }
  bool is(std::string_view wanted) const {
    return std::equal(word_.begin(), word_.end(), wanted.begin(), wanted.end(),
                      [](unsigned char a, char b) { return std::tolower(a) == b; });
  }
  void next() {
    const std::string_view text = file_.text;
    for (; at_ < text.size() && std::isspace(static_cast<unsigned char>(text[at_])) != 0; ++at_) {
      if (text[at_] == '\n') begin_line(at_ + 1);
    }
    const std::size_t begin = at_;
    while (at_ < text.size() && std::isspace(static_cast<unsigned char>(text[at_])) == 0) ++at_;
    word_ = text.substr(begin, at_ - begin);
    spot_ = {line_, static_cast<int>(begin - line_begin_) + 1, std::max(1, static_cast<int>(word_.size()))};
  }
  /// Past the rest of the line of this word: behind `solid` and `endsolid` stands a name with blanks.
  void skip_line() {
    at_ = std::min(file_.text.find('\n', at_), file_.text.size());
    next();
  }
  void expect_word(std::string_view wanted, int triangle) {
    refuse_end(triangle);
    if (!is(wanted)) {
      const bool more_corners = wanted == "endloop" && is("vertex");
      refuse(file_, spot_, "triangle ", triangle, ": \"", wanted, "\" is wanted here, found \"", word_.substr(0, 40),
             more_corners ? "\": a face with more than three corners; split faces into triangles before the export"
                          : "\"; export the surface again");
    }
    next();
  }
  coord number(int triangle) {
    refuse_end(triangle);
    coord value = 0;
    const NumberText kind = parse_number(word_, value);
    require_at(file_, spot_, kind != NumberText::none, "triangle ", triangle, ": \"", word_.substr(0, 40),
               "\" is not a number; a coordinate is written like 0.25 or 2.5e-1");
    require_at(file_, spot_, usable(value) && kind == NumberText::number, "triangle ", triangle, ": the coordinate ",
               word_, " is not a usable number; mend it in the program that wrote the file");
    next();
    return value;
  }
  void skip_word(int triangle) {
    refuse_end(triangle);
    next();
  }
  void refuse_end(int triangle) const {
    require_at(file_, {line_, 1, 1}, !ended(), "the file is cut short: it ends within triangle ", triangle,
               "; copy or export it again");
  }
  /// Throws: `wanted` words stand at the beginning of a line, and none of them is here.
  [[noreturn]] void refuse_word(std::string_view wanted, int triangle) const {
    require_at(file_, {line_, 1, 1}, !ended(), "the file is cut short: it ends after triangle ", triangle,
               " without \"endsolid\"; copy or export it again");
    refuse(file_, spot_, wanted, " is wanted here, found \"", word_.substr(0, 40), "\"; export the surface again");
  }

 private:
  void begin_line(std::size_t at) {
    ++line_;
    line_begin_ = at;
  }

  const DataFile& file_;
  std::size_t at_ = 0, line_begin_ = 0;
  int line_ = 1;
  std::string_view word_;
  DataSpot spot_;
};

std::array<Corner, 3> read_facet(StlText& text, int triangle) {
  text.expect_word("facet", triangle);
  text.expect_word("normal", triangle);
  for (int i = 0; i < 3; ++i) text.skip_word(triangle);
  text.expect_word("outer", triangle);
  text.expect_word("loop", triangle);
  std::array<Corner, 3> corners;
  for (Corner& corner : corners) {
    text.expect_word("vertex", triangle);
    for (coord& x : corner) x = text.number(triangle);
  }
  text.expect_word("endloop", triangle);
  text.expect_word("endfacet", triangle);
  return corners;
}

TriangleMesh read_text(const DataFile& file) {
  TriangleMesh mesh;
  const auto count = [&] { return static_cast<int>(mesh.triangles.size()); };
  StlText text(file);
  while (!text.ended()) {  // some programs write several solids
    if (!text.is("solid")) text.refuse_word("\"solid\"", count());
    text.skip_line();
    while (text.is("facet")) add_triangle(mesh, read_facet(text, count() + 1));
    if (!text.is("endsolid")) text.refuse_word("\"facet\" or \"endsolid\"", count());
    text.skip_line();
  }
  return mesh;
}

bool fits_its_count(const std::string& bytes) {
  return bytes.size() >= head_bytes && announced_bytes(bytes) == bytes.size();
}

/// "solid" is no proof: binary files begin with it too, but their size fits their number of triangles.
bool is_text(const std::string& bytes) {
  if (fits_its_count(bytes)) return false;
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || looks_binary(bytes)) return false;
  constexpr std::string_view solid = "solid";
  const std::string_view first = std::string_view(bytes).substr(begin, solid.size());
  return std::equal(first.begin(), first.end(), solid.begin(), solid.end(),
                    [](unsigned char a, char b) { return std::tolower(a) == b; });
}

/// Corners differ by the last digit of a float where programs compute them twice.
coord weld_tolerance(const TriangleMesh& mesh) {
  constexpr coord last_digit = 1e-7;
  coord largest = 0;
  for (const Corner& x : mesh.vertices)
    for (const coord c : x) largest = std::max(largest, std::abs(c));
  return last_digit * std::max(diagonal_of(mesh), largest);
}

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& path, const Place& place) {
  const DataFile file = read_data_file(path, place);
  require_at(file, {}, !file.text.empty(), "the file is empty; export the surface again");
  const bool text = is_text(file.text);
  require_at(file, {}, text || fits_its_count(file.text) || looks_binary(file.text),
             "this is no STL file: a text one begins with \"solid\", this begins with \"",
             file.text.substr(0, std::min<std::size_t>(file.text.find_first_of("\r\n"), 20)),
             "\"; export the surface as STL");
  TriangleMesh mesh = text ? read_text(file) : read_binary(file);
  require_at(file, {}, !mesh.triangles.empty(), "there are no triangles in the file; export the surface again");
  weld(mesh, weld_tolerance(mesh));
  return mesh;
}

}  // namespace greenwater
