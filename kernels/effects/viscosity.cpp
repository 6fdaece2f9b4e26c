#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

template <int Dim>
void viscosity_in(const Fluid& fluid, real nu, const VectorField& a) {
  const auto near = around<Dim>(fluid);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const auto w = fluid.laplacian.weight;
  const real factor = nu * 2 * Dim / (fluid.laplacian.reference.lambda * fluid.laplacian.reference.n0);
  Kokkos::parallel_for(
      "greenwater::viscosity", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        const auto ui = load<Dim>(u, i);
        Vec<Dim> sum{};
        near.for_each(i, [&](const int j, const Vec<Dim>& r, const Image<Dim>& image) {
          const auto uj = image ? image.sticking_velocity(load<Dim>(u, j)) : load<Dim>(u, j);
          const real weight = image.share * w(sqrt(dot(r, r)));
          for (int d = 0; d < Dim; ++d) sum[d] += (uj[d] - ui[d]) * weight;
        });
        for (int d = 0; d < Dim; ++d) a(i, d) += factor * sum[d];
      });
}

class Viscosity : public Effect {
 public:
  explicit Viscosity(real kinematic) : nu_(kinematic) {}
  std::string_view name() const override { return "viscosity"; }
  Stage stage() const override { return Stage::force; }
  void apply(Fluid& fluid, real) override {
    const VectorField a = fluid.particles.acceleration;
    fluid.particles.dim == 2 ? viscosity_in<2>(fluid, nu_, a) : viscosity_in<3>(fluid, nu_, a);
  }

 private:
  real nu_;
};

}  // namespace

std::unique_ptr<Effect> make_viscosity(real kinematic) { return std::make_unique<Viscosity>(kinematic); }

}  // namespace greenwater
