#include "bench/bytes.hpp"

#include <algorithm>
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

// What is in the lists of close neighbours is not counted: most particles have none.
Traffic collision(const Counts& c) {
  const double find = around(c) + c.particles * index;  // rows, x; number of the close ones written
  const double look =
      places(c) + vectors(c) + 2 * c.particles * index;              // x, u, number of the close ones; number written
  const double collide = look + vectors(c);                          // number read; du written
  const double go_on = 2 * places(c) + 2 * vectors(c) + vectors(c);  // x, u read and written; du
  return {c.collision_finds * find + c.collision_looks * look + c.collision_moves * (collide + go_on),
          find + look + (c.collision_moves > 0) * vectors(c)};
}

Traffic sort(const Counts& c) {
  const double cells = c.cells * index, per_particle = c.particles * index;
  const double find = cells + places(c) + per_particle + 2 * cells;  // cleared; x; cell written, numbers counted up
  const double begin = 3 * cells;                                    // numbers read and written, first written
  const double fill = 2 * per_particle + 2 * cells;                  // cell read, order written, places counted up
  const double settle = cells + 2 * per_particle;                    // first; order read and written
  const double fields = per_particle + places(c) + vectors(c) + scalars(c) + flags(c);  // id x u p surface
  const double reorder = per_particle + 2 * fields;                                     // order; read and written
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
  const double weights = c.keep_weights ? c.entries * weight : 0;
  const double once = around(c) + weights + scalars(c) + vectors(c);  // rows, x, weights; p; a written
  return {once, once};
}

Traffic assemble(const Counts& c) {
  const double diagonal = c.particles * sum + flags(c) + scalars(c);  // sum of weights; surface; diagonal written
  const double source = 2 * scalars(c) + flags(c);                    // n; surface; b written
  return {diagonal + source, c.particles * sum + flags(c) + 3 * scalars(c)};
}

Traffic sum_of(const std::vector<Traffic>& parts) {
  Traffic all;
  for (const Traffic& part : parts) all = {all.moved + part.moved, std::max(all.touched, part.touched)};
  return all;
}

Traffic times(double number_of, const Traffic& once) { return {number_of * once.moved, once.touched}; }

// What conjugate gradients do once.
Traffic begin(const Counts& c) {
  const Traffic product = product_traffic(c, c.keep_weights);
  const double check = flags(c) + 2 * scalars(c);  // surface; (p, p), (b, b)
  const double first = (3 + 1 + 1) * scalars(c);   // r = b - q; (r, r); largest diagonal
  return {check + product.moved + first, product.touched + 2 * scalars(c)};
}

// One turn of them, but for the preconditioner.
Traffic turn(const Counts& c) {
  const Traffic product = product_traffic(c, c.keep_weights);
  const double updates = 3 * scalars(c) + 6 * scalars(c);                           // z + b d; p + a d, r - a q
  return {product.moved + scalars(c) + updates, product.touched + 3 * scalars(c)};  // (d, d)
}

Traffic divide_by_diagonal(const Counts& c) { return {3 * scalars(c), 3 * scalars(c)}; }  // r, diagonal; z written

// The operator's rows as the multigrid reads them, and a float per particle or node.
double float_rows(const Counts& c) { return chunks(c) + c.places * (index + weight); }
double floats(const Counts& c) { return c.particles * weight; }

constexpr double window = 16;  // nodes that a particle's row of A P reaches in a layer
double stencil(const Counts& c) { return c.dim == 2 ? 25 : 125; }

double corners(const Counts& c) { return c.dim == 2 ? 4 : 8; }  // of a cell
double node_floats(const Counts& c) { return c.first_nodes * weight; }

// P^T A P of all levels. In 3-D the first one is made in four layers, each of which adds to two planes of the stencils.
Traffic set_up_multigrid(const Counts& c) {
  const double layers = c.dim == 2 ? 1 : 4, planes = c.dim == 2 ? 1 : 11;  // written, and read when added to
  const double seats =
      places(c) + flags(c) + scalars(c) + (2 + c.dim) * floats(c);          // x surface diagonal; A, 1/A, place
  const double find = c.cells * index + floats(c);                          // first; place
  const double windows = float_rows(c) + (c.dim + 1 + window) * floats(c);  // rows; place, A; window written
  const double cells = c.cells * index + (window + c.dim) * floats(c);      // first; window, place
  const double parts = 2 * corners(c) * window * node_floats(c);            // of the cells, written and read
  const double collect = planes * 25 * node_floats(c);
  const double coarsen = stencil(c) * weight * (3 * c.nodes - c.first_nodes);  // fine read, coarse written; smoother
  return {seats + find + layers * (windows + cells + parts) + collect + coarsen,
          float_rows(c) + (2 + c.dim + window) * floats(c) + (corners(c) * window) * node_floats(c) +
              stencil(c) * c.nodes * weight};
}

// Two sums over rows in float and a V cycle.
Traffic cycle(const Counts& c) {
  const double sweep = scalars(c) + 3 * floats(c);                 // r; 1/A; r, z written
  const double first = 3 * floats(c);                              // 1/A, z; t written
  const double down = c.cells * index + (c.dim + 1) * floats(c) +  // first; place, t
                      (2 * corners(c) + 3) * node_floats(c);       // parts written and read; relax, b, x
  const double levels = (2 * stencil(c) + 15) * c.nodes * weight;  // two stencils; 3 + 4 + 4 + 4 vectors
  const double up = (c.dim + 3) * floats(c) + node_floats(c);      // place, 1/A, z read and written; y
  const double last = 3 * floats(c) + scalars(c);                  // 1/A, r, z; z' written
  return {2 * float_rows(c) + sweep + first + down + levels + up + last,
          float_rows(c) + (4 + c.dim) * floats(c) + 2 * scalars(c) + corners(c) * node_floats(c) +
              (stencil(c) + 4) * c.nodes * weight};
}

Traffic pressure(const Counts& c) {
  const Traffic once = sum_of({assemble(c), begin(c)});
  if (!c.multigrid) return sum_of({once, times(c.iterations, sum_of({turn(c), divide_by_diagonal(c)}))});
  return sum_of({once, set_up_multigrid(c), times(c.iterations, sum_of({turn(c), cycle(c)}))});
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
