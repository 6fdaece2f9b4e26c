// What each kernel of the classic step costs, over sizes: a column of water in a tank, half collapsed by its own weight.
// Prints one JSON object: origin, then for each size the median time of every part.
//
//   kernels [spacing in mm ...]        default: 8 4 2 (1,250 to 20,000 particles); 1 is the paper's 80,000
//
// Kept and recomputed weights are timed in turn, so that their ratio holds where the machine's speed drifts.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <vector>

#include "core/build_facts.hpp"
#include "kernels/conjugate_gradient.hpp"
#include "kernels/density.hpp"
#include "kernels/motion.hpp"

using namespace greenwater;

namespace {

constexpr int rounds = 15;

WallFaces tank() {
  WallFaces walls;
  walls.bodies = {{"tank"}, {"plate"}};
  const auto add = [&](coord x0, coord y0, coord x1, coord y1, int body) {
    WallFace face;
    face.corner[0].position = {x0, y0, 0};
    face.corner[1].position = {x1, y1, 0};
    face.body = body;
    walls.faces.push_back(face);
  };
  add(0, 0, 0.8, 0, 0);
  add(0, 0, 0, 0.6, 0);
  add(0.8, 0, 0.8, 0.6, 0);
  add(0.6, 0, 0.6, 0.1, 1);
  return walls;
}

Fluid column(coord l0) {
  const int nx = static_cast<int>(0.2 / l0 + 0.5), ny = 2 * nx;
  Fluid fluid;
  fluid.spacing = l0;
  fluid.gravity[1] = real(-9.81);
  const Weight weight{static_cast<real>(3.1 * l0), real(0.05)};
  fluid.density = {weight, lattice_reference(weight, 2, l0)};
  fluid.gradient = fluid.laplacian = fluid.density;
  fluid.grid = CellGrid(make_grid(2, {-0.1, -0.1, 0}, {0.9, 0.9, 0}, weight.radius));
  fluid.faces = tank();
  make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), l0);
  fluid.particles = make_particles(2, nx * ny);
  const auto x = Kokkos::create_mirror(fluid.particles.position);
  std::srand(1);
  const auto shake = [&] { return 0.1 * l0 * (2.0 * std::rand() / RAND_MAX - 1); };  // as disordered as water in motion
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      x(j * nx + i, 0) = (i + 0.5) * l0 + shake();
      x(j * nx + i, 1) = (j + 0.5) * l0 + shake();
    }
  Kokkos::deep_copy(fluid.particles.position, x);
  return fluid;
}

struct Part {
  std::string name;
  std::function<void()> run;
};

// Median of each part [ms]; the parts take turns.
std::map<std::string, double> time_in_turn(const std::vector<Part>& parts) {
  std::map<std::string, std::vector<double>> times;
  for (int round = 0; round < rounds; ++round)
    for (const Part& part : parts) {
      Kokkos::fence();
      const auto start = std::chrono::steady_clock::now();
      part.run();
      Kokkos::fence();
      times[part.name].push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
  std::map<std::string, double> medians;
  for (auto& [name, all] : times) {
    std::nth_element(all.begin(), all.begin() + rounds / 2, all.end());
    medians[name] = all[rounds / 2];
  }
  return medians;
}

void bench(coord l0, bool first) {
  const real dt = static_cast<real>(0.115 * l0);
  Fluid fluid = column(l0);
  fluid.grid.sort(fluid.particles);
  fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
  mark_surface(fluid, real(0.97));
  PressureOptions options;
  options.diagonal_factor = real(1.05);
  PressureSystem kept(options), recomputed(options);
  Fluid lean = fluid;  // the same fields; only the operator asks for the weights
  lean.keep_weights = false;
  kept.assemble(fluid, dt);
  recomputed.assemble(lean, dt);
  const auto jacobi = make_jacobi();
  jacobi->update(kept);
  ConjugateGradient cg({.tolerance = real(1e-6)});
  const ScalarField p = fluid.particles.pressure, Ap("greenwater::bench_product", p.extent(0));
  SolveReport report;
  const auto medians = time_in_turn({
      {"sort", [&] { fluid.grid.sort(fluid.particles); }},
      {"rows", [&] { fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid)); }},
      {"assemble", [&] { kept.assemble(fluid, dt); }},
      {"apply_kept", [&] { kept.apply(p, Ap); }},
      {"apply_recomputed", [&] { recomputed.apply(p, Ap); }},
      {"solve_from_zero",
       [&] {
         Kokkos::deep_copy(p, real(0));
         report = cg.solve(kept, *jacobi, p);
       }},
      {"gradient", [&] { pressure_gradient(fluid); }},
  });
  std::cout << (first ? "" : ",") << "\n  {\"particles\": " << fluid.particles.count
            << ", \"entries\": " << fluid.rows.near.entries << ", \"image_entries\": " << fluid.rows.images.entries
            << ", \"iterations\": " << report.iterations;
  for (const auto& [name, ms] : medians) std::cout << ", \"" << name << "_ms\": " << ms;
  std::cout << ", \"recomputed_over_kept\": " << medians.at("apply_recomputed") / medians.at("apply_kept") << "}";
}

}  // namespace

int main(int argc, char** argv) {
  // Cores that are ours alone may spin; the environment says so, and the output what it said.
  const char* policy = std::getenv("OMP_WAIT_POLICY");
  Runtime runtime(0);
  const BuildFacts& build = build_facts();
  std::cout << "{\"git\": \"" << build.git << "\", \"kokkos\": \"" << build.kokkos_version << "\", \"flags\": \""
            << build.flags << "\", \"space\": \"" << Runtime::space_name()
            << "\", \"threads\": " << Runtime::concurrency() << ", \"OMP_WAIT_POLICY\": \""
            << (policy ? policy : "unset") << "\", \"sizes\": [";
  std::vector<double> spacings;
  for (int k = 1; k < argc; ++k) spacings.push_back(std::atof(argv[k]) / 1000);
  if (spacings.empty()) spacings = {0.008, 0.004, 0.002};
  for (std::size_t k = 0; k < spacings.size(); ++k) bench(spacings[k], k == 0);
  std::cout << "\n]}\n";
}
