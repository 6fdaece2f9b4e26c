#include "fem/elements.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "fem/linear_element.hpp"
#include "fem/total_element.hpp"

namespace greenwater::element {
namespace {

/// Waking threads for fewer takes longer than they save.
[[maybe_unused]] constexpr int groups_for_threads = 256;

/// Tells which elements are equal up to a translation, within round-off of coordinates. Looks back at a few shapes only,
/// which is enough for structured meshes and costs nothing for others.
template <int Dim>
class Shapes {
 public:
  /// The shape of this element; a new one gets the next number.
  int find(const Geometry<Dim>& g) {
    for (int s = count_ - 1; s >= std::max(0, count_ - kept); --s) {
      if (equal(recent_[s % kept], g)) return s;
    }
    recent_[count_ % kept] = g;
    return count_++;
  }

 private:
  static constexpr int kept = 16;

  static bool equal(const Geometry<Dim>& a, const Geometry<Dim>& b) {
    double size = 0;
    for (const auto& x : a.place)
      for (const double v : x) size = std::max(size, std::abs(v));
    for (int n = 0; n < a.nodes; ++n)
      for (int d = 0; d < Dim; ++d)
        if (std::abs(a.place[n][d] - b.place[n][d]) > 1e-11 * size) return false;
    return true;
  }

  int count_ = 0;
  Geometry<Dim> recent_[kept];
};

template <class Formula>
class PackedElements : public Elements {
 public:
  static constexpr int dim = Formula::dim;
  static constexpr int nodes = Formula::nodes;
  static constexpr int unknowns = dim * nodes;
  using One = typename Formula::template Data<double>;
  using Several = typename Formula::template Data<Pack>;
  static_assert(sizeof(Several) == lanes * sizeof(One));

  PackedElements(const SolidMesh& mesh, const Formula& formula, double thickness)
      : formula_(formula), thickness_(thickness), slot_(mesh.elements.size()) {
    Shapes<dim> shapes;
    std::vector<std::pair<int, int>> order;  // shape, element
    for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
      order.emplace_back(shapes.find(geometry_of<dim>(mesh, e, thickness)), e);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); i += lanes) {
      add_group(mesh, &order[i], static_cast<int>(std::min<std::size_t>(lanes, order.size() - i)));
    }
    forces_.resize(groups_.size());
  }

  int place_of(int element, int node) const override {
    return (slot_[element] / lanes * unknowns + dim * node) * lanes + slot_[element] % lanes;
  }

  const double* forces(const double* u) override {
    const int count = static_cast<int>(groups_.size());
#ifdef _OPENMP
#pragma omp parallel for schedule(static) if (count >= groups_for_threads)
#endif
    for (int p = 0; p < count; ++p) {
      const Group& group = groups_[p];
      Local local;
      gather(group, u, local);
      if (group.shared)
        formula_.force(ones_[group.data], local.x, forces_[p].x);
      else
        formula_.force(several_[group.data], local.x, forces_[p].x);
    }
    return &forces_[0].x[0][0][0];
  }

  double energy(const double* u) const override {
    double sum = 0;
    for (const Group& group : groups_) {
      Local local;
      gather(group, u, local);
      const Pack w =
          group.shared ? formula_.energy(ones_[group.data], local.x) : formula_.energy(several_[group.data], local.x);
      for (int l = 0; l < group.count; ++l) sum += w[l];
    }
    return sum;
  }

  void tangent(const SolidMesh& mesh, int element, const double* u, double* k) const override {
    const One data = stored(element);
    for (int first = 0; first < unknowns; first += lanes) {
      Slope local[nodes][dim], f[nodes][dim];
      for (int i = 0; i < unknowns; ++i) {
        Slope& x = local[i / dim][i % dim];
        x.value = u[dim * mesh.elements[element][i / dim] + i % dim];
        if (i >= first && i < first + lanes) x.slope[i - first] = 1;
      }
      formula_.force(data, local, f);
      for (int i = 0; i < unknowns; ++i)
        for (int l = 0; l < lanes; ++l) k[unknowns * i + first + l] = f[i / dim][i % dim].slope[l];
    }
  }

  Stress stress(const SolidMesh& mesh, int element, const double* u, const std::array<double, 3>& xi) const override {
    double local[nodes][dim];
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < dim; ++d) local[a][d] = u[dim * mesh.elements[element][a] + d];
    return formula_.stress(geometry_of<dim>(mesh, element, thickness_), local, xi);
  }

 private:
  struct Group {
    bool shared = true;            // all of one shape
    int data = 0;                  // in ones_ or several_
    int count = 0;                 // lanes that have an element; the others repeat the last
    int first[nodes][lanes] = {};  // unknown of the nodes
  };

  struct Local {
    Pack x[nodes][dim];  // displacements, or forces
  };

  void add_group(const SolidMesh& mesh, const std::pair<int, int>* members, int count) {
    Group group;
    group.count = count;
    group.shared = members[0].first == members[count - 1].first;
    for (int l = 0; l < lanes; ++l) {
      const int element = members[std::min(l, count - 1)].second;
      if (l < count) slot_[element] = static_cast<int>(groups_.size()) * lanes + l;
      for (int a = 0; a < nodes; ++a) group.first[a][l] = dim * mesh.elements[element][a];
    }
    if (group.shared) {
      if (members[0].first != last_shape_) ones_.push_back(data_of(mesh, members[0].second));
      last_shape_ = members[0].first;
      group.data = static_cast<int>(ones_.size()) - 1;
    } else {
      group.data = static_cast<int>(several_.size());
      several_.emplace_back();
      for (int l = 0; l < lanes; ++l)
        put_lane(several_.back(), l, data_of(mesh, members[std::min(l, count - 1)].second));
    }
    groups_.push_back(group);
  }

  One data_of(const SolidMesh& mesh, int element) const {
    return formula_.make(geometry_of<dim>(mesh, element, thickness_));
  }

  static void put_lane(Several& all, int lane, const One& one) {
    const auto* from = reinterpret_cast<const char*>(&one);
    auto* to = reinterpret_cast<char*>(&all) + lane * sizeof(double);
    for (std::size_t i = 0; i < sizeof(One); i += sizeof(double)) std::memcpy(to + lanes * i, from + i, sizeof(double));
  }

  One stored(int element) const {
    const Group& group = groups_[slot_[element] / lanes];
    if (group.shared) return ones_[group.data];
    One one;
    auto* to = reinterpret_cast<char*>(&one);
    const auto* from = reinterpret_cast<const char*>(&several_[group.data]) + slot_[element] % lanes * sizeof(double);
    for (std::size_t i = 0; i < sizeof(One); i += sizeof(double)) std::memcpy(to + i, from + lanes * i, sizeof(double));
    return one;
  }

  static void gather(const Group& group, const double* u, Local& local) {
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < dim; ++d) local.x[a][d] = gather(u + d, group.first[a], std::make_index_sequence<lanes>());
  }

  /// Not lane by lane, as a register that is written in parts is read late.
  template <std::size_t... L>
  static Pack gather(const double* from, const int* at, std::index_sequence<L...>) {
    return Pack{from[at[L]]...};
  }

  Formula formula_;
  double thickness_;
  std::vector<int> slot_;  // of an element: group times lanes plus lane
  std::vector<Group> groups_;
  std::vector<One> ones_;
  std::vector<Several> several_;
  std::vector<Local> forces_;  // of the groups
  int last_shape_ = -1;
};

template <int Dim>
std::unique_ptr<Elements> make_in(const SolidMesh& mesh, const Rules& rules, Kinematics kinematics, double thickness) {
  if (kinematics == Kinematics::small) {
    return std::make_unique<PackedElements<LinearElement<Dim, false>>>(mesh, LinearElement<Dim, false>{rules},
                                                                       thickness);
  }
  if (kinematics == Kinematics::corotational) {
    return std::make_unique<PackedElements<LinearElement<Dim, true>>>(mesh, LinearElement<Dim, true>{rules}, thickness);
  }
  return std::make_unique<PackedElements<TotalElement<Dim>>>(mesh, TotalElement<Dim>{rules}, thickness);
}

}  // namespace

std::unique_ptr<Elements> make_elements(const SolidMesh& mesh, const Rules& rules, Kinematics kinematics,
                                        double thickness) {
  return mesh.dim == 2 ? make_in<2>(mesh, rules, kinematics, thickness)
                       : make_in<3>(mesh, rules, kinematics, thickness);
}

}  // namespace greenwater::element
