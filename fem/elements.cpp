#include "fem/elements.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "fem/linear_element.hpp"
#include "fem/total_element.hpp"

namespace greenwater::element {
namespace {

/// Waking threads for fewer takes longer than they save.
[[maybe_unused]] constexpr int packs_for_threads = 256;

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
  using Eight = typename Formula::template Data<Octet>;
  static_assert(sizeof(Eight) == lanes * sizeof(One));

  PackedElements(const SolidMesh& mesh, const Formula& formula, double thickness)
      : formula_(formula), thickness_(thickness), slot_(mesh.elements.size()) {
    Shapes<dim> shapes;
    std::vector<std::pair<int, int>> order;  // shape, element
    for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
      order.emplace_back(shapes.find(geometry_of<dim>(mesh, e, thickness)), e);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); i += lanes) {
      add_pack(mesh, &order[i], static_cast<int>(std::min<std::size_t>(lanes, order.size() - i)));
    }
    forces_.resize(packs_.size());
  }

  int place_of(int element, int node) const override {
    return (slot_[element] / lanes * unknowns + dim * node) * lanes + slot_[element] % lanes;
  }

  const double* forces(const double* u) override {
    const int count = static_cast<int>(packs_.size());
#ifdef _OPENMP
#pragma omp parallel for schedule(static) if (count >= packs_for_threads)
#endif
    for (int p = 0; p < count; ++p) {
      const Pack& pack = packs_[p];
      Local local;
      gather(pack, u, local);
      if (pack.shared)
        formula_.force(ones_[pack.data], local.x, forces_[p].x);
      else
        formula_.force(eights_[pack.data], local.x, forces_[p].x);
    }
    return &forces_[0].x[0][0][0];
  }

  double energy(const double* u) const override {
    double sum = 0;
    for (const Pack& pack : packs_) {
      Local local;
      gather(pack, u, local);
      const Octet w =
          pack.shared ? formula_.energy(ones_[pack.data], local.x) : formula_.energy(eights_[pack.data], local.x);
      for (int l = 0; l < pack.count; ++l) sum += w[l];
    }
    return sum;
  }

  void tangent(const SolidMesh& mesh, int element, const double* u, double* k) const override {
    const One data = formula_.make(geometry_of<dim>(mesh, element, thickness_));
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

  Stress stress(const SolidMesh& mesh, int element, const double* u) const override {
    double local[nodes][dim];
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < dim; ++d) local[a][d] = u[dim * mesh.elements[element][a] + d];
    return formula_.stress(geometry_of<dim>(mesh, element, thickness_), local);
  }

 private:
  struct Pack {
    bool shared = true;            // all of one shape
    int data = 0;                  // in ones_ or eights_
    int count = 0;                 // lanes that have an element; the others repeat the last
    int first[nodes][lanes] = {};  // unknown of the nodes
  };

  struct Local {
    Octet x[nodes][dim];  // displacements, or forces
  };

  void add_pack(const SolidMesh& mesh, const std::pair<int, int>* members, int count) {
    Pack pack;
    pack.count = count;
    pack.shared = members[0].first == members[count - 1].first;
    for (int l = 0; l < lanes; ++l) {
      const int element = members[std::min(l, count - 1)].second;
      if (l < count) slot_[element] = static_cast<int>(packs_.size()) * lanes + l;
      for (int a = 0; a < nodes; ++a) pack.first[a][l] = dim * mesh.elements[element][a];
    }
    if (pack.shared) {
      if (members[0].first != last_shape_) ones_.push_back(data_of(mesh, members[0].second));
      last_shape_ = members[0].first;
      pack.data = static_cast<int>(ones_.size()) - 1;
    } else {
      pack.data = static_cast<int>(eights_.size());
      eights_.emplace_back();
      for (int l = 0; l < lanes; ++l)
        put_lane(eights_.back(), l, data_of(mesh, members[std::min(l, count - 1)].second));
    }
    packs_.push_back(pack);
  }

  One data_of(const SolidMesh& mesh, int element) const {
    return formula_.make(geometry_of<dim>(mesh, element, thickness_));
  }

  static void put_lane(Eight& all, int lane, const One& one) {
    const auto* from = reinterpret_cast<const char*>(&one);
    auto* to = reinterpret_cast<char*>(&all) + lane * sizeof(double);
    for (std::size_t i = 0; i < sizeof(One); i += sizeof(double)) std::memcpy(to + lanes * i, from + i, sizeof(double));
  }

  static void gather(const Pack& pack, const double* u, Local& local) {
    for (int a = 0; a < nodes; ++a) {
      const int* at = pack.first[a];
      for (int d = 0; d < dim; ++d) {
        const double* from = u + d;
        // Not lane by lane, as a register that is written in parts is read late.
        local.x[a][d] = Octet{from[at[0]], from[at[1]], from[at[2]], from[at[3]],
                              from[at[4]], from[at[5]], from[at[6]], from[at[7]]};
      }
    }
  }

  Formula formula_;
  double thickness_;
  std::vector<int> slot_;  // of an element: pack times lanes plus lane
  std::vector<Pack> packs_;
  std::vector<One> ones_;
  std::vector<Eight> eights_;
  std::vector<Local> forces_;  // of the packs
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
