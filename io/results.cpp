#include "io/results.hpp"

#include <fmt/format.h>

#include "core/check.hpp"
#include "io/file.hpp"
#include "io/hdf5.hpp"

namespace greenwater {
namespace {

namespace fs = std::filesystem;

/// Where things are written to, and the path for messages.
struct Place5 {
  hid_t id;
  const fs::path& path;
};

/// Texts of variable length: h5py gives them as str, and none is too long for an attribute.
Hdf5Handle text_type(const fs::path& path) {
  Hdf5Handle type = hdf5_made(H5Tcopy(H5T_C_S1), H5Tclose, path, "text cannot be written");
  hdf5_done(H5Tset_size(type.id(), H5T_VARIABLE), path, "text cannot be written");
  hdf5_done(H5Tset_cset(type.id(), H5T_CSET_UTF8), path, "text cannot be written");
  return type;
}

Hdf5Handle one_value(const fs::path& path) {
  return hdf5_made(H5Screate(H5S_SCALAR), H5Sclose, path, "an attribute cannot be written");
}

void write_attribute(const Place5& place, const std::string& name, hid_t type, const void* value) {
  const std::string what = "attribute " + name + " cannot be written";
  const Hdf5Handle space = one_value(place.path);
  const Hdf5Handle attribute = hdf5_made(H5Acreate2(place.id, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                                         H5Aclose, place.path, what);
  hdf5_done(H5Awrite(attribute.id(), type, value), place.path, what);
}

void write_text(const Place5& place, const std::string& name, const std::string& text) {
  const char* first = text.c_str();
  write_attribute(place, name, text_type(place.path).id(), &first);
}

hid_t memory_type(const Column& column) {
  switch (column.values.index()) {
    case 0: return H5T_NATIVE_DOUBLE;
    case 1: return H5T_NATIVE_FLOAT;
    case 2: return H5T_NATIVE_INT64;
    default: return H5T_NATIVE_UINT8;
  }
}

bool is_real(const Column& column) { return column.values.index() < 2; }

hid_t file_type(const Column& column, Precision precision) {
  if (is_real(column)) return precision == Precision::float32 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  return column.values.index() == 2 ? H5T_STD_I64LE : H5T_STD_U8LE;
}

void write_column(const Place5& group, const Column& column, std::size_t rows, Precision precision) {
  const std::string what = "data set " + column.name + " cannot be written";
  const auto components = static_cast<hsize_t>(column.components);
  const hsize_t extent[2] = {rows, components};
  const Hdf5Handle space =
      hdf5_made(H5Screate_simple(components > 1 ? 2 : 1, extent, nullptr), H5Sclose, group.path, what);
  Hdf5Handle data = hdf5_made(H5Dcreate2(group.id, column.name.c_str(), file_type(column, precision), space.id(),
                                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                              H5Dclose, group.path, what);
  std::visit(
      [&](const auto& values) {
        expect(values.size() == rows * components);
        hdf5_done(H5Dwrite(data.id(), memory_type(column), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), group.path,
                  what);
      },
      column.values);
  write_text({data.id(), group.path}, "unit", column.unit);
  hdf5_done(data.close(), group.path, what);
}

/// The corners of all walls, one row each.
Table corners(const std::vector<WallShape>& walls) {
  std::vector<std::int64_t> wall;
  std::vector<double> position;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    for (const auto& corner : walls[k]) {
      wall.push_back(static_cast<std::int64_t>(k));
      position.insert(position.end(), corner.begin(), corner.end());
    }
  }
  Table table{"walls", 0, 0, wall.size(), {}};
  table.columns = {{"wall", "-", 1, std::move(wall)}, {"position", "m", 3, std::move(position)}};
  return table;
}

void write_group(hid_t parent, const Table& table, const fs::path& path, Precision precision) {
  const std::string what = "group " + table.name + " cannot be written";
  Hdf5Handle group =
      hdf5_made(H5Gcreate2(parent, table.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path, what);
  for (const Column& column : table.columns) write_column({group.id(), path}, column, table.rows, precision);
  hdf5_done(group.close(), path, what);
}

/// The frame is made without a name, brought to disk, and only then linked. Until then only the end of the file grows,
/// behind what is in use: a run that is killed meanwhile leaves all earlier frames. What remains are the microseconds
/// of the link itself (measured: one damaged file in 400 kills of a program that did nothing but write frames).
void append(hid_t file, const Table& table, const std::vector<Table>& groups, const std::string& name,
            const fs::path& path, Precision precision) {
  const std::string what = "frame " + name + " cannot be written";
  Hdf5Handle group = hdf5_made(H5Gcreate_anon(file, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path, what);
  const Place5 place{group.id(), path};
  write_attribute(place, "time", H5T_NATIVE_DOUBLE, &table.time);
  write_attribute(place, "step", H5T_NATIVE_INT64, &table.step);
  write_text(place, "name", table.name);
  write_text(place, "time_unit", "s");
  for (const Column& column : table.columns) write_column(place, column, table.rows, precision);
  for (const Table& inner : groups) write_group(group.id(), inner, path, precision);
  hdf5_done(H5Fflush(file, H5F_SCOPE_LOCAL), path, what);
  hdf5_done(H5Olink(group.id(), file, ("frames/" + name).c_str(), H5P_DEFAULT, H5P_DEFAULT), path, what);
  hdf5_done(group.close(), path, what);
}

}  // namespace

Results::Results(const fs::path& path, const ResultsOrigin& origin, Precision precision)
    : path_(path), precision_(precision) {
  quiet_hdf5();
  require_room(path.parent_path(), 1e6);
  Hdf5Handle file = hdf5_made(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, hdf5_access(path).id()), H5Fclose,
                              path, "cannot be created");
  const Place5 root{file.id(), path_};
  for (const auto& [name, text] : origin.attributes) write_text(root, name, text);
  write_text(root, "case", origin.case_text);
  hdf5_made(H5Gcreate2(file.id(), "frames", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path,
            "cannot be written");
  hdf5_done(file.close(), path, "cannot be closed");
}

void Results::write(const Table& table, const std::vector<WallShape>& walls, std::vector<Table> groups) {
  constexpr double overhead = 1e5;  // bytes of a frame's headers, generously
  if (!walls.empty()) groups.push_back(corners(walls));
  double bytes = stored_bytes(table, precision_) + overhead;
  for (const Table& group : groups) bytes += stored_bytes(group, precision_);
  require_room(path_.parent_path(), bytes);
  Hdf5Handle file = hdf5_made(H5Fopen(path_.c_str(), H5F_ACC_RDWR, hdf5_access(path_).id()), H5Fclose, path_,
                              "cannot be opened for the next frame");
  append(file.id(), table, groups, fmt::format("{:06d}", frames_), path_, precision_);
  hdf5_done(file.close(), path_, "cannot be closed after a frame");
  ++frames_;
}

double stored_bytes(const Table& table, Precision precision) {
  double bytes = 0;
  for (const Column& column : table.columns) {
    const std::size_t count = std::visit([](const auto& values) { return values.size(); }, column.values);
    const double real_size = precision == Precision::float32 ? 4 : 8;
    const double size = is_real(column) ? real_size : column.values.index() == 2 ? 8 : 1;
    bytes += static_cast<double>(count) * size;
  }
  return bytes;
}

}  // namespace greenwater
