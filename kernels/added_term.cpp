#include "kernels/added_term.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace greenwater {
namespace {

template <class Field, class T>
void upload(Field& to, const std::string& label, const std::vector<T>& from) {
  if (to.extent(0) < from.size()) to = uncleared<Field>(label, from.size() + from.size() / 4);
  if (from.empty()) return;
  Kokkos::deep_copy(Kokkos::subview(to, std::pair<std::size_t, std::size_t>(0, from.size())),
                    Kokkos::View<const T*, Kokkos::HostSpace>(from.data(), from.size()));
}

// felt = D^T p
void feel(const AddedLists& D, const ScalarField& p, const ScalarField& felt, int unknowns) {
  const AddedLists lists = D;
  Kokkos::parallel_for(
      "greenwater::added_feel", Range(0, unknowns), KOKKOS_LAMBDA(const int u) {
        accum sum = 0;
        for (int e = lists.first(u); e < lists.first(u + 1); ++e) sum += lists.value(e) * p(lists.other(e));
        felt(u) = static_cast<real>(sum);
      });
}

// answer = C felt
void give_answer(const ScalarField& C, const ScalarField& felt, const ScalarField& answer, int unknowns) {
  Kokkos::parallel_for(
      "greenwater::added_answer", Range(0, unknowns), KOKKOS_LAMBDA(const int u) {
        accum sum = 0;
        for (int v = 0; v < unknowns; ++v) sum += C(u * unknowns + v) * felt(v);
        answer(u) = static_cast<real>(sum);
      });
}

// Ap = Ap + D answer where nothing is fixed
void bring_back(const AddedLists& D, const IndexField& particle, const ScalarField& answer, const FlagField& fixed,
                const ScalarField& Ap, int touched) {
  const AddedLists lists = D;
  Kokkos::parallel_for(
      "greenwater::added_product", Range(0, touched), KOKKOS_LAMBDA(const int row) {
        accum sum = 0;
        for (int e = lists.first(row); e < lists.first(row + 1); ++e) sum += lists.value(e) * answer(lists.other(e));
        const int i = particle(row);
        if (!fixed(i)) Ap(i) += static_cast<real>(sum);
      });
}

}  // namespace

void AddedTerm::set(int unknowns, std::vector<AddedEntry> D, const std::vector<real>& C) {
  expect(C.size() == static_cast<std::size_t>(unknowns) * unknowns);
  unknowns_ = unknowns;
  if (unknowns == 0) return;
  const auto lay_out = [&](AddedLists& lists, auto row_of, auto other_of, int rows) {
    std::vector<int> first(rows + 1, 0), other;
    std::vector<real> value;
    for (const AddedEntry& entry : D) {
      expect(row_of(entry) < rows);
      ++first[row_of(entry) + 1];
      other.push_back(other_of(entry));
      value.push_back(entry.value);
    }
    for (int row = 0; row < rows; ++row) first[row + 1] += first[row];
    upload(lists.first, "greenwater::added_first", first);
    upload(lists.other, "greenwater::added_other", other);
    upload(lists.value, "greenwater::added_value", value);
  };
  const auto unknown_of = [](const AddedEntry& e) { return e.unknown; };
  const auto particle_of = [](const AddedEntry& e) { return e.particle; };
  std::stable_sort(D.begin(), D.end(), [](const auto& a, const auto& b) { return a.unknown < b.unknown; });
  lay_out(of_unknown_, unknown_of, particle_of, unknowns);

  std::stable_sort(D.begin(), D.end(), [](const auto& a, const auto& b) { return a.particle < b.particle; });
  std::vector<int> particles;
  for (AddedEntry& entry : D) {
    if (particles.empty() || particles.back() != entry.particle) particles.push_back(entry.particle);
    entry.particle = static_cast<int>(particles.size()) - 1;
  }
  touched_ = static_cast<int>(particles.size());
  lay_out(of_particle_, particle_of, unknown_of, touched_);
  upload(particle_, "greenwater::added_particle", particles);
  upload(C_, "greenwater::added_answers", C);
  if (static_cast<int>(felt_.extent(0)) < unknowns) {
    felt_ = uncleared<ScalarField>("greenwater::added_felt", unknowns + unknowns / 4);
    answer_ = uncleared<ScalarField>("greenwater::added_answer", unknowns + unknowns / 4);
  }
}

void AddedTerm::add_product(const FlagField& fixed, const ScalarField& p, const ScalarField& Ap) const {
  if (!any()) return;
  feel(of_unknown_, p, felt_, unknowns_);
  give_answer(C_, felt_, answer_, unknowns_);
  bring_back(of_particle_, particle_, answer_, fixed, Ap, touched_);
}

}  // namespace greenwater
