// A structure's substep, against the product that is the least of it: 24 x 24 numbers times 24 for each element. The two
// take turns, so that their ratio holds where the machine's speed drifts.

#ifdef _OPENMP
#include <omp.h>
#endif

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>

#include "bench/measure.hpp"
#include "core/kokkos.hpp"
#include "fem/march.hpp"

namespace greenwater::bench {
namespace {

constexpr double thickness = 0.003, height = 0.1, width = 0.2;  // of the paper's plate [m]
constexpr int paper_elements = 100;
constexpr double paper_substeps = 2e6;
const Material polycarbonate{3.43e9, 0.37, 1200};

struct Variant {
  std::string mesh;  // equal | distorted
  std::string element, kinematics;
  SolidOptions options;
};

std::vector<Variant> variants_of(int elements) {
  std::vector<Variant> all{{"equal", "incompatible", "corotational", {}},
                           {"distorted", "incompatible", "corotational", {}}};
  if (elements != paper_elements) return all;
  all.push_back({"equal", "incompatible", "small", {.kinematics = Kinematics::small}});
  all.push_back({"equal", "full", "corotational", {.element = ElementKind::full}});
  return all;
}

/// The plate in nearly that many elements: 1 x 100 x 1, and more of them along the width, then through the thickness.
std::array<int, 3> divisions_of(int elements) {
  const int up = std::min(elements, 100), through = elements < 50'000 ? 1 : 10;
  return {through, up, std::max(1, elements / (up * through))};
}

SolidMesh plate_mesh(const std::array<int, 3>& n, bool distorted) {
  SolidMesh mesh = box_mesh(3, {0, 0, 0}, {thickness, height, width}, n);
  if (!distorted) return mesh;
  const double spacing[] = {thickness / n[0], height / n[1], width / n[2]};
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> amount(-0.1, 0.1);
  for (auto& x : mesh.nodes)
    for (int d = 0; d < 3; ++d) x[d] += spacing[d] * amount(generator);
  return mesh;
}

/// Bent to an arc of 0.4 radians, so that all elements have turned.
Eigen::VectorXd bent(const SolidMesh& mesh) {
  const double radius = height / 0.4;
  Eigen::VectorXd u(3 * mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto& x = mesh.nodes[i];
    const double angle = x[1] / radius, off = x[0] - thickness / 2;
    u[3 * i] = radius * (1 - std::cos(angle)) + off * (std::cos(angle) - 1);
    u[3 * i + 1] = (radius - off) * std::sin(angle) - x[1];
    u[3 * i + 2] = 0;
  }
  return u;
}

/// Below the critical step of any of these meshes: a third of the time of sound along the shortest edge [s].
double safe_step(const std::array<int, 3>& n) {
  const Lame l = lame(polycarbonate);
  const double shortest = std::min({thickness / n[0], height / n[1], width / n[2]});
  return 0.3 * shortest * std::sqrt(polycarbonate.density / (l.lambda + 2 * l.mu));
}

Supports clamped_foot(const SolidMesh& mesh) {
  Supports supports;
  clamp(supports, 3, find_part(mesh, "front")->nodes);
  return supports;
}

/// The yardstick: gather, product, scatter, one element after the other. Equal elements share a matrix.
class PlainProduct {
 public:
  PlainProduct(const SolidMesh& mesh, bool shared, const Eigen::VectorXd& u)
      : elements_(mesh.elements),
        shared_(shared),
        matrices_(shared ? 1 : mesh.elements.size(), Matrix::Identity()),
        u_(u),
        f_(Eigen::VectorXd::Zero(u.size())) {
    for (std::size_t e = 0; e < matrices_.size(); ++e) matrices_[e](0, 1) += 1e-6 * static_cast<double>(e);
  }

  void run(int times) {
    for (int k = 0; k < times; ++k) {
      f_.setZero();
      for (std::size_t e = 0; e < elements_.size(); ++e) {
        Eigen::Matrix<double, 24, 1> d, g;
        for (int a = 0; a < 8; ++a) d.segment<3>(3 * a) = u_.segment<3>(3 * elements_[e][a]);
        g.noalias() = matrices_[shared_ ? 0 : e] * d;
        for (int a = 0; a < 8; ++a) f_.segment<3>(3 * elements_[e][a]) += g.segment<3>(3 * a);
      }
    }
  }

 private:
  using Matrix = Eigen::Matrix<double, 24, 24>;
  const std::vector<std::array<int, 8>>& elements_;
  bool shared_;
  std::vector<Matrix> matrices_;
  Eigen::VectorXd u_, f_;
};

/// Of the elements' own loops, which are OpenMP's whatever Kokkos runs on.
void set_threads([[maybe_unused]] int threads) {
#ifdef _OPENMP
  omp_set_num_threads(threads);
#endif
}

/// How often work has to be done so that the clock does not matter. `work` takes that number.
template <class Work>
int enough(const Work& work) {
  constexpr double wanted = 5;  // ms
  work(1);
  const double once = ms_of([&] { work(2); }) / 2;
  return static_cast<int>(std::clamp(wanted / std::max(once, 1e-5), 2.0, 1e6));
}

struct Samples {
  int threads = 1, substeps = 0;
  std::vector<double> march = {}, product = {};  // ms of one substep, of all products once
};

Json row_of(const Variant& variant, const std::array<int, 3>& n, const Samples& samples) {
  const int elements = n[0] * n[1] * n[2];
  const Spread march = spread_of(samples.march), product = spread_of(samples.product);
  const double ns = 1e6 / elements;
  Json row{{"case", "plate"},
           {"dim", 3},
           {"elements", elements},
           {"divisions", n},
           {"mesh", variant.mesh},
           {"element", variant.element},
           {"kinematics", variant.kinematics},
           {"threads", samples.threads},
           {"substeps", samples.substeps}};
  add_spread(row, march);
  row["ns_per_element"] = ns * march.median;
  row["ns_per_element_min"] = ns * march.low;
  row["product_ns_per_element"] = ns * product.median;
  row["product_ns_per_element_min"] = ns * product.low;
  row["ratio"] = march.median / product.median;
  if (elements == paper_elements) row["paper_run_s"] = 1e-3 * paper_substeps * march.median;
  return row;
}

/// A plate of one variant, and what was measured of it.
class Subject {
 public:
  Subject(int size, Variant variant, int most)
      : variant_(std::move(variant)),
        divisions_(divisions_of(size)),
        solid_(plate_mesh(divisions_, variant_.mesh == "distorted"), polycarbonate, variant_.options),
        march_(solid_, clamped_foot(solid_.mesh()), {}, {.step = safe_step(divisions_)}, bent(solid_.mesh())),
        product_(solid_.mesh(), variant_.mesh == "equal", bent(solid_.mesh())) {
    for (const int threads : most > 1 ? std::vector{1, most} : std::vector{1}) {
      set_threads(threads);
      samples_.push_back({.threads = threads, .substeps = enough([&](int steps) { march_.advance(steps); })});
    }
    times_ = enough([&](int times) { product_.run(times); });
  }

  void measure() {
    for (Samples& samples : samples_) {
      set_threads(samples.threads);
      samples.march.push_back(ms_of([&] { march_.advance(samples.substeps); }) / samples.substeps);
      samples.product.push_back(ms_of([&] { product_.run(times_); }) / times_);
    }
  }

  void add_rows(Json& rows) const {
    for (const Samples& samples : samples_) rows.push_back(row_of(variant_, divisions_, samples));
  }

 private:
  Variant variant_;
  std::array<int, 3> divisions_;
  Solid solid_;
  March march_;
  PlainProduct product_;
  std::vector<Samples> samples_;
  int times_ = 0;
};

void print_head() {
  fmt::print("{:>10}  {:<11}{:<14}{:<14}{:>8}{:>14}{:>9}{:>9}{:>11}{:>8}\n", "elements", "mesh", "element",
             "kinematics", "threads", "ms a substep", "ns/el.", "best", "24x24, ns", "ratio");
}

void print_row(const Json& row) {
  const auto cell = [&](const char* key) { return figure(row[key].get<double>()); };
  const auto word = [&](const char* key) { return row[key].get<std::string>(); };
  fmt::print("{:>10}  {:<11}{:<14}{:<14}{:>8}{:>14}{:>9}{:>9}{:>11}{:>8}\n", row["elements"].get<int>(), word("mesh"),
             word("element"), word("kinematics"), row["threads"].get<int>(), cell("ms"), cell("ns_per_element"),
             cell("ns_per_element_min"), cell("product_ns_per_element"), cell("ratio"));
  std::fflush(stdout);
}

/// All variants of a size in turn.
void measure(const BenchOptions& options, int size, int threads, Json& rows) {
  std::vector<std::unique_ptr<Subject>> subjects;
  for (const Variant& variant : variants_of(size))
    subjects.push_back(std::make_unique<Subject>(size, variant, threads));
  for (int round = 0; round < options.rounds; ++round)
    for (const auto& subject : subjects) subject->measure();
  const std::size_t before = rows.size();
  for (const auto& subject : subjects) subject->add_rows(rows);
  for (std::size_t i = before; i < rows.size(); ++i) print_row(rows[i]);
  set_threads(threads);
}

}  // namespace

Json bench_fem(const BenchOptions& options) {
  const auto sizes = options.sizes.empty() ? std::vector{paper_elements, 10'000, 100'000} : options.sizes;
#ifdef _OPENMP
  const int threads = Runtime::concurrency();
#else
  const int threads = 1;
#endif
  Json rows = Json::array();
  print_head();
  for (const int size : sizes) measure(options, size, threads, rows);
  for (const Json& row : rows) {
    if (!row.contains("paper_run_s") || row["threads"] != 1) continue;
    fmt::print("2 million substeps of the paper's plate, {}, {}, {}: {} s\n", row["mesh"].get<std::string>(),
               row["element"].get<std::string>(), row["kinematics"].get<std::string>(),
               figure(row["paper_run_s"].get<double>()));
  }
  Json all = results("fem", origin(options, threads, Runtime::space_name()));
  all["rows"] = rows;
  return all;
}

}  // namespace greenwater::bench
