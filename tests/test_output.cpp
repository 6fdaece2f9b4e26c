// The files of a run: right while they grow, and readable whenever the run ends.

#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <map>

#include "core/check.hpp"
#include "io/csv.hpp"
#include "io/hdf5.hpp"
#include "io/paraview.hpp"
#include "io/results.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const ResultsOrigin origin{{{"git", "1a2b3c4"}, {"command_line", "greenwater run a.toml"}}, "format = 1\n"};

/// Particle i of frame `step` has the pressure step + i / 8, which float32 holds exactly.
Table table_of(std::size_t rows, std::int64_t step) {
  Table table{"water", 0.25 * static_cast<double>(step), step, rows, {}};
  std::vector<std::int64_t> id(rows);
  std::vector<double> position(2 * rows), pressure(rows);
  std::vector<std::uint8_t> surface(rows, 1);
  for (std::size_t i = 0; i < rows; ++i) {
    id[i] = static_cast<std::int64_t>(i);
    pressure[i] = static_cast<double>(step) + static_cast<double>(i) / 8;
    position[2 * i] = static_cast<double>(i);
    position[2 * i + 1] = 0.5;
  }
  table.columns = {{"id", "-", 1, id},
                   {"position", "m", 2, position},
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

/// The text between the next two quotes.
std::string quoted(const std::string& text, std::size_t from) {
  const std::size_t start = text.find('"', from) + 1;
  return text.substr(start, text.find('"', start) - start);
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

TEST_CASE("a .vtp has the arrays where it says", "[unit][output]") {
  const TemporaryFolder folder;
  Paraview paraview(folder.path(), "water");
  for (std::int64_t step = 0; step < 3; ++step) paraview.write(table_of(7, step));
  const std::string text = text_in(folder / "water/water_000002.vtp");
  const std::size_t start = text.find("<AppendedData encoding=\"raw\">\n_");
  REQUIRE(start != std::string::npos);
  const std::string data = text.substr(text.find('_', start) + 1);
  const std::string head = text.substr(0, start);
  CHECK(contains(head, "NumberOfPoints=\"7\" NumberOfVerts=\"7\""));
  const std::map<std::string, std::size_t> bytes{{"TimeValue", 8}, {"id", 56},     {"pressure", 28},
                                                 {"surface", 7},   {"Points", 84}, {"connectivity", 28},
                                                 {"offsets", 28}};
  std::size_t found = 0;
  for (std::size_t at = head.find("Name=\""); at != std::string::npos; at = head.find("Name=\"", at + 1), ++found) {
    const std::string name = quoted(head, at);
    const std::size_t offset = std::stoul(quoted(head, head.find("offset=\"", at)));
    std::uint64_t length = 0;
    REQUIRE(offset + sizeof length <= data.size());
    std::memcpy(&length, data.data() + offset, sizeof length);
    INFO(name);
    CHECK(length == bytes.at(name));
    if (name != "Points") continue;
    float first[6];
    std::memcpy(first, data.data() + offset + sizeof length, sizeof first);
    CHECK(first[3] == 1.0F);  // x of particle 1; y = 0.5 behind it, and z = 0 as padding
    CHECK(first[4] == 0.5F);
    CHECK(first[5] == 0.0F);
  }
  CHECK(found == bytes.size());
  CHECK(contains(text_in(folder / "water.pvd"), "timestep=\"0.5\" part=\"0\" file=\"water/water_000002.vtp\""));
}

TEST_CASE("walls and empty tables are files too", "[unit][output]") {
  const TemporaryFolder folder;
  write_walls(folder / "walls.vtp", {{0, 0, 0, 1, 0, 0}, {1, 0, 0, 1, 2, 0}});
  CHECK(contains(text_in(folder / "walls.vtp"), "NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"2\""));
  CHECK_NOTHROW(write_walls(folder / "none.vtp", {}));
  Paraview paraview(folder.path(), "water");
  CHECK_NOTHROW(paraview.write(table_of(0, 0)));
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
