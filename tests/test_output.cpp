// The files of a run: right while they grow, and readable whenever the run ends.

#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>

#include "core/check.hpp"
#include "io/csv.hpp"
#include "io/hdf5.hpp"
#include "io/paraview.hpp"
#include "io/results.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"
#include "tests/vtk_file.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const ResultsOrigin origin{{{"git", "1a2b3c4"}, {"command_line", "greenwater run a.toml"}}, "format = 1\n"};

/// Particle i of frame `step` has the pressure step + i / 8 and the place (i, 0.5, -i / 4), which float32 holds
/// exactly.
Table table_of(std::size_t rows, std::int64_t step, std::size_t dim = 2) {
  Table table{"water", 0.25 * static_cast<double>(step), step, rows, {}};
  std::vector<std::int64_t> id(rows);
  std::vector<double> position(dim * rows), pressure(rows);
  std::vector<std::uint8_t> surface(rows, 1);
  for (std::size_t i = 0; i < rows; ++i) {
    id[i] = static_cast<std::int64_t>(i);
    pressure[i] = static_cast<double>(step) + static_cast<double>(i) / 8;
    const double at[3] = {static_cast<double>(i), 0.5, -static_cast<double>(i) / 4};
    for (std::size_t d = 0; d < dim; ++d) position[dim * i + d] = at[d];
  }
  table.columns = {{"id", "-", 1, id},
                   {"position", "m", static_cast<int>(dim), position},
                   {"pressure", "Pa", 1, pressure},
                   {"surface", "-", 1, surface}};
  return table;
}

std::string text_attribute(hid_t object, const char* name) {
  const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  REQUIRE(attribute.id() >= 0);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  char* text = nullptr;
  REQUIRE(H5Aread(attribute.id(), type.id(), static_cast<void*>(&text)) >= 0);
  const std::string copy = text;
  H5free_memory(text);
  return copy;
}

/// Opens the file as any reader would, checks every value of every frame, and returns how many frames there are.
std::size_t checked_frames(const std::filesystem::path& path, std::size_t rows) {
  quiet_hdf5();
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  REQUIRE(file.id() >= 0);
  CHECK(text_attribute(file.id(), "git") == "1a2b3c4");
  CHECK(text_attribute(file.id(), "case") == "format = 1\n");
  const Hdf5Handle frames(H5Gopen2(file.id(), "frames", H5P_DEFAULT), H5Gclose);
  H5G_info_t info{};
  REQUIRE(H5Gget_info(frames.id(), &info) >= 0);
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    const std::string name = "00000" + std::to_string(k);
    const Hdf5Handle frame(H5Gopen2(frames.id(), name.substr(name.size() - 6).c_str(), H5P_DEFAULT), H5Gclose);
    const Hdf5Handle data(H5Dopen2(frame.id(), "pressure", H5P_DEFAULT), H5Dclose);
    REQUIRE(data.id() >= 0);
    std::vector<double> pressure(rows, -1);
    REQUIRE(H5Dread(data.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, pressure.data()) >= 0);
    const Table written = table_of(rows, static_cast<std::int64_t>(k));
    CHECK(pressure == std::get<std::vector<double>>(written.columns[2].values));
    CHECK(text_attribute(data.id(), "unit") == "Pa");
    double time = -1;
    const Hdf5Handle at(H5Aopen(frame.id(), "time", H5P_DEFAULT), H5Aclose);
    REQUIRE(H5Aread(at.id(), H5T_NATIVE_DOUBLE, &time) >= 0);
    CHECK(time == written.time);
  }
  return info.nlinks;
}

/// A data set of two dimensions, row by row; `columns` gets its width.
std::vector<double> matrix(hid_t parent, const char* name, hsize_t& columns) {
  const Hdf5Handle data(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  REQUIRE(data.id() >= 0);
  const Hdf5Handle space(H5Dget_space(data.id()), H5Sclose);
  REQUIRE(H5Sget_simple_extent_ndims(space.id()) == 2);
  hsize_t extent[2];
  H5Sget_simple_extent_dims(space.id(), extent, nullptr);
  columns = extent[1];
  std::vector<double> values(extent[0] * extent[1]);
  REQUIRE(H5Dread(data.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  return values;
}

/// A floor of a 3-D tank, a triangle, and between them a line as of a 2-D scene; all moved to the right by x.
std::vector<WallShape> three_walls(double x) {
  return {{{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 2, 0}, {x, 2, 0}},
          {{x, 0, 0}, {x, 0, 3}},
          {{x, 0, 0}, {x, 0.5, 0}, {x, 0, 0.25}}};
}

}  // namespace

TEST_CASE("results.h5 is whole after every frame", "[unit][output]") {
  const TemporaryFolder folder;
  for (const std::size_t rows : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
    Results results(folder / "results.h5", origin, Precision::float32);
    CHECK(checked_frames(results.path(), rows) == 0);
    for (std::int64_t step = 0; step < 12; ++step) {
      results.write(table_of(rows, step));
      CHECK(checked_frames(results.path(), rows) == static_cast<std::size_t>(step) + 1);
    }
  }
}

TEST_CASE("a killed run leaves a readable results.h5", "[unit][output]") {
  const TemporaryFolder folder;
  int pipe_ends[2];
  REQUIRE(pipe(pipe_ends) == 0);
  const pid_t child = fork();
  if (child == 0) {
    Results results(folder / "results.h5", origin, Precision::float64);
    for (std::int64_t step = 0; step < 3; ++step) results.write(table_of(500, step));
    if (write(pipe_ends[1], "x", 1) != 1) _exit(1);
    pause();
    _exit(0);
  }
  char told = 0;
  REQUIRE(read(pipe_ends[0], &told, 1) == 1);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFSIGNALED(status));
  CHECK(checked_frames(folder / "results.h5", 500) == 3);
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST_CASE("a reader at work does not end a run", "[unit][output]") {
  const TemporaryFolder folder;
  Results results(folder / "results.h5", origin, Precision::float32);
  results.write(table_of(10, 0));
  const pid_t child = fork();
  if (child == 0) {  // another program with the file open, and locked as readers do
    const hid_t file = H5Fopen(results.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    _exit(file < 0 ? 1 : (usleep(300000), 0));
  }
  usleep(100000);
  CHECK_NOTHROW(results.write(table_of(10, 1)));
  int status = 1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(checked_frames(results.path(), 10) == 2);
}

TEST_CASE("files that cannot be written are named, with exit code 4", "[unit][output]") {
  const TemporaryFolder folder;
  const auto refused = [](const auto& action) {
    try {
      action();
    } catch (const FileError& error) {
      CHECK(error.code == 4);
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(contains(refused([&] { Results(folder / "no/results.h5", origin, Precision::float32); }), "no/results.h5"));
  CHECK(contains(refused([&] { Csv(folder / "no/a.csv", {"t"}); }), "No such file"));
  CHECK(contains(refused([&] { write_atomically(folder / "no/a.json", "{}"); }), "No such file"));
  CHECK(contains(refused([&] { require_room(folder.path(), 1e30); }), "the disk is full"));
  CHECK(contains(refused([&] { Csv("/dev/full", {"t"}); }), "/dev/full: error: cannot be written: No space left"));
  CHECK(contains(refused([&] {
                   Results results(folder / "results.h5", origin, Precision::float32);
                   std::filesystem::remove(folder / "results.h5");
                   results.write(table_of(5, 0));
                 }),
                 "cannot be opened for the next frame"));
}

TEST_CASE("places in three dimensions and moving walls are in results.h5", "[unit][output]") {
  const TemporaryFolder folder;
  Results results(folder / "results.h5", origin, Precision::float32);
  results.write(table_of(5, 0, 3), three_walls(0));
  results.write(table_of(5, 1, 3), three_walls(0.125));
  results.write(table_of(5, 2, 3));
  CHECK(checked_frames(results.path(), 5) == 3);
  const Hdf5Handle file(H5Fopen(results.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  hsize_t width = 0;
  const auto particles = matrix(file.id(), "frames/000001/position", width);
  CHECK(width == 3);
  CHECK(particles == std::get<std::vector<double>>(table_of(5, 1, 3).columns[1].values));
  const auto corners = matrix(file.id(), "frames/000001/walls/position", width);
  CHECK(width == 3);
  std::vector<double> expected;
  for (const WallShape& wall : three_walls(0.125))
    for (const auto& corner : wall) expected.insert(expected.end(), corner.begin(), corner.end());
  CHECK(corners == expected);
  const Hdf5Handle wall(H5Dopen2(file.id(), "frames/000001/walls/wall", H5P_DEFAULT), H5Dclose);
  std::vector<std::int64_t> numbers(9, -1);
  REQUIRE(H5Dread(wall.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) >= 0);
  CHECK(numbers == std::vector<std::int64_t>{0, 0, 0, 0, 1, 1, 2, 2, 2});
  const Hdf5Handle position(H5Dopen2(file.id(), "frames/000001/walls/position", H5P_DEFAULT), H5Dclose);
  CHECK(text_attribute(position.id(), "unit") == "m");
  CHECK(text_attribute(wall.id(), "unit") == "-");
  CHECK(H5Lexists(file.id(), "frames/000000/walls", H5P_DEFAULT) > 0);
  CHECK(H5Lexists(file.id(), "frames/000002/walls", H5P_DEFAULT) == 0);  // walls that stand are not repeated
}

TEST_CASE("a .vtp has the arrays where it says", "[unit][output]") {
  const TemporaryFolder folder;
  for (const std::size_t dim : {std::size_t{2}, std::size_t{3}}) {
    Paraview paraview(folder.path(), "water");
    for (std::int64_t step = 0; step < 3; ++step) paraview.write(table_of(7, step, dim));
    const VtkFile vtp(folder / "water/water_000002.vtp");
    CHECK(vtp.counts ==
          std::map<std::string, int>{{"Points", 7}, {"Verts", 7}, {"Lines", 0}, {"Strips", 0}, {"Polys", 0}});
    CHECK(vtp.arrays.size() == 7);
    CHECK(vtp.values<double>("FieldData/TimeValue") == std::vector<double>{0.5});
    CHECK(vtp.values<std::int64_t>("PointData/id") == std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6});
    CHECK(vtp.values<float>("PointData/pressure") == Floats{2, 2.125, 2.25, 2.375, 2.5, 2.625, 2.75});
    CHECK(vtp.values<std::uint8_t>("PointData/surface") == std::vector<std::uint8_t>(7, 1));
    CHECK(vtp.values<std::int32_t>("Verts/connectivity") == Ints{0, 1, 2, 3, 4, 5, 6});
    CHECK(vtp.values<std::int32_t>("Verts/offsets") == Ints{1, 2, 3, 4, 5, 6, 7});
    Floats points;
    for (int i = 0; i < 7; ++i) {  // two components are padded with z = 0
      const auto x = static_cast<float>(i);
      points.insert(points.end(), {x, 0.5F, dim == 3 ? -x / 4 : 0.0F});
    }
    CHECK(vtp.values<float>("Points/Points") == points);
    CHECK(contains(text_in(folder / "water.pvd"), "timestep=\"0.5\" part=\"0\" file=\"water/water_000002.vtp\""));
  }
}

TEST_CASE("walls are lines and polygons", "[unit][output]") {
  const TemporaryFolder folder;
  write_walls(folder / "walls.vtp", three_walls(0));
  const VtkFile vtp(folder / "walls.vtp");
  CHECK(vtp.counts ==
        std::map<std::string, int>{{"Points", 9}, {"Verts", 0}, {"Lines", 1}, {"Strips", 0}, {"Polys", 2}});
  CHECK(vtp.values<std::int32_t>("Lines/connectivity") == Ints{4, 5});
  CHECK(vtp.values<std::int32_t>("Lines/offsets") == Ints{2});
  CHECK(vtp.values<std::int32_t>("Polys/connectivity") == Ints{0, 1, 2, 3, 6, 7, 8});
  CHECK(vtp.values<std::int32_t>("Polys/offsets") == Ints{4, 7});
  CHECK(vtp.values<float>("Points/Points") ==
        Floats{0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 2, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0.25F});
  CHECK(vtp.arrays.count("FieldData/TimeValue") == 0);

  write_walls(folder / "flat.vtp", {{{0, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {1, 2, 0}}});
  const VtkFile flat(folder / "flat.vtp");
  CHECK(flat.counts.at("Lines") == 2);
  CHECK(flat.counts.at("Polys") == 0);
  CHECK(flat.values<std::int32_t>("Lines/connectivity") == Ints{0, 1, 2, 3});
  CHECK(flat.values<std::int32_t>("Lines/offsets") == Ints{2, 4});
}

TEST_CASE("walls that move have frames with times", "[unit][output]") {
  const TemporaryFolder folder;
  Paraview moving(folder.path(), "walls");
  moving.write(0, three_walls(0));
  moving.write(0.25, three_walls(0.5));
  const VtkFile vtp(folder / "walls/walls_000001.vtp");
  CHECK(vtp.values<double>("FieldData/TimeValue") == std::vector<double>{0.25});
  CHECK(vtp.values<float>("Points/Points").at(0) == 0.5F);
  CHECK(vtp.values<std::int32_t>("Polys/offsets") == Ints{4, 7});
  const std::string pvd = text_in(folder / "walls.pvd");
  CHECK(contains(pvd, "timestep=\"0\" part=\"0\" file=\"walls/walls_000000.vtp\""));
  CHECK(contains(pvd, "timestep=\"0.25\" part=\"0\" file=\"walls/walls_000001.vtp\""));
}

TEST_CASE("no walls and empty tables are files too", "[unit][output]") {
  const TemporaryFolder folder;
  write_walls(folder / "none.vtp", {});
  CHECK(VtkFile(folder / "none.vtp").counts.at("Points") == 0);
  Paraview paraview(folder.path(), "water");
  paraview.write(table_of(0, 0));
  CHECK(VtkFile(folder / "water/water_000000.vtp").counts.at("Points") == 0);
}

TEST_CASE("a .csv has one header, plain digits and is on disk at once", "[unit][output]") {
  const TemporaryFolder folder;
  Csv csv(folder / "front.csv", {"time[s]", "front[m]"});
  CHECK(text_in(folder / "front.csv") == "time[s],front[m]\n");
  csv.row({0, 0.1});
  CHECK(text_in(folder / "front.csv") == "time[s],front[m]\n0,0.1\n");
  csv.row({1.0 / 3, 123456789.0});
  csv.row({1e-10, -1});
  csv.close();
  CHECK(text_in(folder / "front.csv") == "time[s],front[m]\n0,0.1\n0.333333333,123456789\n1e-10,-1\n");
}
