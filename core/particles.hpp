#pragma once
// The fluid: one entry per particle in every field. Fields are longer than `count`, at least so much that whole packs of
// particles can be read and written; only the first `count` entries mean anything.

#include <string>
#include <vector>

#include "core/fields.hpp"

namespace greenwater {

/// A vector per particle that an effect adds; it is re-ordered with the others.
struct ExtraField {
  std::string name;
  std::string unit;
  VectorField values;
};

struct Particles {
  int dim = 2;                 // 2 or 3
  int count = 0;               // particles now; falls when some are retired
  IndexField id;               // number given at the start, kept for life
  CoordField position;         // x   [m]
  VectorField velocity;        // u   [m/s]
  VectorField acceleration;    // du/dt of the explicit forces, then of the pressure [m/s^2]
  ScalarField pressure;        // p   [Pa]
  ScalarField number_density;  // n   sum of weights [-]
  FlagField surface;           // 1 = free surface, p = 0
  std::vector<ExtraField> extras;
};

/// A number of particles made up to whole packs and rows, and a pack more, so that one may begin at any particle.
constexpr int padded(int count) { return (count + 63) / 32 * 32; }

/// Room for `count` particles, all fields zero, ids 0, 1, 2 ...
Particles make_particles(int dim, int count);

/// Makes `to` a copy of all fields, in its own memory, which is kept and only grown. It takes over what extras there are:
/// to put particles back is put_back() of kernels/moves.hpp.
void copy(const Particles& from, Particles& to);

/// Adds a vector field of zeros and returns its place in `extras`. Before the first step only: who keeps that place would
/// lose its field when a step is undone.
int add_extra(Particles& particles, const std::string& name, const std::string& unit);

/// Re-orders particles; keeps its scratch memory, so that a steady step allocates nothing.
class Reorder {
 public:
  /// Entry k of every field becomes the old entry order(k), k < kept; the count becomes `kept`.
  void apply(Particles& particles, const IndexField& order, int kept);

 private:
  Particles other_;  // where the fields go; then the two change places
  VectorField extra_;
};

}  // namespace greenwater
