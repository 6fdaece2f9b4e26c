// Fluid and structure together: what crosses the interface, and that nothing of it is there without structures.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "coupling/wall_rows.hpp"
#include "fem/held_load_answer.hpp"
#include "kernels/lattice_table.hpp"
#include "kernels/operators/rigid_walls.hpp"
#include "tests/catch.hpp"
#include "tests/elastic.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr real dt = real(1e-3);

/// The rows of a coupled scene's walls at its start.
struct Interface {
  explicit Interface(const Scene& scene) : structures(build_structures(scene)), walls(build_walls(scene)) {
    auto surfaces = add_wet_surfaces(scene, structures, walls);
    surface = std::make_unique<WetSurface>(surfaces.front());
    first_face = static_cast<int>(walls.faces.size() - surface->corner_of_face().size());
    fluid = build_fluid(scene, walls);
    shake();
  }

  /// Walls with these speeds of the corners, and what the survey makes of them with the water at rest.
  void move(const Vector& v) {
    for (std::size_t f = 0; f < surface->corner_of_face().size(); ++f)
      for (int e = 0; e < walls.dim; ++e)
        for (int d = 0; d < walls.dim; ++d)
          fluid.faces.faces[first_face + f].corner[e].velocity[d] = v[walls.dim * surface->corner_of_face()[f][e] + d];
    make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
    fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
    for (real& g : fluid.gravity) g = 0;
    SurveyOptions options;
    options.loads = true;
    options.keeps_volume = false;  // what is not linear in the walls' speed
    survey(fluid, make_lattice_table(fluid.gradient.weight, walls.dim, fluid.spacing), options, dt, found);
    rows.clear();
    const auto pushes = wall_pushes(fluid, found, body());
    auto quadrature = quadrature_of(*surface, fluid.faces, first_face, fluid.grid.shape(), fluid.spacing);
    quadrature.weigh(pushes);
    add_wall_rows(pushes, quadrature, *surface, walls.dim, first_face, 0, rows);
    SweptVolume swept;
    const auto speed = [&](int face, const Triple& x) {
      const WallFace& moved = fluid.faces.faces[face];
      const auto shares = shares_at(moved, walls.dim, x);
      Triple at{};
      for (int e = 0; e < walls.dim; ++e) at = sum(at, scaled(moved.corner[e].velocity, shares[e]));
      return at;
    };
    swept.gather(pushes, quadrature, speed, SweptVolume::Share::whole);
    swept.add_to(found.rhs, found.fixed, source_per_volume(fluid, dt));
  }

  int body() const { return static_cast<int>(walls.bodies.size()) - 1; }

  /// Power of a pressure on the moving water: sum V p (D v), with the divergence that the solve sees.
  double power_of(const std::function<double(int)>& pressure) {
    const auto b = host(found.rhs);
    double sum = 0;
    for (int i = 0; i < fluid.particles.count; ++i)
      sum -= pressure(i) * b(i) * dt / fluid.rho * std::pow(fluid.spacing, walls.dim);
    return sum;
  }

  /// D^T V p.
  Vector load_of(const std::function<double(int)>& pressure) const {
    Vector f = Vector::Zero(walls.dim * surface->corners());
    for (const AddedEntry& entry : rows) f[entry.unknown] += entry.value * pressure(entry.particle);
    return f;
  }

  void shake() {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> by(-0.1 * fluid.spacing, 0.1 * fluid.spacing);
    const auto x = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), fluid.particles.position);
    for (int i = 0; i < fluid.particles.count; ++i)
      for (int d = 0; d < walls.dim; ++d) x(i, d) += by(generator);
    Kokkos::deep_copy(fluid.particles.position, x);
    settle_rows(fluid);
  }

  std::vector<Structure> structures;
  WallFaces walls;
  std::unique_ptr<WetSurface> surface;
  int first_face = 0;
  Fluid fluid;
  Survey found;
  std::vector<AddedEntry> rows;
};

/// A plate in the middle of a tank, wet on both sides and over its tip.
std::string plate_in_water(int dimension) {
  const bool flat = dimension == 2;
  return text_of("format = 1\n[case]\nname = \"p\"\ndimension = ", dimension, "\n[time]\nend = 1\n",
                 "[geometry.tank]\ntype = \"box\"\nmin = ", flat ? "[0, 0]" : "[0, -0.1, 0]",
                 "\nmax = ", flat ? "[0.8, 0.8]" : "[0.8, 0.5, 0.8]", "\nopen = [\"top\"]\n",
                 "[[fluid]]\nname = \"w\"\nregion = { type = \"box\", min = ", flat ? "[0, 0]" : "[0, -0.1, 0]",
                 ", max = ", flat ? "[0.8, 0.6]" : "[0.8, 0.5, 0.6]", " }\n[mps]\nspacing = 0.05\ntime_step = 1e-3\n",
                 "[[structure]]\nname = \"plate\"\nheight = 0.3\nwidth = 0.2\nthickness = 0.02\nbase = ",
                 flat ? "[0.41, 0]" : "[0.41, 0.2, 0]", "\nyoung = 1e8\ndensity = 1500\npoisson = 0.3\n",
                 "[structure.fem]\ndivisions = [1, 4, 2]\n");
}

}  // namespace

TEST_CASE("the power of the load on a bending wall is that of the pressure on the water", "[unit][coupling]") {
  for (const int dimension : {2, 3}) {
    INFO(dimension << "-D");
    Interface at(scene_of_text(plate_in_water(dimension)));
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<double> p(at.fluid.particles.count);
    for (double& value : p) value = any(generator);
    const Vector v = random_vector(dimension * at.surface->corners(), 5);
    at.move(v);
    const auto pressure = [&](int i) { return p[i]; };
    const double power = at.power_of(pressure), by_load = at.load_of(pressure).dot(v);
    double size = 0;
    for (const AddedEntry& entry : at.rows) size += std::fabs(entry.value * p[entry.particle] * v[entry.unknown]);
    CHECK(size > 0);
    CHECK(std::fabs(power - by_load) < 1e-12 * size);
  }
}

TEST_CASE("a constant pressure pushes a flat wall out of the water with p times its area", "[unit][coupling]") {
  Interface at(scene_of_text(column_on_plate(1)));
  at.move(Vector::Zero(2 * at.surface->corners()));
  const Vector f = at.load_of([](int) { return 1000.0; });
  double fx = 0, fy = 0;
  for (Eigen::Index i = 0; i < f.size(); i += 2) {
    fx += f[i];
    fy += f[i + 1];
  }
  CHECK(fy == Approx(-1000.0 * 1).epsilon(1e-10));  // on a shaken lattice; 1 m of wall, downwards
  CHECK(std::fabs(fx) < 1e-9);
}

TEST_CASE("what the structure answers in the pressure solve is symmetric and never negative", "[unit][coupling]") {
  const Scene scene = scene_of_text(plate_in_water(2));
  Interface at(scene);
  at.move(Vector::Zero(2 * at.surface->corners()));
  const Structure& plate = at.structures.front();
  const Eigen::SparseMatrix<double> patterns = at.surface->mean().transpose();
  const Eigen::MatrixXd C =
      held_load_answer(plate.solid(), plate.supports(), patterns, plate.march_options(), plate.substeps());
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(at.fluid.particles.count, C.rows());
  for (const AddedEntry& entry : at.rows) D(entry.particle, entry.unknown) += entry.value;
  const Eigen::MatrixXd A = D * C * D.transpose();
  CHECK((A - A.transpose()).norm() < 1e-13 * A.norm());
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
  CHECK(values.minCoeff() > -1e-12 * values.maxCoeff());
  CHECK(values.maxCoeff() > 0);
}

TEST_CASE("fluid that goes with the walls is in the structure's answer as its mass, however heavy",
          "[unit][coupling]") {
  const FluidSimulation simulation(scene_of_text(plate_in_water(2)));
  const ElasticBody& body = simulation.coupler().body(0);
  StructureAnswer answer;
  const Eigen::Index size = 2 * body.surface.corners();
  answer.renew(body, Vector::Zero(size), dt);
  const Eigen::MatrixXd C = answer.matrix();
  // The mass of the first unknowns, up to a thousand times that of the structure among them.
  const Eigen::Index wet = size / 2;
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(size, size);
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (Eigen::Index i = 0; i < wet; ++i)
    for (Eigen::Index k = 0; k < wet; ++k) B(i, k) = any(generator);
  for (const double ratio : {0.1, 10.0, 1000.0}) {
    INFO("ratio " << ratio);
    Eigen::MatrixXd L = B * B.transpose();
    L *= ratio / (C * L).norm();
    const Eigen::SparseMatrix<double> sparse = L.sparseView();
    CHECK(answer.take_layer(sparse));
    CHECK_FALSE(answer.take_layer(1.01 * sparse));
    CHECK(answer.take_layer(1.1 * sparse));
    CHECK(answer.take_layer(sparse));
    const Eigen::MatrixXd with = Eigen::MatrixXd::Identity(size, size) + C * L;
    const Eigen::MatrixXd exact = with.partialPivLu().solve(C), &found = answer.matrix_with_layer();
    CHECK((found - exact).norm() < 1e-9 * C.norm());
    CHECK((found - found.transpose()).norm() < 1e-9 * C.norm());
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(found).eigenvalues().minCoeff() > -1e-9 * C.norm());
    const Vector v = random_vector(static_cast<int>(size), 6);
    CHECK((answer.with_layer(v) - with.partialPivLu().solve(v)).norm() < 1e-9 * v.norm() * with.norm());
  }
}

TEST_CASE("water that turns with its walls has no divergence, whatever walls there are", "[unit][coupling]") {
  for (const int dimension : {2, 3}) {
    Interface at(scene_of_text(plate_in_water(dimension)));
    const double omega = 0.7;
    const auto speed = [&](double x, double y) { return std::array<double, 2>{-omega * y, omega * x}; };
    const int last = dimension - 1;
    for (WallFace& face : at.fluid.faces.faces)
      for (WallPoint& point : face.corner) {
        const auto v = speed(point.position[0], point.position[last]);
        point.velocity[0] = v[0];
        point.velocity[last] = v[1];
      }
    const auto x = host(at.fluid.particles.position);
    const auto u = Kokkos::create_mirror(at.fluid.particles.velocity);
    for (int i = 0; i < at.fluid.particles.count; ++i) {
      const auto v = speed(x(i, 0), x(i, last));
      for (int d = 0; d < dimension; ++d) u(i, d) = 0;
      u(i, 0) = static_cast<real>(v[0]);
      u(i, last) = static_cast<real>(v[1]);
    }
    Kokkos::deep_copy(at.fluid.particles.velocity, u);
    make_mirror_walls(at.fluid.walls, at.fluid.faces, at.fluid.grid.shape(), at.fluid.spacing);
    at.fluid.rows.build(at.fluid.particles, at.fluid.grid, at.fluid.walls, row_options(at.fluid));
    for (real& g : at.fluid.gravity) g = 0;
    // The plain divergence, of the slip images: (d / n0) sum (u_img - u_i) . r w / r^2, not corrected.
    PressureOptions options;
    options.source = PressureSource::divergence;
    PressureSystem system(options);
    system.assemble(at.fluid, dt);
    const auto b = host(system.rhs());
    const auto surface = host(at.fluid.particles.surface);
    double worst = 0;
    for (int i = 0; i < at.fluid.particles.count; ++i)
      if (surface(i) == 0) worst = std::max(worst, std::fabs(static_cast<double>(b(i))));
    CHECK(worst * dt / at.fluid.rho < 1e-6 * omega);  // kept weights are rounded to float
  }
}

TEST_CASE("a scene without structures launches and allocates nothing of the coupling", "[unit][coupling]") {
  std::string text = column_on_plate(0.5);
  text.resize(text.find("[[structure]]"));
  const Ears ears;
  FluidSimulation simulation(scene_of_text(text));
  for (int k = 0; k < 3; ++k) simulation.step();
  CHECK(ears.launched("survey"));
  for (const char* label : {"added", "corner", "wall_motion", "wall_push", "sample"}) {
    CHECK_FALSE(ears.launched(label));
    CHECK_FALSE(ears.allocated(label));
  }
}

TEST_CASE("joint, repeated and staggered marches are the same where the structure is heavy", "[unit][coupling]") {
  const std::vector<std::string> ways{"default", "aitken", "staggered"};
  std::vector<double> after;
  for (const std::string& way : ways) {
    // Fifty times as heavy and stiff: the water is an eighth of it.
    FluidSimulation simulation(scene_of_text(
        text_of(column_on_plate(0.5), "[[probe]]\nname = \"mid\"\nkind = \"structure_displacement\"\n",
                "point = [0.5, 0]\ncomponent = \"y\"\n[coupling]\ntolerance = 1e-4\nscheme = \"", way, "\"\n"),
        {changed("structure.0.density", 135000), changed("structure.0.young", 3.375e12)}));
    while (simulation.time() < 3e-3) simulation.step();
    after.push_back(simulation.sample(0));
  }
  CHECK(after[0] < -1e-7);
  CHECK(after[1] == Approx(after[0]).epsilon(0.002));
  CHECK(after[2] == Approx(after[0]).epsilon(0.05));  // a step late with its load
}

TEST_CASE("the interface's ledger closes in the joint march, and is wrong by the load's change in the staggered one",
          "[unit][coupling]") {
  const auto mismatch = [](const std::string& way, double step) {
    FluidSimulation simulation(scene_of_text(text_of(column_on_plate(0.5), "[coupling]\nscheme = \"", way, "\"\n"),
                                             {changed("structure.0.density", 135000),
                                              changed("structure.0.young", 3.375e12), changed("mps.time_step", step)}));
    while (simulation.time() < 3.2e-3 * (1 - 1e-9)) simulation.step();
    return std::fabs(simulation.coupler().ledger(0).sums().mismatch());
  };
  const double coarse = mismatch("staggered", 1e-4), fine = mismatch("staggered", 5e-5);
  CHECK(coarse / fine == Approx(2).epsilon(0.15));   // sum of the load's changes times the ways: of first order
  CHECK(mismatch("default", 1e-4) < 1e-3 * coarse);  // what the tolerance of the corrections lets pass
}

TEST_CASE("coupled cases that cannot be are refused with place and cure", "[unit][coupling]") {
  const auto build = [](const std::vector<CaseOption>& options) {
    FluidSimulation simulation(scene_of_text(column_on_plate(0.5), options));
  };
  CHECK_NOTHROW(build({}));
  CHECK_THROWS_WITH(build({set_option("coupling.scheme=joint")}), Catch::Contains("aitken"));
  CHECK_THROWS_WITH(build({set_option("mps.scheme=classic"), set_option("coupling.scheme=default")}),
                    Catch::Contains("staggered"));
  CHECK_THROWS_WITH(build({set_option("coupling.load=kernel_average")}), Catch::Contains("transpose"));
  CHECK_THROWS_WITH(build({set_option("structure.0.wet=[]")}), Catch::Contains("wet is empty"));
  CHECK_THROWS_WITH(build({set_option("structure.0.min=[-0.1, -0.05]")}), Catch::Contains("reaches out of the box"));
}
