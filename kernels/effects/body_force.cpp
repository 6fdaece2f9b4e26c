#include <utility>

#include "core/check.hpp"
#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

template <int Dim>
void add_in(const VectorField& force, const VectorField& a, int count) {
  Kokkos::parallel_for(
      "greenwater::body_force", Range(0, count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) a(i, d) += force(i, d);
      });
}

class BodyForce : public Effect {
 public:
  explicit BodyForce(ForceField force) : force_(std::move(force)) {}
  std::string_view name() const override { return "body_force"; }
  Stage stage() const override { return Stage::force; }

  void prepare(Fluid& fluid) override {
    Particles& p = fluid.particles;
    if (fluid.body_force < 0) fluid.body_force = add_extra(p, "body_force", "m/s^2");
    x_ = Kokkos::create_mirror(p.position);
    u_ = Kokkos::create_mirror(p.velocity);
    f_ = Kokkos::create_mirror(p.extras[fluid.body_force].values);
  }

  void apply(Fluid& fluid, real) override {
    Particles& p = fluid.particles;
    expect(fluid.body_force >= 0 && x_.extent(0) == p.position.extent(0));  // prepared
    const VectorField& values = p.extras[fluid.body_force].values;
    Kokkos::deep_copy(x_, p.position);
    Kokkos::deep_copy(u_, p.velocity);
    for (int i = 0; i < p.count; ++i) {
      std::array<double, 3> x{}, u{};
      for (int d = 0; d < p.dim; ++d) {
        x[d] = x_(i, d);
        u[d] = u_(i, d);
      }
      const auto f = force_(x, u, fluid.time);
      for (int d = 0; d < p.dim; ++d) f_(i, d) = static_cast<real>(f[d]);
    }
    Kokkos::deep_copy(values, f_);
    p.dim == 2 ? add_in<2>(values, p.acceleration, p.count) : add_in<3>(values, p.acceleration, p.count);
  }

 private:
  ForceField force_;
  CoordField::host_mirror_type x_;
  VectorField::host_mirror_type u_, f_;
};

}  // namespace

std::unique_ptr<Effect> make_body_force(ForceField force) { return std::make_unique<BodyForce>(std::move(force)); }

}  // namespace greenwater
