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
      "greenwater::viscosity", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto ui = load_pack<Dim>(u, i);
        Vec<Dim, Pack> sum{};
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const auto uj = image.sticking_velocity(gather_pack<Dim>(u, j));
          sum = along(sum, image.share * w.in_float(dot(r, r)), difference(uj, ui));
        });
        store_pack(a, i, along(load_pack<Dim>(a, i), all_lanes<Pack>(factor), sum));
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
