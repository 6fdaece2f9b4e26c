#pragma once
// A .vtp or .vtu as a reader would take it apart.

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/program.hpp"

namespace greenwater::test {

using Ints = std::vector<std::int32_t>;
using Floats = std::vector<float>;

/// The text between the two quotes behind the next `key`.
inline std::string quoted(const std::string& text, const std::string& key, std::size_t from = 0) {
  const std::size_t start = text.find('"', text.find(key, from)) + 1;
  return text.substr(start, text.find('"', start) - start);
}

/// The counts of the only piece, and by section and name what each array says of itself and its bytes.
struct VtkFile {
  std::string kind;
  std::map<std::string, int> counts;
  std::map<std::string, std::string> types, components, arrays;

  explicit VtkFile(const std::filesystem::path& path) {
    const std::string text = text_in(path);
    const std::string appended = "<AppendedData encoding=\"raw\">\n_", end = "\n</AppendedData>\n</VTKFile>\n";
    const std::size_t start = text.find(appended);
    REQUIRE(start != std::string::npos);
    REQUIRE(text.substr(text.size() - end.size()) == end);
    const std::string head = text.substr(0, start);
    const std::size_t first = start + appended.size();
    const std::string data = text.substr(first, text.size() - end.size() - first);
    kind = quoted(head, "type=", head.find("<VTKFile"));
    for (const std::string what : {"Points", "Verts", "Lines", "Strips", "Polys", "Cells"}) {
      if (contains(head, "NumberOf" + what)) counts[what] = std::stoi(quoted(head, "NumberOf" + what));
    }
    std::size_t read = 0;
    for (const std::string section :
         {"FieldData", "PointData", "CellData", "Points", "Verts", "Lines", "Polys", "Cells"}) {
      const std::size_t open = head.find('<' + section + '>'), close = head.find("</" + section + '>');
      if (open == std::string::npos) continue;
      REQUIRE(open < close);
      for (std::size_t at = head.find("<DataArray", open); at < close; at = head.find("<DataArray", at + 1)) {
        const std::string name = section + '/' + quoted(head, "Name=", at);
        const std::size_t offset = std::stoul(quoted(head, "offset=", at));
        std::uint64_t length = 0;
        REQUIRE(offset + sizeof length <= data.size());
        std::memcpy(&length, data.data() + offset, sizeof length);
        REQUIRE(offset + sizeof length + length <= data.size());
        types[name] = quoted(head, "type=", at);
        components[name] = section == "FieldData" ? "" : quoted(head, "NumberOfComponents=", at);
        arrays[name] = data.substr(offset + sizeof length, length);
        read += sizeof length + length;
      }
    }
    CHECK(read == data.size());  // nothing between the arrays, or read twice
  }

  template <class T>
  std::vector<T> values(const std::string& name) const {
    const std::string& bytes = arrays.at(name);
    std::vector<T> numbers(bytes.size() / sizeof(T));
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
  }
};

}  // namespace greenwater::test
