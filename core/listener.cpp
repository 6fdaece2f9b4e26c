#include "core/listener.hpp"

#include "core/kokkos.hpp"

namespace greenwater {
namespace {

Listener* listening = nullptr;

void launched(const char* label, const uint32_t, uint64_t*) {
  if (listening) listening->hear_launch(label);
}

void allocated(const Kokkos_Profiling_SpaceHandle, const char*, const void*, const uint64_t bytes) {
  if (listening) listening->hear_memory(static_cast<std::int64_t>(bytes));
}

void released(const Kokkos_Profiling_SpaceHandle, const char*, const void*, const uint64_t bytes) {
  if (listening) listening->hear_memory(-static_cast<std::int64_t>(bytes));
}

}  // namespace

Listener::Listener() {
  listening = this;
  Kokkos::Tools::Experimental::set_begin_parallel_for_callback(launched);
  Kokkos::Tools::Experimental::set_begin_parallel_reduce_callback(launched);
  Kokkos::Tools::Experimental::set_begin_parallel_scan_callback(launched);
  Kokkos::Tools::Experimental::set_allocate_data_callback(allocated);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(released);
}

Listener::~Listener() {
  if (listening != this) return;
  listening = nullptr;
  Kokkos::Tools::Experimental::set_begin_parallel_for_callback(nullptr);
  Kokkos::Tools::Experimental::set_begin_parallel_reduce_callback(nullptr);
  Kokkos::Tools::Experimental::set_begin_parallel_scan_callback(nullptr);
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(nullptr);
}

std::int64_t Listener::launches() const {
  std::int64_t sum = 0;
  for (const auto& [label, number] : launches_) sum += number;
  return sum;
}

std::int64_t Listener::launches(const std::string& label) const {
  const auto found = launches_.find(label);
  return found == launches_.end() ? 0 : found->second;
}

}  // namespace greenwater
