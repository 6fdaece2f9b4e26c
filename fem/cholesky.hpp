#pragma once
// Factors of a stiffness matrix. Unknowns are eliminated in the order of fem/dissection.hpp, all of a separator at once as
// one dense matrix, which is what a processor is quickest at (multifrontal: Duff, Reid, ACM TOMS 9:302, 1983).

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <vector>

namespace greenwater {

class Cholesky {
 public:
  /// P A P^T = L L^T of a symmetric A, of which the lower half is read. Unknown i sits at places[i] [m], and those at one
  /// place follow each other: how long it takes depends on places, what comes out does not.
  Cholesky(const Eigen::SparseMatrix<double>& a, const std::vector<std::array<double, 3>>& places);

  /// Whether A is positive definite; there is nothing to solve with if it is not.
  bool definite() const { return definite_; }
  /// A^-1 b, column by column.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  /// Unknowns that are eliminated together, by their numbers in the new order.
  struct Front {
    int first = 0, count = 0;
    std::vector<int> beyond;  // later unknowns that they reach, ascending
    std::vector<int> halves;  // fronts that leave something to this one
    Eigen::MatrixXd columns;  // of L: rows of the unknowns themselves, then of those beyond
  };

  void order(const Eigen::SparseMatrix<double>& a, const std::vector<std::array<double, 3>>& places);
  void find_beyond(const Eigen::SparseMatrix<double>& a);
  Eigen::MatrixXd assembled(const Eigen::SparseMatrix<double>& a, const Front& front,
                            std::vector<Eigen::MatrixXd>& left);
  void eliminate(const Eigen::SparseMatrix<double>& a);

  std::vector<int> place_;  // in the new order, of an old unknown
  std::vector<int> old_;    // of a place in the new order
  std::vector<int> row_;    // in the front at work, of a place in the new order
  std::vector<Front> fronts_;
  bool definite_ = true;
};

}  // namespace greenwater
