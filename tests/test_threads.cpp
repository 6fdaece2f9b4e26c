// The same order of particles, rows and images at any number of threads. Kokkos starts once in a process, so this test
// starts itself again with other numbers of threads and compares fingerprints.
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

// FNV-1a over the bytes of a value, and of a field's first entries.
template <class T>
void add_to(std::uint64_t& hash, const T& value) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
  for (std::size_t b = 0; b < sizeof value; ++b) hash = (hash ^ bytes[b]) * 1099511628211ULL;
}

template <class Field>
void add_to(std::uint64_t& hash, const Field& field, int entries) {
  const auto values = host(field);
  for (int k = 0; k < entries; ++k) add_to(hash, values(k));
}

std::uint64_t fingerprint(const Fluid& fluid) {
  std::uint64_t hash = 1469598103934665603ULL;
  add_to(hash, fluid.particles.id, fluid.particles.count);
  for (const auto& row : entries_of(fluid))
    for (const Entry& entry : row) {
      add_to(hash, entry.j);
      add_to(hash, entry.mirror);
      add_to(hash, entry.share);
      add_to(hash, entry.weight);
    }
  add_to(hash, fluid.particles.number_density, fluid.particles.count);
  add_to(hash, fluid.rows.near.weight_sum, fluid.particles.count);
  return hash;
}

std::string fingerprint_with(int threads) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = "OMP_NUM_THREADS=" + std::to_string(threads) + " '" + self + "' '[.fingerprint]'";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string found;
  char line[256];
  while (std::fgets(line, sizeof line, pipe))
    if (std::string(line).rfind("fingerprint", 0) == 0) found = line;
  REQUIRE(pclose(pipe) == 0);
  REQUIRE_FALSE(found.empty());
  return found;
}

}  // namespace

TEST_CASE("fingerprint of order", "[.fingerprint]") {
  WallFaces walls;
  walls.bodies = {{"tank"}};
  walls.faces = {segment(0, 0, 2, 0), segment(0, 0, 0, 2), segment(1, 0, 1, 1)};
  const Fluid flat = fluid_at(random_cloud(5000, 2, 1, 2), walls, {.spacing = 0.03});
  const Fluid deep = fluid_at(random_cloud(5000, 3, 2), {}, {.dim = 3, .spacing = 0.06});
  const Fluid crowd = fluid_at(random_cloud(1500, 2, 3, 1e-3), {}, {.spacing = 0.03});
  std::cout << "\nfingerprint " << std::hex << fingerprint(flat) << ' ' << fingerprint(deep) << ' '
            << fingerprint(crowd) << std::dec << std::endl;
}

TEST_CASE("order and rows are the same with 1, 2 and 4 threads", "[unit][threads]") {
  const std::string one = fingerprint_with(1);
  CHECK(fingerprint_with(2) == one);
  CHECK(fingerprint_with(4) == one);
}
