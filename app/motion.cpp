#include "app/motion.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/formula.hpp"

namespace greenwater {
namespace {

using Vector = std::array<double, 3>;
using Rate = std::function<Vector(double)>;  // of time

Vector plus(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
double largest(const Vector& a) { return std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])}); }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Gauss and Legendre's rule of five points: exact for polynomials up to the ninth degree.
Vector gauss(const Rate& rate, double from, double to) {
  constexpr std::array node{0.0, 0.53846931010568309104, 0.90617984593866399280};
  constexpr std::array weight{0.56888888888888888889, 0.47862867049936646804, 0.23692688505618908751};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  Vector sum{};
  const auto add = [&](double at, double w) {
    const Vector value = rate(at);
    for (int d = 0; d < 3; ++d) sum[d] += w * half * value[d];
  };
  add(middle, weight[0]);
  for (int k : {1, 2}) {
    add(middle - half * node[k], weight[k]);
    add(middle + half * node[k], weight[k]);
  }
  return sum;
}

/// Halves the interval until both halves together say the same as the whole. A jump takes some 50 halvings; what never
/// settles ends with the splits.
class AdaptiveSum {
 public:
  explicit AdaptiveSum(const Rate& rate) : rate_(rate) {}

  Vector over(double from, double to) { return halved(from, to, gauss(rate_, from, to)); }

 private:
  Vector halved(double from, double to, const Vector& whole) {
    const double middle = (from + to) / 2;
    const Vector left = gauss(rate_, from, middle), right = gauss(rate_, middle, to);
    const Vector both = plus(left, right);
    const double change = largest({both[0] - whole[0], both[1] - whole[1], both[2] - whole[2]});
    const bool settled = !(change > 1e-15 * (1 + largest(whole)));  // nan is settled too
    if (settled || !std::isfinite(change) || middle <= from || middle >= to || --splits_ < 0) return both;
    return plus(halved(from, middle, left), halved(middle, to, right));
  }

  const Rate& rate_;
  int splits_ = 2000;
};

/// The integral of a velocity from 0. Whole cells of time are summed once; what is asked costs the piece of one cell.
class Integral {
 public:
  explicit Integral(Rate rate) : rate_(std::move(rate)) {}

  Vector operator()(double t) {
    constexpr double cell = 1.0 / 128;  // [s], exact in binary
    constexpr double most_cells = 1e6;
    const auto before = static_cast<std::size_t>(std::min(std::floor(t / cell), most_cells));
    while (sum_.size() <= before) {
      const double from = static_cast<double>(sum_.size() - 1) * cell;
      sum_.push_back(plus(sum_.back(), AdaptiveSum(rate_).over(from, from + cell)));
    }
    const double from = static_cast<double>(before) * cell;
    return t > from ? plus(sum_[before], AdaptiveSum(rate_).over(from, t)) : sum_[before];
  }

 private:
  Rate rate_;
  std::vector<Vector> sum_{Vector{}};  // up to the beginning of each cell
};

/// The row at or before t; the first one before all.
std::size_t row_at(const TimeTable& table, double t) {
  const auto after = std::upper_bound(table.time.begin(), table.time.end(), t);
  return after == table.time.begin() ? 0 : static_cast<std::size_t>(after - table.time.begin()) - 1;
}

/// The integral of a table from its first row: trapezoids are exact for straight lines.
class TableIntegral {
 public:
  explicit TableIntegral(TimeTable table) : table_(std::move(table)), sum_(1) {
    for (std::size_t k = 1; k < table_.time.size(); ++k) sum_.push_back(up_to(k - 1, table_.time[k]));
  }

  /// From 0 to t.
  Vector operator()(double t) const {
    const Vector end = up_to(row_at(table_, t), t), begin = up_to(row_at(table_, 0), 0);
    return {end[0] - begin[0], end[1] - begin[1], end[2] - begin[2]};
  }

 private:
  Vector up_to(std::size_t row, double t) const {
    Vector sum = sum_[row];
    const double width = t - table_.time[row];
    for (std::size_t d = 0; d < table_.value[row].size(); ++d) {
      sum[d] += width * (table_.value[row][d] + value_of(table_, d, t)) / 2;
    }
    return sum;
  }

  TimeTable table_;
  std::vector<Vector> sum_;  // up to each row
};

using Translation = std::function<Vector(double)>;
using Rotation = std::function<double(double)>;

Rate formula_rate(const VectorFormula& formula) {
  const auto compiled = std::make_shared<std::array<Formula, 3>>(compile(formula.text, formula.place, Variables::time));
  return [compiled](double t) {
    Vector value{};
    for (int d = 0; d < 3; ++d) value[d] = (*compiled)[d](0, 0, 0, t);
    return value;
  };
}

Rate table_rate(const TimeTable& table) {
  return [table](double t) {
    Vector value{};
    for (std::size_t d = 0; d < table.value.front().size(); ++d) value[d] = value_of(table, d, t);
    return value;
  };
}

Translation translation_of(const MotionCase& motion) {
  if (motion.displacement) return formula_rate(*motion.displacement);
  if (motion.displacement_table) return table_rate(*motion.displacement_table);
  if (motion.velocity_table) {
    return [integral = TableIntegral(*motion.velocity_table)](double t) { return integral(t); };
  }
  if (motion.velocity) {
    const auto integral = std::make_shared<Integral>(formula_rate(*motion.velocity));
    return [integral](double t) { return (*integral)(t); };
  }
  return {};
}

Rotation rotation_of(const MotionCase& motion) {
  if (motion.rotation_table) return [table = *motion.rotation_table](double t) { return value_of(table, 0, t); };
  if (motion.rotation) {
    const auto formula = std::make_shared<Formula>(motion.rotation->text, motion.rotation->place, Variables::time);
    return [formula](double t) { return (*formula)(0, 0, 0, t); };
  }
  return {};
}

Vector unit(const Vector& along) {
  const double length = std::hypot(along[0], along[1], along[2]);
  return {along[0] / length, along[1] / length, along[2] / length};
}

}  // namespace

struct Motion::Parts {
  Translation translation;
  Rotation rotation;
  Vector about, axis;
};

Motion::Motion(const MotionCase& motion)
    : parts_(std::make_unique<Parts>(
          Parts{translation_of(motion), rotation_of(motion), motion.about, unit(motion.axis)})) {}

Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;
Motion& Motion::operator=(Motion&&) noexcept = default;

Point Motion::displacement(double t) const {
  return t > 0 && parts_->translation ? parts_->translation(t) : Point{0, 0, 0};
}

double Motion::angle(double t) const { return t > 0 && parts_->rotation ? parts_->rotation(t) : 0; }

Point Motion::at(const Point& x0, double t) const {
  if (!(t > 0)) return x0;
  const Point moved = displacement(t);
  if (!parts_->rotation) return plus(x0, moved);
  // Rodrigues: R r = r cos a + (k x r) sin a + k (k . r) (1 - cos a)
  const double turned = angle(t), c = std::cos(turned), s = std::sin(turned);
  const Vector& k = parts_->axis;
  Vector r;
  for (int d = 0; d < 3; ++d) r[d] = x0[d] - parts_->about[d];
  const Vector side = cross(k, r);
  const double along = dot(k, r) * (1 - c);
  Point x;
  for (int d = 0; d < 3; ++d) x[d] = parts_->about[d] + c * r[d] + s * side[d] + along * k[d] + moved[d];
  return x;
}

double value_of(const TimeTable& table, std::size_t column, double t) {
  if (!(t > table.time.front())) return table.value.front()[column];
  if (t >= table.time.back()) return table.value.back()[column];
  const std::size_t row = row_at(table, t);
  const double s = (t - table.time[row]) / (table.time[row + 1] - table.time[row]);
  return (1 - s) * table.value[row][column] + s * table.value[row + 1][column];
}

double longest_way(const Motion& motion, double from, double to, double reach) {
  const Point before = motion.displacement(from), after = motion.displacement(to);
  const double turn = std::fabs(motion.angle(to) - motion.angle(from));
  return std::hypot(after[0] - before[0], after[1] - before[1], after[2] - before[2]) + turn * reach;
}

LongestStep longest_step(const Motion& motion, double end, double time_step, double reach) {
  constexpr double most_looks = 1e5;
  const double steps = std::ceil(end / time_step), looks = std::min(steps, most_looks);
  LongestStep longest;
  for (double k = 0; k < looks; ++k) {
    const double t = std::floor(k / looks * steps) * time_step;
    const double way = longest_way(motion, t, t + time_step, reach);
    if (way <= longest.way) continue;
    longest = {way, t};
    if (!std::isfinite(way)) break;
  }
  return longest;
}

LongestStep fastest_part(const Motion& motion, LongestStep step, double time_step, double reach) {
  constexpr int halvings = 10;
  double to = step.time + time_step;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (step.time + to) / 2;
    const double first = longest_way(motion, step.time, middle, reach), second = longest_way(motion, middle, to, reach);
    to = second > first ? to : middle;
    step = second > first ? LongestStep{second, middle} : LongestStep{first, step.time};
  }
  return step;
}

}  // namespace greenwater
