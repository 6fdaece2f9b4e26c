#pragma once
// C: with what speeds the corners of a structure answer to forces on them that are held over a step of the fluid. It is that
// of the substeps themselves, about the shape at rest, and it turns with the surface.
//
// A layer of fluid goes with the walls (layer_mass() in wall_rows.hpp): at speeds V, which were V0 in the last step, it takes
// L (V - V0) off the forces, L = M / dt. To forces F beside that, a structure that would go with V1 answers with
//
//   V = (1 + C L)^-1 (V1 + C (F + L V0)),
//
// implicitly, as the layer may well be heavier than the structure. (1 + C L)^-1 C is symmetric and positive like C.

#include "coupling/elastic_body.hpp"

namespace greenwater {

class StructureAnswer {
 public:
  /// For a step dt [s] from where the corners are displaced by `displaced` [m]. Answers of steps that differ little differ
  /// little, as those of surfaces that have turned little: so they are made anew only now and then. True when it was.
  bool renew(const ElasticBody& body, const Eigen::VectorXd& displaced, double dt);
  /// L [kg/(m s)], in 3-D [kg/s]: after renew(), for every step. It is taken over when it has changed by what matters; true
  /// when it was, or when C is another.
  bool take_layer(const Eigen::SparseMatrix<double>& L);

  /// Mean speeds over the step per load [m/s per N/m, in 3-D per N]; symmetric, positive semi-definite. Nothing before
  /// renew().
  const Eigen::MatrixXd& matrix() const { return now_.matrix; }
  /// L as it has been taken over.
  const Eigen::SparseMatrix<double>& layer() const { return layer_; }
  /// (1 + C L)^-1 v
  Eigen::VectorXd with_layer(const Eigen::VectorXd& v) const;
  /// (1 + C L)^-1 C
  const Eigen::MatrixXd& matrix_with_layer() const { return with_layer_.matrix; }
  /// Its eigenvectors of the largest eigenvalues, nearly, in rows, each times the root of its own: what counts of it.
  const Eigen::MatrixXd& leading_with_layer() const { return with_layer_.leading; }

 private:
  struct Answer {
    Eigen::MatrixXd matrix, leading;
  };
  using Turns = std::vector<Eigen::MatrixXd>;  // of the corners
  static Answer turned(Answer answer, const Turns& turns);

  double dt_ = 0;  // of the step that it was made for [s]
  Answer at_rest_, now_, with_layer_;
  Turns turns_;
  bool changed_ = false;  // C since the layer was taken over
  Eigen::SparseMatrix<double> layer_;
  std::vector<Eigen::Index> wet_;  // unknowns that the layer touches
  Eigen::MatrixXd C_of_wet_;       // C, columns of those
  Eigen::MatrixXd resistance_;     // (1 + L C)^-1 L among those
};

}  // namespace greenwater
