#pragma once
// How fluid and structures march together.

namespace greenwater {

enum class CouplingWay {
  joint,      // the structures' answer to the pressure is part of the pressure solve
  aitken,     // repeated until walls and loads agree, with Aitken's relaxation
  staggered,  // the paper's section 2.3: structure, walls, fluid, load, each once
};

enum class LoadReading {
  transpose,       // of what the wall does to the divergence: exact in work (kernels/operators/swept_volume.hpp)
  least_squares,   // pressure at the wall, fitted with the wall's condition (Reading::neumann)
  kernel_average,  // the paper's weighted mean of the particles in sight (Reading::average)
};

struct CouplingOptions {
  CouplingWay way = CouplingWay::joint;
  LoadReading load = LoadReading::transpose;
  // Whether the pressure's gradient at a wall knows the wall's acceleration. In the joint solve it belongs there; taken from
  // the step before, in a scheme whose pressure comes from densities, it is added mass that nobody balances.
  bool walls_accelerate = true;
  double tolerance = 5e-3;  // of the wall's largest speed: walls as the fluid saw them against structures as they went
  int most_passes = 50;     // of the structures in one fluid step
  double first_relaxation = 0.1;  // of Aitken's, in the first step
};

}  // namespace greenwater
