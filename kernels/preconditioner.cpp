#include "kernels/preconditioner.hpp"

namespace greenwater {
namespace {

void copy(const ScalarField& r, const ScalarField& z, int count) {
  Kokkos::parallel_for(
      "greenwater::precondition_none", Range(0, count), KOKKOS_LAMBDA(const int i) { z(i) = r(i); });
}

void divide(const ScalarField& r, const ScalarField& diagonal, const ScalarField& z, int count) {
  Kokkos::parallel_for(
      "greenwater::precondition_jacobi", Range(0, count), KOKKOS_LAMBDA(const int i) { z(i) = r(i) / diagonal(i); });
}

class Identity : public Preconditioner {
 public:
  void update(const PressureSystem& system) override { count_ = system.count(); }
  void apply(const ScalarField& r, const ScalarField& z) const override { copy(r, z, count_); }

 private:
  int count_ = 0;
};

class Jacobi : public Preconditioner {
 public:
  void update(const PressureSystem& system) override {
    count_ = system.count();
    diagonal_ = system.diagonal();
  }
  void apply(const ScalarField& r, const ScalarField& z) const override { divide(r, diagonal_, z, count_); }

 private:
  int count_ = 0;
  ScalarField diagonal_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_identity() { return std::make_unique<Identity>(); }
std::unique_ptr<Preconditioner> make_jacobi() { return std::make_unique<Jacobi>(); }

}  // namespace greenwater
