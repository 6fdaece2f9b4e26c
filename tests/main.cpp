// One Kokkos for all tests. Threads as OMP_NUM_THREADS says.
#define CATCH_CONFIG_RUNNER
#include "core/kokkos.hpp"
#include "tests/catch.hpp"

int main(int argc, char** argv) {
  greenwater::Runtime runtime(0);
  return Catch::Session().run(argc, argv);
}
