#pragma once
// One more term of the pressure operator, D C D^T: what few unknowns answer to the pressure, such as those of a structure
// that gives way. Column u of D says with what weight each particle's pressure acts on unknown u; C, symmetric and
// positive semi-definite, what the unknowns make of it; and D brings that back to the particles.

#include <vector>

#include "core/fields.hpp"

namespace greenwater {

/// One entry of D.
struct AddedEntry {
  int particle, unknown;
  real value;
};

/// D by columns (other: particle) or by rows (other: unknown): entries of number k are first(k) ... first(k + 1) - 1.
struct AddedLists {
  IndexField first, other;
  ScalarField value;
};

class AddedTerm {
 public:
  /// D, for particles as they are sorted now. Memory is kept and only grown. Entries of one particle and unknown add up.
  void set_rows(int unknowns, const std::vector<AddedEntry>& D);
  /// C(row, column), as many rows as unknowns, row by row. D C D^T has the unit of the pressure operator [1/m^2].
  /// `leading`, row by row as well: the eigenvectors of C with the largest eigenvalues, each times the root of its own, for
  /// preconditioners (kernels/preconditioner_with_term.hpp). Their number is the caller's choice, 0 is one.
  void set_answer(const std::vector<real>& C, const std::vector<real>& leading);

  int unknowns() const { return unknowns_; }
  /// Whether D has entries.
  bool acts() const { return touched_ > 0; }
  const std::vector<real>& leading() const { return leading_; }

  /// felt = D^T p, as long as there are unknowns.
  void feel(const ScalarField& p, const ScalarField& felt) const;
  /// b += factor D v where nothing is fixed.
  void add_source(const FlagField& fixed, real factor, const ScalarField& v, const ScalarField& b) const;
  /// Ap = Ap + D C D^T p where nothing is fixed; p must be 0 where it is. Returns p . D C D^T p.
  accum add_product(const FlagField& fixed, const ScalarField& p, const ScalarField& Ap) const;

 private:
  int unknowns_ = 0;
  int touched_ = 0;  // particles with entries
  AddedLists of_unknown_;
  AddedLists of_particle_;  // of those touched
  IndexField particle_;     // (touched)
  ScalarField C_;           // (row, column)
  std::vector<real> leading_;
  ScalarField felt_;    // (unknown) D^T p
  ScalarField answer_;  // (unknown) C D^T p
};

}  // namespace greenwater
