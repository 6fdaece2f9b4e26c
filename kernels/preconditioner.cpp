#include "kernels/preconditioner.hpp"

namespace greenwater {
namespace {

accum copy(const ScalarField& r, const ScalarField& z, int count) {
  accum rz = 0;
  Kokkos::parallel_reduce(
      "greenwater::precondition_none", Range(0, count),
      KOKKOS_LAMBDA(const int i, accum& sum) {
        z(i) = r(i);
        sum += accum(r(i)) * z(i);
      },
      rz);
  return rz;
}

accum divide(const ScalarField& r, const ScalarField& diagonal, const ScalarField& z, int count) {
  accum rz = 0;
  Kokkos::parallel_reduce(
      "greenwater::precondition_jacobi", Range(0, count),
      KOKKOS_LAMBDA(const int i, accum& sum) {
        z(i) = r(i) / diagonal(i);
        sum += accum(r(i)) * z(i);
      },
      rz);
  return rz;
}

class Identity : public Preconditioner {
 public:
  void update(const PressureSystem& system) override { count_ = system.count(); }
  accum apply(const ScalarField& r, const ScalarField& z) const override { return copy(r, z, count_); }

 private:
  int count_ = 0;
};

class Jacobi : public Preconditioner {
 public:
  void update(const PressureSystem& system) override {
    count_ = system.count();
    diagonal_ = system.diagonal();
  }
  accum apply(const ScalarField& r, const ScalarField& z) const override { return divide(r, diagonal_, z, count_); }

 private:
  int count_ = 0;
  ScalarField diagonal_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_identity() { return std::make_unique<Identity>(); }
std::unique_ptr<Preconditioner> make_jacobi() { return std::make_unique<Jacobi>(); }

}  // namespace greenwater
