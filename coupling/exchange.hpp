#pragma once
// A field that crosses between host and device: always two memories, on a host back-end too, so that a value that was
// not handed over is missed everywhere and not only on a GPU.

#include <string>

#include "core/fields.hpp"
#include "core/region.hpp"

namespace greenwater {

template <class Field>
class Exchange {
 public:
  Exchange() = default;
  /// Sizes stay as they are.
  template <class... Sizes>
  explicit Exchange(const std::string& label, Sizes... sizes)
      : device(label, sizes...), host(Kokkos::create_mirror(device)) {}

  /// Host to device. A row of the time table counts the crossings.
  void push() {
    Region region("exchange");
    Kokkos::deep_copy(device, host);
  }
  /// Device to host.
  void pull() {
    Region region("exchange");
    Kokkos::deep_copy(host, device);
  }

  Field device;
  typename Field::host_mirror_type host;
};

}  // namespace greenwater
