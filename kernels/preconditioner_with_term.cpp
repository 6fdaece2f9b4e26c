#include "kernels/preconditioner_with_term.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace greenwater {
namespace {

using Directions = Eigen::Matrix<real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void upload(const ScalarField& to, const Directions& from) {
  Kokkos::deep_copy(to, Kokkos::View<const real*, Kokkos::HostSpace>(from.data(), from.size()));
}

// Of what the unknowns feel: wanted(k) = G_k . felt; returns the sum of wanted(k) (leading_k . felt).
accum project(const ScalarField& G, const ScalarField& leading, const ScalarField& felt, int unknowns, int directions,
              const ScalarField& wanted) {
  accum energy = 0;
  Kokkos::parallel_reduce(
      "greenwater::added_project", Range(0, directions),
      KOKKOS_LAMBDA(const int k, accum& sum) {
        accum share = 0, own = 0;
        for (int u = 0; u < unknowns; ++u) {
          share += G(k * unknowns + u) * felt(u);
          own += leading(k * unknowns + u) * felt(u);
        }
        wanted(k) = static_cast<real>(share);
        sum += share * own;
      },
      energy);
  return energy;
}

// z -= Z wanted
void take_off(const ScalarField& Z, std::size_t room, const ScalarField& wanted, int directions, const ScalarField& z,
              int count) {
  Kokkos::parallel_for(
      "greenwater::added_take_off", Range(0, count), KOKKOS_LAMBDA(const int i) {
        accum sum = 0;
        for (int k = 0; k < directions; ++k) sum += Z(k * room + i) * wanted(k);
        z(i) -= static_cast<real>(sum);
      });
}

class WithTerm : public Preconditioner {
 public:
  explicit WithTerm(std::unique_ptr<Preconditioner> inner) : inner_(std::move(inner)) {}

  void update(const PressureSystem& system) override {
    inner_->update(system);
    count_ = system.count();
    term_ = system.added();
    directions_ = 0;
    if (!term_ || !term_->acts() || term_->leading().empty()) return;
    unknowns_ = term_->unknowns();
    directions_ = static_cast<int>(term_->leading().size()) / unknowns_;
    make_room(system.rhs().extent(0));
    make_directions(system.fixed());
  }

  accum apply(const ScalarField& r, const ScalarField& z) const override {
    const accum rz = inner_->apply(r, z);
    if (directions_ == 0) return rz;
    term_->feel(z, felt_);
    const accum less = project(G_, leading_, felt_, unknowns_, directions_, wanted_);
    take_off(Z_, room_, wanted_, directions_, z, count_);
    return rz - less;
  }

 private:
  void make_room(std::size_t particles) {
    if (room_ < particles || Z_.extent(0) < directions_ * room_) {
      room_ = std::max(room_, particles);
      Z_ = uncleared<ScalarField>("greenwater::added_directions", directions_ * room_);
      w_ = uncleared<ScalarField>("greenwater::added_direction", room_);
    }
    if (felt_.extent(0) == static_cast<std::size_t>(unknowns_) &&
        wanted_.extent(0) == static_cast<std::size_t>(directions_))
      return;
    felt_ = uncleared<ScalarField>("greenwater::added_felt_again", unknowns_);
    wanted_ = uncleared<ScalarField>("greenwater::added_wanted", directions_);
    leading_ = uncleared<ScalarField>("greenwater::added_leading", unknowns_ * directions_);
    G_ = uncleared<ScalarField>("greenwater::added_shares", unknowns_ * directions_);
  }

  // Z = M W and G = S^-1 leading.
  void make_directions(const FlagField& fixed) {
    const Directions leading = Eigen::Map<const Directions>(term_->leading().data(), directions_, unknowns_);
    upload(leading_, leading);
    Directions felt(unknowns_, directions_);  // D^T Z
    for (int k = 0; k < directions_; ++k) {
      const ScalarField Z = part(Z_, k, room_);
      Kokkos::deep_copy(w_, real(0));
      term_->add_source(fixed, 1, part(leading_, k, unknowns_), w_);
      inner_->apply(w_, Z);
      term_->feel(Z, felt_);
      const auto heard = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), felt_);
      for (int u = 0; u < unknowns_; ++u) felt(u, k) = heard(u);
    }
    const Directions S = Directions::Identity(directions_, directions_) + leading * felt;
    upload(G_, S.ldlt().solve(leading));
  }

  static ScalarField part(const ScalarField& of, std::size_t k, std::size_t size) {
    return Kokkos::subview(of, std::pair<std::size_t, std::size_t>(k * size, (k + 1) * size));
  }

  std::unique_ptr<Preconditioner> inner_;
  const AddedTerm* term_ = nullptr;
  int count_ = 0, unknowns_ = 0, directions_ = 0;
  std::size_t room_ = 0;  // of a direction
  ScalarField Z_;         // (direction, i)
  ScalarField w_;         // (i) a column of W
  ScalarField leading_;   // (direction, unknown)
  ScalarField G_;         // (direction, unknown)
  ScalarField felt_, wanted_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_preconditioner_with_term(std::unique_ptr<Preconditioner> inner) {
  return std::make_unique<WithTerm>(std::move(inner));
}

}  // namespace greenwater
