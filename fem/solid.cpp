#include "fem/solid.hpp"

#include "core/check.hpp"
#include "fem/elements.hpp"
#include "fem/geometry.hpp"

namespace greenwater {
namespace {

/// Waking threads for fewer takes longer than they save.
[[maybe_unused]] constexpr int nodes_for_threads = 4000;

void check(const SolidMesh& mesh, const Material& material, const SolidOptions& options) {
  check(material);
  require(!mesh.elements.empty(), "the mesh of the structure has no elements");
  require(mesh.dim == 3 || options.thickness > 0, "the thickness of the structure is ", options.thickness,
          " m; it has to be positive");
  require(material.law == Law::linear || options.kinematics == Kinematics::total_lagrangian,
          "neo-Hookean material needs total-Lagrangian kinematics: at small strain it is the linear law");
  const bool plane_stress = mesh.dim == 2 && options.plane == Plane::stress;
  require(!plane_stress || material.law == Law::linear,
          "neo-Hookean material is not available in plane stress: take plane strain, or hexahedra");
  require(!plane_stress || options.element != ElementKind::mean_dilatation,
          "plane stress leaves the thickness free, so nothing locks: take full or incompatible elements");
}

std::vector<char> used_nodes(const SolidMesh& mesh) {
  std::vector<char> used(mesh.nodes.size(), 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (int a = 0; a < mesh.nodes_per_element(); ++a) {
      const int node = mesh.elements[e][a];
      require(node >= 0 && node < static_cast<int>(mesh.nodes.size()), "solid element ", e + 1, " names node ",
              node + 1, ", but the mesh has ", mesh.nodes.size());
      used[node] = 1;
    }
  }
  return used;
}

template <int Dim>
void add_mass(const SolidMesh& mesh, double density, double thickness, Eigen::VectorXd& mass) {
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    const auto g = element::geometry_of<Dim>(mesh, e, thickness);
    for (int a = 0; a < g.nodes; ++a)
      for (int d = 0; d < Dim; ++d) mass[Dim * mesh.elements[e][a] + d] += density * g.share[a];
  }
}

/// f = the sum of the elements' parts at each node. Nodes gather, so that threads need not wait for each other.
template <int Dim>
void add_parts(const double* parts, const std::vector<int>& first, const std::vector<int>& part, double* f) {
  const int nodes = static_cast<int>(first.size()) - 1;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) if (nodes >= nodes_for_threads)
#endif
  for (int n = 0; n < nodes; ++n) {
    double sum[Dim] = {};
    for (int i = first[n]; i < first[n + 1]; ++i)
      for (int d = 0; d < Dim; ++d) sum[d] += parts[part[i] + d * element::lanes];
    for (int d = 0; d < Dim; ++d) f[Dim * n + d] = sum[d];
  }
}

}  // namespace

Solid::Solid(SolidMesh mesh, const Material& material, const SolidOptions& options)
    : mesh_(std::move(mesh)), material_(material), options_(options) {
  check(mesh_, material_, options_);
  const std::vector<char> used = used_nodes(mesh_);
  for (std::size_t n = 0; n < used.size(); ++n) {
    const auto& x = mesh_.nodes[n];
    require(used[n], "node ", n + 1, " of the structure at (", x[0], ", ", x[1], ", ", x[2],
            ") m belongs to no element: take it out of the mesh");
  }
  mass_ = Eigen::VectorXd::Zero(unknowns());
  if (dim() == 2)
    add_mass<2>(mesh_, material_.density, options_.thickness, mass_);
  else
    add_mass<3>(mesh_, material_.density, 1, mass_);
  require(mass_.allFinite() && mass_.minCoeff() > 0, "the masses of the structure's nodes reach from ",
          mass_.minCoeff(), " to ", mass_.maxCoeff(), " kg with density = ", material_.density,
          " kg/m^3, which is none or more than numbers can hold: take values of a real material, and look at the unit "
          "of its "
          "sizes");
  const bool plane_stress = dim() == 2 && options_.plane == Plane::stress;
  const element::Rules rules{plane_stress ? lame_plane_stress(material_) : lame(material_), material_.law,
                             options_.element, options_.plane};
  elements_ = element::make_elements(mesh_, rules, options_.kinematics, options_.thickness);
  link_nodes();
}

Solid::~Solid() = default;
Solid::Solid(Solid&&) noexcept = default;
Solid& Solid::operator=(Solid&&) noexcept = default;

void Solid::link_nodes() {
  first_part_.assign(mesh_.nodes.size() + 1, 0);
  const int corners = mesh_.nodes_per_element();
  for (const auto& nodes : mesh_.elements)
    for (int a = 0; a < corners; ++a) ++first_part_[nodes[a] + 1];
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) first_part_[n + 1] += first_part_[n];
  part_.resize(first_part_.back());
  std::vector<int> next(first_part_.begin(), first_part_.end() - 1);
  for (int e = 0; e < static_cast<int>(mesh_.elements.size()); ++e)
    for (int a = 0; a < corners; ++a) part_[next[mesh_.elements[e][a]]++] = elements_->place_of(e, a);
}

void Solid::internal_force(const Eigen::VectorXd& u, Eigen::VectorXd& f) const {
  expect(u.size() == unknowns() && f.size() == unknowns());
  const double* parts = elements_->forces(u.data());
  if (dim() == 2)
    add_parts<2>(parts, first_part_, part_, f.data());
  else
    add_parts<3>(parts, first_part_, part_, f.data());
}

double Solid::strain_energy(const Eigen::VectorXd& u) const {
  expect(u.size() == unknowns());
  return elements_->energy(u.data());
}

Eigen::SparseMatrix<double> Solid::tangent(const Eigen::VectorXd& u) const {
  expect(u.size() == unknowns());
  const int dims = dim(), n = dims * mesh_.nodes_per_element();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh_.elements.size() * n * n);
  std::vector<double> k(n * n);
  for (int e = 0; e < static_cast<int>(mesh_.elements.size()); ++e) {
    elements_->tangent(mesh_, e, u.data(), k.data());
    const auto unknown = [&](int i) { return dims * mesh_.elements[e][i / dims] + i % dims; };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) entries.emplace_back(unknown(i), unknown(j), k[n * i + j]);
  }
  Eigen::SparseMatrix<double> matrix(unknowns(), unknowns());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<std::array<double, 6>> Solid::stress(const Eigen::VectorXd& u) const {
  expect(u.size() == unknowns());
  std::vector<std::array<double, 6>> all;
  for (int e = 0; e < static_cast<int>(mesh_.elements.size()); ++e) all.push_back(stress(u, e));
  return all;
}

std::array<double, 6> Solid::stress(const Eigen::VectorXd& u, int element) const { return stress(u, element, {}); }

std::array<double, 6> Solid::stress(const Eigen::VectorXd& u, int element, const std::array<double, 3>& xi) const {
  expect(u.size() == unknowns() && element >= 0 && element < static_cast<int>(mesh_.elements.size()));
  return elements_->stress(mesh_, element, u.data(), xi);
}

}  // namespace greenwater
