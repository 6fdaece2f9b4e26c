#include "app/machine.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

// There where Kokkos brings OpenMP. With OMP_PROC_BIND the first thread is bound to one processor before main() begins, and
// only OpenMP still knows of how many.
extern "C" int omp_get_num_procs() __attribute__((weak));

namespace greenwater {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

double address_space_limit() {
  rlimit limit{};
  const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return limited ? static_cast<double>(limit.rlim_cur) : no_limit;
}

/// Containers: the kernel ends a program that takes more.
double control_group_limit() {
  for (const char* path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream stream(path);
    double bytes = 0;
    if (stream >> bytes && bytes > 0) return bytes;  // the word "max" is no number
  }
  return no_limit;
}

}  // namespace

double machine_memory() {
  const double physical = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::min({physical, address_space_limit(), control_group_limit()});
}

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

int machine_processors() {
  if (omp_get_num_procs) return omp_get_num_procs();
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

void leave_processor() {
  if (!std::getenv("OMP_PROC_BIND")) return;
  cpu_set_t all;
  std::memset(&all, 0xff, sizeof all);  // the system takes away what this process may not use
  sched_setaffinity(0, sizeof all, &all);
}

}  // namespace greenwater
