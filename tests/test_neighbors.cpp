// Rows against brute force, and the order of everything against the number of threads.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "core/check.hpp"
#include "core/whole.hpp"
#include "tests/shapes.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

using Row = std::map<int, double>;  // neighbour's id -> weight

std::vector<Row> brute_force(const Positions& x, const Weight& w) {
  std::vector<Row> rows(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double dx = x[j][0] - x[i][0], dy = x[j][1] - x[i][1], dz = x[j][2] - x[i][2];
      const double weight = w(std::sqrt(dx * dx + dy * dy + dz * dz));
      if (i != j && weight > 0) rows[i][static_cast<int>(j)] = weight;
    }
  return rows;
}

std::vector<Row> rows_of(const Fluid& fluid) {
  const auto id = host(fluid.particles.id);
  const auto entries = entries_of(fluid);
  std::vector<Row> rows(fluid.particles.count);
  for (int i = 0; i < fluid.particles.count; ++i)
    for (const Entry& entry : entries[i]) {
      const bool once = rows[id(i)].emplace(id(entry.j), entry.weight).second;
      REQUIRE(once);
    }
  return rows;
}

void same_as_brute_force(const Positions& x, int dim, coord spacing) {
  FluidOptions options;
  options.dim = dim;
  options.spacing = spacing;
  const Fluid fluid = fluid_at(x, {}, options);
  REQUIRE(fluid.particles.count == static_cast<int>(x.size()));
  const auto expected = brute_force(x, fluid.laplacian.weight);
  const auto found = rows_of(fluid);
  for (std::size_t i = 0; i < x.size(); ++i) {
    REQUIRE(found[i].size() == expected[i].size());
    for (const auto& [j, w] : expected[i]) {
      REQUIRE(found[i].count(j) == 1);
      CHECK(std::fabs(found[i].at(j) - w) <= 6.0e-8 * w + 1e-12);  // rounded to a float
    }
  }
}

Positions in_one_cell(int count, int dim) {
  Positions x = random_cloud(count, dim, 3);
  for (auto& point : x)
    for (int d = 0; d < dim; ++d) point[d] *= 1e-3;
  return x;
}

Positions on_a_line(int count, int dim) {
  Positions x(count, {0, 0, 0});
  for (int i = 0; i < count; ++i) x[i][dim - 1] = 0.01 * i;
  return x;
}

Positions with_twins(int count, int dim) {
  Positions x = random_cloud(count, dim, 5);
  for (int i = 0; i + 1 < count; i += 10) x[i + 1] = x[i];
  return x;
}

}  // namespace

TEST_CASE("neighbours equal brute force", "[unit][neighbors]") {
  for (const int dim : {2, 3})
    for (const int count : {0, 1, 2, 2000}) {
      INFO("dimension " << dim << ", " << count << " particles");
      same_as_brute_force(random_cloud(count, dim, 7), dim, dim == 2 ? 0.02 : 0.05);
      same_as_brute_force(on_a_line(count, dim), dim, 0.02);
      same_as_brute_force(with_twins(count, dim), dim, 0.03);
    }
  for (const int dim : {2, 3}) same_as_brute_force(in_one_cell(300, dim), dim, 0.01);
}

TEST_CASE("two thousand particles in one cell all see each other", "[unit][neighbors]") {
  FluidOptions options;
  options.spacing = 0.1;
  const Fluid fluid = fluid_at(in_one_cell(2000, 2), {}, options);
  CHECK(fluid.rows.near.entries == 2000LL * 1999);
}

namespace {

using Seen = std::map<std::array<int, 2>, Entry>;  // (id of j, mirror) -> what is seen

std::vector<Seen> seen_by_id(const Fluid& fluid) {
  const auto id = host(fluid.particles.id);
  const auto rows = entries_of(fluid);
  std::vector<Seen> seen(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const Entry& entry : rows[i]) seen[id(i)][{id(entry.j), entry.mirror}] = entry;
  return seen;
}

// Distances of one way may differ from those of the other in the last bit, as compilers contract a x + b where they like.
void same_in_one_pass_and_two(Fluid fluid) {
  const auto fast = seen_by_id(fluid);
  const auto n = by_id(fluid, fluid.particles.number_density), sum = by_id(fluid, fluid.rows.near.weight_sum);
  const auto near = fluid.rows.near.entries, images = fluid.rows.images.entries;
  RowOptions options = row_options(fluid);
  options.portable = true;
  fluid.rows = {};
  fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, options);
  CHECK(fluid.rows.near.entries == near);
  CHECK(fluid.rows.images.entries == images);
  const auto portable = seen_by_id(fluid);
  const auto n2 = by_id(fluid, fluid.particles.number_density), sum2 = by_id(fluid, fluid.rows.near.weight_sum);
  for (std::size_t i = 0; i < fast.size(); ++i) {
    REQUIRE(fast[i].size() == portable[i].size());
    for (const auto& [who, entry] : fast[i]) {
      const auto found = portable[i].find(who);
      REQUIRE(found != portable[i].end());
      CHECK(found->second.share == Approx(entry.share).epsilon(1e-14));
      CHECK(found->second.weight == Approx(entry.weight).epsilon(1.2e-7).margin(1e-12));
    }
    CHECK(n2[i] == Approx(n[i]).epsilon(1e-12).margin(1e-12));
    CHECK(sum2[i] == Approx(sum[i]).epsilon(1.2e-7).margin(1e-12));
  }
}

// A tank with a thin plate in it, a floor of two stretches, and a slanting wall.
WallFaces tank_with_plate() {
  return walls_of({segment(0, 0, 1, 0), segment(1, 0, 2, 0), segment(0, 0, 0, 2), segment(2, 0, 2.5, 1),
                   segment(0.83, 0, 0.83, 0.9, 1)});
}

}  // namespace

TEST_CASE("rows built in one pass are those built in two", "[unit][neighbors]") {
  same_in_one_pass_and_two(fluid_at(random_cloud(3000, 2, 11, 2), tank_with_plate(), {.spacing = 0.04}));
  same_in_one_pass_and_two(fluid_at(lattice(40, 40, 0.05), tank_with_plate(), {.spacing = 0.05}));
  same_in_one_pass_and_two(fluid_at(random_cloud(2000, 3, 12), {}, {.dim = 3, .spacing = 0.08}));
  WallFaces box{3, {}, {{"floor"}, {"side"}}};
  add_rectangle(box, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0);
  add_rectangle(box, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, 1);
  same_in_one_pass_and_two(fluid_at(random_cloud(2000, 3, 13), box, {.dim = 3, .spacing = 0.08, .radius = 2.1}));
  // Two radii: n is not the sum of the weights that are kept.
  Fluid two = fluid_at(random_cloud(1500, 2, 14, 2), tank_with_plate(), {.spacing = 0.05});
  two.density.weight.radius *= real(0.7);
  two.rows.build(two.particles, two.grid, two.walls, row_options(two));
  same_in_one_pass_and_two(two);
}

TEST_CASE("sorting is stable and by cell", "[unit][neighbors]") {
  const Fluid fluid = fluid_at(random_cloud(2000, 2, 9));
  const auto id = host(fluid.particles.id);
  const auto first = host(fluid.grid.first());
  for (int c = 0; c < fluid.grid.shape().count(); ++c)
    for (int k = first(c); k + 1 < first(c + 1); ++k) CHECK(id(k) < id(k + 1));
}

TEST_CASE("sorting carries all fields along", "[unit][neighbors]") {
  const Positions at = random_cloud(500, 3, 4);
  Particles p = particles_at(at, 3);
  const int extra = add_extra(p, "tracer", "-");
  const auto u = Kokkos::create_mirror(p.velocity);
  const auto tracer = Kokkos::create_mirror(p.extras[extra].values);
  const auto pressure = Kokkos::create_mirror(p.pressure);
  for (int i = 0; i < p.count; ++i) {
    pressure(i) = i;
    for (int d = 0; d < 3; ++d) {
      u(i, d) = 10 * i + d;
      tracer(i, d) = -i;
    }
  }
  Kokkos::deep_copy(p.velocity, u);
  Kokkos::deep_copy(p.extras[extra].values, tracer);
  Kokkos::deep_copy(p.pressure, pressure);
  CellGrid grid(make_grid(3, {0, 0, 0}, {1, 1, 1}, 0.13));
  REQUIRE(grid.sort(p).outside == 0);
  const auto id = host(p.id);
  const auto x = host(p.position), sorted_u = host(p.velocity), sorted_tracer = host(p.extras[extra].values);
  const auto sorted_pressure = host(p.pressure);
  for (int i = 0; i < p.count; ++i) {
    CHECK(sorted_pressure(i) == id(i));
    for (int d = 0; d < 3; ++d) {
      CHECK(x(i, d) == at[id(i)][d]);
      CHECK(sorted_u(i, d) == 10 * id(i) + d);
      CHECK(sorted_tracer(i, d) == -id(i));
    }
  }
}

TEST_CASE("particles outside the domain, or nowhere, leave", "[unit][neighbors]") {
  Positions at = random_cloud(100, 2, 6);
  at[7] = {1e6, 0, 0};
  at[20] = {0.5, -1e6, 0};
  at[50] = {std::nan(""), 0.5, 0};
  at[99] = {INFINITY, 0.5, 0};
  Particles p = particles_at(at, 2);
  CellGrid grid(make_grid(2, {0, 0, 0}, {1, 1, 0}, 0.1));
  const Departed departed = grid.sort(p);
  CHECK(departed.outside == 2);
  CHECK(departed.not_a_number == 2);
  CHECK(p.count == 96);
  const auto id = host(p.id);
  for (int i = 0; i < p.count; ++i) CHECK((id(i) != 7 && id(i) != 20 && id(i) != 50 && id(i) != 99));
}

TEST_CASE("every place has a cell of the grid, also one that is not a number", "[unit][neighbors]") {
  const GridShape grid = make_grid(3, {0, 0, 0}, {1, 2, 3}, 0.1);
  const coord numbers[] = {std::nan(""), -std::nan(""), INFINITY, -INFINITY, 1e308,  -1e308, 1e300, 3e9,
                           -3e9,         1e-308,        0,        -0.0,      0.9999, 1e19,   -1e19, 2.9999};
  for (const coord x : numbers) {
    for (int axis = 0; axis < 3; ++axis) {
      const int cell = grid.along(axis, x);
      CHECK(cell >= 0);
      CHECK(cell < grid.cells[axis]);
    }
    for (const coord y : numbers) {
      const int cell = grid.cell_of(Vec<3, coord>{x, 0.5, y});
      CHECK(cell >= 0);
      CHECK(cell < grid.count());
    }
  }
  CHECK(grid.along(0, std::nan("")) == 0);
  CHECK(grid.along(2, 1e308) == grid.cells[2] - 1);
  CHECK(grid.along(2, -1e308) == 0);
}

TEST_CASE("a whole number made of a number is within its bounds", "[unit]") {
  CHECK(whole_within(std::nan(""), 2, 7) == 2);
  CHECK(whole_within(INFINITY, 2, 7) == 7);
  CHECK(whole_within(-INFINITY, 2, 7) == 2);
  CHECK(whole_within(1e300, 0, 1 << 30) == 1 << 30);
  CHECK(whole_within(3.9, 2, 7) == 3);
  CHECK(whole_within(7.5, 2, 7) == 7);
  CHECK(whole_within(-3.0, -10, 7) == -3);
  CHECK(whole_within(1e30, std::int64_t{0}, std::numeric_limits<std::int64_t>::max()) ==
        std::numeric_limits<std::int64_t>::max());
}

TEST_CASE("a grid too large to number is refused", "[unit][neighbors]") {
  CHECK_THROWS_AS(make_grid(3, {0, 0, 0}, {1e4, 1e4, 1e4}, 1e-3), ResourceError);
}
