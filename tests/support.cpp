#include "tests/support.hpp"

namespace greenwater::test {
namespace {

Ears* listening = nullptr;

void hear_launch(const char* label, const uint32_t, uint64_t*) {
  if (listening) listening->launches.emplace_back(label);
}

void hear_allocation(const Kokkos_Profiling_SpaceHandle, const char* label, const void*, const uint64_t) {
  if (listening) listening->allocations.emplace_back(label);
}

}  // namespace

Ears::Ears() {
  listening = this;
  Kokkos::Tools::Experimental::set_begin_parallel_for_callback(hear_launch);
  Kokkos::Tools::Experimental::set_begin_parallel_reduce_callback(hear_launch);
  Kokkos::Tools::Experimental::set_begin_parallel_scan_callback(hear_launch);
  Kokkos::Tools::Experimental::set_allocate_data_callback(hear_allocation);
}

Ears::~Ears() {
  listening = nullptr;
  Kokkos::Tools::Experimental::set_begin_parallel_for_callback(nullptr);
  Kokkos::Tools::Experimental::set_begin_parallel_reduce_callback(nullptr);
  Kokkos::Tools::Experimental::set_begin_parallel_scan_callback(nullptr);
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
}

}  // namespace greenwater::test
