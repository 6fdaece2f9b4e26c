#include "kernels/weight.hpp"

#include <cmath>

namespace greenwater {

Reference lattice_reference(const Weight& weight, int dim, coord spacing) {
  const int reach = static_cast<int>(std::ceil(weight.radius / spacing));
  const int reach_z = dim == 3 ? reach : 0;
  accum n = 0, n_r2 = 0;
  for (int kz = -reach_z; kz <= reach_z; ++kz)
    for (int ky = -reach; ky <= reach; ++ky)
      for (int kx = -reach; kx <= reach; ++kx) {
        if (kx == 0 && ky == 0 && kz == 0) continue;
        const accum r = spacing * std::sqrt(static_cast<accum>(kx * kx + ky * ky + kz * kz));
        const accum w = weight(static_cast<real>(r));
        n += w;
        n_r2 += w * r * r;
      }
  return {static_cast<real>(n), static_cast<real>(n_r2 / n)};
}

}  // namespace greenwater
