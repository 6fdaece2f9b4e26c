// [geometry.NAME.motion]: how a geometry moves.

#include <cmath>

#include "app/formula.hpp"
#include "app/motion.hpp"
#include "app/scene_parts.hpp"
#include "io/number_file.hpp"

namespace greenwater {
namespace {

constexpr double at_rest = 1e-9;  // [m], [rad] what a formula may leave at t = 0

TimeTable read_table(Section& section, const std::string& key, std::size_t columns) {
  TimeTable table;
  const std::string path = section.file(key, "motion.csv").string();
  table.place = section.place(key);
  int line_before = 0;
  for (const NumberRow& row : read_number_rows(path, columns + 1, table.place)) {
    require_at(table.place, table.time.empty() || row.value[0] > table.time.back(), path,
               ": times must ascend, but line ", line_before, " has ", table.time.empty() ? 0.0 : table.time.back(),
               " s and line ", row.line, " has ", row.value[0], " s; sort the rows, and keep one for each time");
    table.time.push_back(row.value[0]);
    table.value.emplace_back(row.value.begin() + 1, row.value.end());
    line_before = row.line;
  }
  require_at(table.place, table.time.size() >= 2, path, ": a table over time needs at least 2 rows, found ",
             table.time.size());
  return table;
}

void require_start(const Place& place, const std::string& key, const std::string& unit, double value) {
  require_at(place, std::fabs(value) <= at_rest, key, " is ", value, ' ', unit,
             " at t = 0, but a geometry starts where the case puts it: make it 0 there, e.g. subtract ", value);
}

void read_translation(Section& section, int dimension, MotionCase& motion) {
  const auto columns = static_cast<std::size_t>(dimension);
  const Formulas shown{"0.1*(1 - cos(2*pi*t))", "0", "0"};
  if (section.offers("displacement"))
    motion.displacement = read_formulas(section, {"displacement", "m", example(shown), Variables::time}, dimension);
  if (section.offers("displacement_table"))
    motion.displacement_table = read_table(section, "displacement_table", columns);
  if (section.offers("velocity"))
    motion.velocity = read_formulas(section, {"velocity", "m/s", example(shown), Variables::time}, dimension);
  if (section.offers("velocity_table")) motion.velocity_table = read_table(section, "velocity_table", columns);
}

void read_axis(Section& section, int dimension, MotionCase& motion) {
  motion.about = section.vector("about", "m", dimension, example(Point{0.5, 0.0, 0.0}));
  if (dimension == 2) return;
  motion.axis = section.vector("axis", "-", dimension, example(Point{0, 1, 0}));
  const double length = std::hypot(motion.axis[0], motion.axis[1], motion.axis[2]);
  require_at(section.place("axis"), length > 1e-100 && std::isfinite(length),
             "axis has no direction; write for example axis = [0, 1, 0]");
}

void read_rotation(Section& section, int dimension, MotionCase& motion) {
  if (section.offers("rotation")) {
    const std::string text = section.formula("rotation", "rad", example<std::string>("0.1*sin(2*pi*t)"));
    motion.rotation = NumberFormula{text, section.place("rotation")};
    Formula(text, motion.rotation->place, Variables::time);
  }
  if (section.offers("rotation_table")) motion.rotation_table = read_table(section, "rotation_table", 1);
  const bool turns = motion.rotation || motion.rotation_table;
  for (const char* key : {"about", "axis"}) {
    require_at(section.place(key), turns || !section.offers(key), key,
               " belongs to a rotation; add rotation or rotation_table, or delete it");
  }
  if (turns) read_axis(section, dimension, motion);
}

void require_one_of_each(Section& section) {
  const auto at_most_one = [&](const Words& keys) {
    std::string found;
    for (const std::string& key : keys) {
      require_at(section.place(key), found.empty() || !section.has(key), "both ", found, " and ", key,
                 " say how the geometry moves: keep one of them");
      if (section.has(key)) found = key;
    }
  };
  at_most_one({"displacement", "displacement_table", "velocity", "velocity_table"});
  at_most_one({"rotation", "rotation_table"});
}

void check_start(const MotionCase& motion) {
  constexpr std::array axis{"x", "y", "z"};
  const auto of_component = [&](const char* key, std::size_t d) { return std::string(key) + " in " + axis[d]; };
  if (motion.displacement) {
    const auto formulas = compile(motion.displacement->text, motion.displacement->place, Variables::time);
    for (std::size_t d = 0; d < 3; ++d)
      require_start(motion.displacement->place, of_component("displacement", d), "m", formulas[d](0, 0, 0, 0));
  }
  if (const auto& table = motion.displacement_table) {
    for (std::size_t d = 0; d < table->value.front().size(); ++d)
      require_start(table->place, of_component("displacement_table", d), "m", value_of(*table, d, 0));
  }
  if (const auto& rotation = motion.rotation)
    require_start(rotation->place, "rotation", "rad",
                  Formula(rotation->text, rotation->place, Variables::time)(0, 0, 0, 0));
  if (const auto& table = motion.rotation_table)
    require_start(table->place, "rotation_table", "rad", value_of(*table, 0, 0));
}

}  // namespace

std::optional<MotionCase> read_motion(Section& geometry, int dimension) {
  auto section = geometry.table_if_present("motion");
  if (!section) return {};
  MotionCase motion;
  motion.place = section->place();
  require_one_of_each(*section);
  read_translation(*section, dimension, motion);
  read_rotation(*section, dimension, motion);
  check_start(motion);
  return motion;
}

void require_motion(const GeometryCase& geometry) {
  const MotionCase& motion = *geometry.motion;
  const bool moves = motion.displacement || motion.displacement_table || motion.velocity || motion.velocity_table;
  require_at(motion.place, moves || motion.rotation || motion.rotation_table, "[geometry.", geometry.name,
             ".motion] does not say how it moves; give it one of displacement, displacement_table, velocity, "
             "velocity_table, and/or one of rotation, rotation_table");
}

}  // namespace greenwater
