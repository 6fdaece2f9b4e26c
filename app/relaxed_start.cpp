#include "app/relaxed_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "app/random.hpp"
#include "core/whole.hpp"

namespace greenwater {
namespace {

constexpr int most_cells = 1 << 29;  // along an axis

using Counts = std::array<int, 3>;

// A lattice that is stretched to bounds. In half cells from their lower end cell centres are odd along every axis.
struct Lattice {
  const FluidCase& fluid;
  int dimension;
  Counts cells;

  Point at(const Counts& half_cells) const {
    Point x{};
    for (int d = 0; d < dimension; ++d)
      x[d] = fluid.min[d] + half_cells[d] * (fluid.max[d] - fluid.min[d]) / cells[d] / 2;
    return x;
  }

  /// Calls f(half cells, place): cell centres, or everything else between the ends that is a whole number of half cells.
  template <class F>
  void for_each(bool centres, F f) const {
    const auto middle = [](int half_cells) { return half_cells % 2 != 0; };
    const int high = dimension == 3 ? 2 * cells[2] : 2;
    for (int k = 1; k < high; ++k)
      for (int j = 1; j < 2 * cells[1]; ++j)
        for (int i = 1; i < 2 * cells[0]; ++i)
          if ((middle(i) && middle(j) && middle(k)) == centres) f(Counts{i, j, k}, at({i, j, k}));
  }
};

Lattice lattice_for(const Scene& scene, double spacing) {
  Lattice lattice{scene.fluid, scene.dimension, {1, 1, 1}};
  for (int d = 0; d < scene.dimension; ++d)
    lattice.cells[d] = whole_within(std::round((scene.fluid.max[d] - scene.fluid.min[d]) / spacing), 1, most_cells);
  return lattice;
}

std::vector<Point> centres_in(const Room& room, const Lattice& lattice) {
  std::vector<Point> points;
  lattice.for_each(true, [&](const Counts&, const Point& x) {
    if (room.holds(x)) points.push_back(x);
  });
  return points;
}

// Of lattices a little finer or coarser than the spacing the one that has most nearly as many cells as are wanted.
Lattice best_lattice(const Room& room, const Scene& scene, std::size_t wanted) {
  constexpr int tries = 15;       // finer and coarser
  constexpr double step = 0.004;  // x spacing
  Lattice best = lattice_for(scene, scene.mps.spacing);
  std::vector<Counts> seen;
  auto least = std::numeric_limits<std::size_t>::max();
  for (int k = 0; k <= 2 * tries && least > 0; ++k) {
    const int way = k % 2 == 0 ? k / 2 : -(k + 1) / 2;
    const Lattice lattice = lattice_for(scene, scene.mps.spacing * (1 + step * way));
    if (std::find(seen.begin(), seen.end(), lattice.cells) != seen.end()) continue;
    seen.push_back(lattice.cells);
    const std::size_t found = centres_in(room, lattice).size();
    const std::size_t off = found > wanted ? found - wanted : wanted - found;
    if (off >= least) continue;
    least = off;
    best.cells = lattice.cells;
  }
  return best;
}

// Points of which it is known which are near.
class Scattered {
 public:
  explicit Scattered(double apart) : apart_(apart) {}

  /// Adds a point unless one of those before is nearer than `apart`.
  bool add(const Point& x) {
    const Counts cell{index(x[0]), index(x[1]), index(x[2])};
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const auto found = points_.find(key({cell[0] + i, cell[1] + j, cell[2] + k}));
          if (found == points_.end()) continue;
          for (const Point& y : found->second)
            if (std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) < apart_) return false;
        }
    points_[key(cell)].push_back(x);
    return true;
  }

 private:
  int index(double x) const { return whole_within(std::floor(x / apart_), -most_cells, most_cells); }
  static std::uint64_t key(const Counts& cell) {
    std::uint64_t key = 0;
    for (const int k : cell) key = key << 21 ^ (static_cast<std::uint64_t>(k) & 0x1fffff);
    return key;
  }

  double apart_;
  std::unordered_map<std::uint64_t, std::vector<Point>> points_;
};

struct Candidate {
  Point x;
  int merit = 0;  // few grades, so that many are as good as each other
  std::size_t number = 0;
};

// The numbers of `count` candidates, the best, and of those that are as good some that are far apart; measure: of the room.
std::vector<std::size_t> picked(std::vector<Candidate> candidates, std::size_t count, double measure, int dimension) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.merit != b.merit ? a.merit > b.merit : random_of(a.number) > random_of(b.number);
  });
  std::vector<std::size_t> numbers;
  count = std::min(count, candidates.size());
  double apart = 0.8 * std::pow(measure / static_cast<double>(std::max<std::size_t>(count, 1)), 1.0 / dimension);
  for (; numbers.size() < count; apart *= 0.7) {
    numbers.clear();
    Scattered scattered(apart);
    for (const Candidate& candidate : candidates)
      if (numbers.size() < count && scattered.add(candidate.x)) numbers.push_back(candidate.number);
  }
  return numbers;
}

// How far the edge of the room is, in sixteenths of a spacing; at most `most`.
int grade_of_gap(const Room& room, const Scene& scene, const Point& x, int most) {
  const double unit = scene.mps.spacing / 16;
  for (int d = 0; d < scene.dimension; ++d)
    most = whole_within(std::min(x[d] - scene.fluid.min[d], scene.fluid.max[d] - x[d]) / unit + 1e-6, 0, most);
  if (!room.edge_within(x, most * unit)) return most;
  int grade = 0;
  while (grade + 1 < most && !room.edge_within(x, (grade + 1) * unit)) ++grade;
  return grade;
}

void take_out(const Room& room, const Scene& scene, std::size_t count, std::vector<Point>& points) {
  constexpr int half = 8;  // where a lattice that fits has its first row
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < points.size(); ++i)
    candidates.push_back({points[i], -grade_of_gap(room, scene, points[i], half), i});
  std::vector<bool> out(points.size(), false);
  const double measure = static_cast<double>(points.size()) * std::pow(scene.mps.spacing, scene.dimension);
  for (const std::size_t i : picked(std::move(candidates), count, measure, scene.dimension)) out[i] = true;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!out[i]) points[kept++] = points[i];
  points.resize(kept);
}

void put_in(const Room& room, const Scene& scene, const Lattice& lattice, std::size_t count,
            std::vector<Point>& points) {
  constexpr int least = 4, farthest = 16;  // sixteenths of a spacing
  std::vector<Candidate> candidates;
  lattice.for_each(false, [&](const Counts& half_cells, const Point& x) {
    if (!room.holds(x)) return;
    const int gap = grade_of_gap(room, scene, x, farthest);
    if (gap < least) return;
    double nearest = scene.mps.spacing;
    for (int corner = 0; corner < 27; ++corner) {  // cell centres around
      Counts near = half_cells;
      bool is_centre = true;
      for (int d = 0, c = corner; d < scene.dimension; ++d, c /= 3) {
        near[d] += c % 3 - 1;
        is_centre = is_centre && near[d] % 2 != 0;
      }
      const Point y = lattice.at(near);
      if (is_centre && room.holds(y)) nearest = std::min(nearest, std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
    }
    const int merit = whole_within(16 * nearest / scene.mps.spacing, 0, 2 * gap);
    candidates.push_back({x, merit, candidates.size()});
  });
  const double measure = static_cast<double>(points.size() + count) * std::pow(scene.mps.spacing, scene.dimension);
  std::vector<Point> places;
  for (const Candidate& candidate : candidates) places.push_back(candidate.x);
  for (const std::size_t k : picked(std::move(candidates), count, measure, scene.dimension))
    points.push_back(places[k]);
}

}  // namespace

std::vector<Point> relaxed_start(const Room& room, const Scene& scene) {
  const auto wanted =
      static_cast<std::size_t>(std::llround(room.measure() / std::pow(scene.mps.spacing, scene.dimension)));
  const Lattice lattice = best_lattice(room, scene, wanted);
  std::vector<Point> points = centres_in(room, lattice);
  if (points.size() > wanted) take_out(room, scene, points.size() - wanted, points);
  if (points.size() < wanted) put_in(room, scene, lattice, wanted - points.size(), points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point x = points[i];
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene.dimension); ++d)
      x[d] += 1e-5 * scene.mps.spacing * random_of(3 * i + d);
    if (room.holds(x)) points[i] = x;
  }
  return points;
}

}  // namespace greenwater
