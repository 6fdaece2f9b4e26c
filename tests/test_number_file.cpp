// Tables of numbers in text files: what is understood, and how the rest is refused.

#include "app/scene_parts.hpp"
#include "io/number_file.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

using Rows = std::vector<std::vector<double>>;
const Place named{"case.toml", 12, 8, 1, nullptr};

Rows rows_of(const std::string& text, std::size_t columns = 2) {
  const TemporaryFolder folder;
  write_text(folder / "points.csv", text);
  return read_number_file(folder / "points.csv", columns, named);
}

std::string complaint_about(const std::string& text, std::size_t columns = 2) {
  try {
    rows_of(text, columns);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("tables of numbers are read as people write them", "[unit][number_file]") {
  const Rows rows{{0, 0.5}, {1, -2e-3}};
  CHECK(rows_of("0,0.5\n1,-2e-3\n") == rows);
  CHECK(rows_of("0, 0.5\r\n1, -2e-3\r\n") == rows);
  CHECK(rows_of("x[m];y[m]\n0 ; 0.5\n+1;-.002") == rows);
  CHECK(rows_of("# tank\n\nx y\n[m] [m]\n\t0\t0.5  # foot\n 1   -0.002 \n\n") == rows);
  CHECK(rows_of("\xEF\xBB\xBF"
                "0,0.5\n1,-2e-3\n") == rows);
  CHECK(rows_of("7\n8\n", 1) == Rows{{7}, {8}});
  CHECK(rows_of("1e-999,-1E-999\n") == Rows{{0, 0}});
}

TEST_CASE("faults in tables of numbers are told with file, line and column", "[unit][number_file]") {
  const std::vector<std::array<std::string, 3>> slips{
      {"0,0\n1,2,3\n", "points.csv:2:5: error: ", "each row needs 2 numbers, found 3"},
      {"0,0\n1\n", "points.csv:2:1: error: ", "each row needs 2 numbers, found 1"},
      {"0,0\n0,5,1,5\n", "points.csv:2:5: error: ", "decimal comma"},
      {"0,0\n1,\n", "points.csv:2:3: error: ", "a number is missing"},
      {"0,0\n1,,2\n", "points.csv:2:3: error: ", "a number is missing"},
      {"0,0\n\n# more\n1, two\n", "points.csv:4:4: error: ", "\"two\" is not a number; write"},
      {"x,y\n0,0\nx,y\n", "points.csv:3:1: error: ", "\"x\" is not a number"},
      {"0,1.5m\n", "points.csv:1:3: error: ", "\"1.5m\" is not a number"},
      {"0,nan\n", "points.csv:1:3: error: ", "not a finite number"},
      {"0,-inf\n", "points.csv:1:3: error: ", "not a finite number"},
      {"0,1e999\n", "points.csv:1:3: error: ", "not a finite number"},
      {"", "points.csv: error: ", "no rows of numbers"},
      {"x,y\n# nothing\n", "points.csv: error: ", "no rows of numbers"},
      {std::string("0,0\n\0\1", 6), "points.csv: error: ", "not a text file"},
  };
  for (const auto& [text, place, what] : slips) {
    const std::string answer = complaint_about(text);
    INFO(answer);
    CHECK(contains(answer, place));
    CHECK(contains(answer, what));
    CHECK(contains(answer, "case.toml:12:8: the file is named here"));
  }
}

TEST_CASE("a table that cannot be opened is told at the place in the case", "[unit][number_file]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_number_file(folder / "none.csv", 2, named),
                    Catch::Contains("case.toml:12:8: error: there is no file") && Catch::Contains("none.csv"));
  CHECK_THROWS_WITH(read_number_file(folder.path(), 2, named), Catch::Contains("is not a file"));
}

TEST_CASE("files are looked for beside the case", "[unit][number_file]") {
  CHECK(beside_case({"cases/tank/case.toml", 3, 1, 1, nullptr}, "tank.csv") == "cases/tank/tank.csv");
  CHECK(beside_case({"case.toml", 3, 1, 1, nullptr}, "tank.csv") == "tank.csv");
  CHECK(beside_case({"cases/case.toml", 3, 1, 1, nullptr}, "/data/tank.csv") == "/data/tank.csv");
  CHECK(beside_case({"--set geometry.tank.file=a/b.stl", 0, 0, 1, nullptr}, "a/b.stl") == "a/b.stl");
}

TEST_CASE("points of a polyline do not repeat", "[unit][number_file]") {
  const TemporaryFolder folder;
  write_text(folder / "good.csv", "x,y\n0,0\n1,0\n1,2\n0,0\n");
  CHECK(read_point_file(folder / "good.csv", named) == std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 0, 0}});
  write_text(folder / "bad.csv", "x,y\n0,0\n# again\n0,0\n");
  CHECK_THROWS_WITH(read_point_file(folder / "bad.csv", named), Catch::Contains("lines 2 and 4 are the same point"));
}
