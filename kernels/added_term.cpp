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

// D sorted by what row_of() gives, which is below `rows`; entries of a row stay in their order.
template <class RowOf, class OtherOf>
void lay_out(AddedLists& lists, const std::vector<AddedEntry>& D, int rows, RowOf row_of, OtherOf other_of) {
  std::vector<int> first(rows + 1, 0), other(D.size());
  std::vector<real> value(D.size());
  for (const AddedEntry& entry : D) {
    expect(row_of(entry) < rows);
    ++first[row_of(entry) + 1];
  }
  for (int row = 0; row < rows; ++row) first[row + 1] += first[row];
  std::vector<int> next(first.begin(), first.end() - 1);
  for (const AddedEntry& entry : D) {
    const int place = next[row_of(entry)]++;
    other[place] = other_of(entry);
    value[place] = entry.value;
  }
  upload(lists.first, "greenwater::added_first", first);
  upload(lists.other, "greenwater::added_other", other);
  upload(lists.value, "greenwater::added_value", value);
}

// answer = C felt; returns felt . answer.
accum give_answer(const ScalarField& C, const ScalarField& felt, const ScalarField& answer, int unknowns) {
  accum energy = 0;
  Kokkos::parallel_reduce(
      "greenwater::added_answer", Range(0, unknowns),
      KOKKOS_LAMBDA(const int u, accum& energy_of_all) {
        accum sum = 0;
        for (int v = 0; v < unknowns; ++v) sum += C(u * unknowns + v) * felt(v);
        answer(u) = static_cast<real>(sum);
        energy_of_all += felt(u) * sum;
      },
      energy);
  return energy;
}

// to += factor D v where nothing is fixed
void bring_back(const AddedLists& D, const IndexField& particle, real factor, const ScalarField& v,
                const FlagField& fixed, const ScalarField& to, int touched) {
  const AddedLists lists = D;
  Kokkos::parallel_for(
      "greenwater::added_product", Range(0, touched), KOKKOS_LAMBDA(const int row) {
        accum sum = 0;
        for (int e = lists.first(row); e < lists.first(row + 1); ++e) sum += lists.value(e) * v(lists.other(e));
        const int i = particle(row);
        if (!fixed(i)) to(i) += factor * static_cast<real>(sum);
      });
}

}  // namespace

void AddedTerm::set_rows(int unknowns, const std::vector<AddedEntry>& D) {
  unknowns_ = unknowns;
  touched_ = 0;
  if (unknowns == 0) return;
  lay_out(
      of_unknown_, D, unknowns, [](const auto& e) { return e.unknown; }, [](const auto& e) { return e.particle; });
  std::vector<int> particles;
  for (const AddedEntry& entry : D) particles.push_back(entry.particle);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  touched_ = static_cast<int>(particles.size());
  const auto row_of = [&](const AddedEntry& entry) {
    return static_cast<int>(std::lower_bound(particles.begin(), particles.end(), entry.particle) - particles.begin());
  };
  lay_out(of_particle_, D, touched_, row_of, [](const auto& e) { return e.unknown; });
  upload(particle_, "greenwater::added_particle", particles);
}

void AddedTerm::set_answer(const std::vector<real>& C, const std::vector<real>& leading) {
  expect(C.size() == static_cast<std::size_t>(unknowns_) * unknowns_);
  expect(unknowns_ == 0 || leading.size() % unknowns_ == 0);
  leading_ = leading;
  upload(C_, "greenwater::added_answers", C);
  if (static_cast<int>(felt_.extent(0)) >= unknowns_) return;
  felt_ = uncleared<ScalarField>("greenwater::added_felt", unknowns_ + unknowns_ / 4);
  answer_ = uncleared<ScalarField>("greenwater::added_answer", unknowns_ + unknowns_ / 4);
}

void AddedTerm::feel(const ScalarField& p, const ScalarField& felt) const {
  const AddedLists lists = of_unknown_;
  Kokkos::parallel_for(
      "greenwater::added_feel", Range(0, unknowns_), KOKKOS_LAMBDA(const int u) {
        accum sum = 0;
        for (int e = lists.first(u); e < lists.first(u + 1); ++e) sum += lists.value(e) * p(lists.other(e));
        felt(u) = static_cast<real>(sum);
      });
}

void AddedTerm::add_source(const FlagField& fixed, real factor, const ScalarField& v, const ScalarField& b) const {
  bring_back(of_particle_, particle_, factor, v, fixed, b, touched_);
}

accum AddedTerm::add_product(const FlagField& fixed, const ScalarField& p, const ScalarField& Ap) const {
  if (touched_ == 0) return 0;
  feel(p, felt_);
  const accum energy = give_answer(C_, felt_, answer_, unknowns_);
  bring_back(of_particle_, particle_, 1, answer_, fixed, Ap, touched_);
  return energy;
}

}  // namespace greenwater
