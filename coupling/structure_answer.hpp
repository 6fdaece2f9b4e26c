#pragma once
// C: with what speeds the corners of a structure answer to forces on them that are held over a step of the fluid. It is that
// of the substeps themselves, about the shape at rest, and it turns with the surface.

#include "coupling/elastic_body.hpp"

namespace greenwater {

class StructureAnswer {
 public:
  /// For a step dt [s] from where the corners are displaced by `displaced` [m]. Answers of steps that differ little differ
  /// little, as those of surfaces that have turned little: so they are made anew only now and then. True when it was.
  bool renew(const ElasticBody& body, const Eigen::VectorXd& displaced, double dt);

  /// Mean speeds over the step per load [m/s per N/m, in 3-D per N]; symmetric, positive semi-definite. Nothing before
  /// renew().
  const Eigen::MatrixXd& matrix() const { return now_.matrix; }
  /// Its eigenvectors of the largest eigenvalues, in rows, each times the root of its own: what counts of it.
  const Eigen::MatrixXd& leading() const { return now_.leading; }

 private:
  struct Answer {
    Eigen::MatrixXd matrix, leading;
  };
  using Turns = std::vector<Eigen::MatrixXd>;  // of the corners
  static Answer turned(Answer answer, const Turns& turns);

  double dt_ = 0;  // of the step that it was made for [s]
  Answer at_rest_, now_;
  Turns turns_;
};

}  // namespace greenwater
