#include "bench/bytes.hpp"

#include <cmath>

#include "core/lanes.hpp"

namespace greenwater::bench {
namespace {

constexpr double index = sizeof(int), offset = sizeof(std::int64_t), flag = sizeof(std::uint8_t);
constexpr double number = sizeof(real), place = sizeof(coord), sum = sizeof(accum), weight = sizeof(float);

double scalars(const Counts& c) { return c.particles * number; }
double vectors(const Counts& c) { return c.particles * c.dim * number; }
double places(const Counts& c) { return c.particles * c.dim * place; }
double flags(const Counts& c) { return c.particles * flag; }

// Of every chunk of rows first and length.
double chunks(const Counts& c) { return std::ceil(c.particles / row_lanes) * (offset + index); }

// chunks, number; index of the neighbours, which come first in a row
double rows(const Counts& c) { return chunks(c) + c.particles * index + c.entries * index; }

// chunks, number; index; of true images mirror and share
double image_rows(const Counts& c) {
  if (!c.walls) return 0;
  return chunks(c) + c.particles * index + c.image_places * index + c.image_entries * (index + number);
}

// Who is around whom: both rows and x.
double around(const Counts& c) { return rows(c) + image_rows(c) + places(c); }

Traffic viscosity(const Counts& c) {
  const double once = around(c) + vectors(c);         // rows, x; u
  return {once + 2 * vectors(c), once + vectors(c)};  // a read and written
}

// predict and correct
Traffic move(const Counts& c) {
  const double moved = 2 * places(c) + 2 * vectors(c) + vectors(c);  // x, u read and written; a read
  return {moved, places(c) + 2 * vectors(c)};
}

Traffic collision(const Counts& c) {
  const double look = around(c) + vectors(c) + c.particles * index;  // rows, x, u; number written
  const double collide = look + vectors(c);                          // number read; du written
  const double go_on = 2 * places(c) + 2 * vectors(c) + vectors(c);  // x, u read and written; du
  return {c.collision_looks * look + c.collision_moves * (collide + go_on),
          look + (c.collision_moves > 0) * vectors(c)};
}

Traffic sort(const Counts& c) {
  const double cells = c.cells * index, per_particle = c.particles * index;
  const double find = cells + places(c) + per_particle + 2 * cells;  // cleared; x; cell written, numbers counted up
  const double begin = 3 * cells;                                    // numbers read and written, first written
  const double fill = 2 * per_particle + 2 * cells;                  // cell read, order written, places counted up
  const double settle = cells + 2 * per_particle;                    // first; order read and written
  const double fields = per_particle + places(c) + vectors(c) + 2 * scalars(c) + flags(c);  // id x u p n surface
  const double reorder = 6 * per_particle + 2 * fields;  // order for each; read and written
  return {find + begin + fill + settle + reorder, 2 * cells + 2 * per_particle + 2 * fields};
}

// Search, weights and n in one pass. Where rows are counted first, x is read twice.
Traffic build_rows(const Counts& c) {
  const double look = places(c) + c.cells * index;                                 // x, first of the cells
  const double heads = chunks(c) + c.particles * (index + sum);                    // chunks, number, sum of weights
  const double near = heads + c.places * (index + (c.keep_weights ? weight : 0));  // index, weight
  const double once = look + near + image_rows(c) + scalars(c);                    // n written
  return {once, once};
}

Traffic gradient(const Counts& c) {
  const double once = around(c) + scalars(c) + vectors(c);  // rows, x; p; a written
  return {once, once};
}

Traffic assemble(const Counts& c) {
  const double diagonal = c.particles * sum + flags(c) + scalars(c);  // sum of weights; surface; diagonal written
  const double source = 2 * scalars(c) + flags(c);                    // n; surface; b written
  return {diagonal + source, c.particles * sum + flags(c) + 3 * scalars(c)};
}

// One turn of conjugate gradients with the diagonal as preconditioner.
Traffic iteration(const Counts& c) {
  const Traffic product = product_traffic(c, c.keep_weights);
  const double sums = 2 * scalars(c) + scalars(c) + 2 * scalars(c) + scalars(c);  // (d, q), (d, d), (r, z), (r, r)
  const double updates = 3 * 3 * scalars(c);                                      // p + a d, r - a q, z + b d
  const double divide = 3 * scalars(c);                                           // r, diagonal; z written
  return {product.moved + sums + updates + divide, product.touched + 3 * scalars(c)};
}

Traffic pressure(const Counts& c) {
  const Traffic first = assemble(c), turn = iteration(c), product = product_traffic(c, c.keep_weights);
  // surface; (b, b); r = b - q; z = r / diagonal; d = z; (r, z), (r, r); largest diagonal
  const double begin = flags(c) + product.moved + (1 + 3 + 3 + 2 + 3 + 1) * scalars(c);
  return {first.moved + begin + c.iterations * turn.moved, turn.touched + scalars(c)};
}

}  // namespace

Traffic product_traffic(const Counts& c, bool keep_weights) {
  const double walk = keep_weights ? chunks(c) + c.places * (index + weight) : around(c);
  const double once = walk + flags(c) + 3 * scalars(c);  // surface; diagonal, p; Ap written
  return {once, once};
}

const std::vector<RegionModel>& region_models() {
  // A line each, so that a change touches one.
  // clang-format off
  static const std::vector<RegionModel> all{
      {"step", "", nullptr},
      {"viscosity", "step", viscosity},
      {"predict", "step", move},
      {"collision", "step", collision},
      {"sort", "step", sort},
      {"rows", "step", build_rows},
      {"pressure", "step", pressure},
      {"gradient", "step", gradient},
      {"correct", "step", move}};
  // clang-format on
  return all;
}

}  // namespace greenwater::bench
