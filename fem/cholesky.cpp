#include "fem/cholesky.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "fem/dissection.hpp"

namespace greenwater {
namespace {

using element::Graph;
using Matrix = Eigen::SparseMatrix<double>;

/// First unknowns of the nodes, and one past the last.
std::vector<int> nodes_of(const std::vector<std::array<double, 3>>& places) {
  std::vector<int> first;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (i == 0 || places[i] != places[i - 1]) first.push_back(static_cast<int>(i));
  first.push_back(static_cast<int>(places.size()));
  return first;
}

Graph graph_of(const Matrix& a, const std::vector<int>& first) {
  const int nodes = static_cast<int>(first.size()) - 1;
  std::vector<int> node(a.cols()), seen(nodes, -1);
  for (int n = 0; n < nodes; ++n) std::fill(node.begin() + first[n], node.begin() + first[n + 1], n);
  Graph graph{{0}, {}};
  for (int n = 0; n < nodes; ++n) {
    for (int j = first[n]; j < first[n + 1]; ++j) {
      for (Matrix::InnerIterator entry(a, j); entry; ++entry) {
        const int other = node[entry.row()];
        if (seen[other] == n || other == n) continue;
        seen[other] = n;
        graph.next.push_back(other);
      }
    }
    graph.first.push_back(static_cast<int>(graph.next.size()));
  }
  return graph;
}

}  // namespace

Cholesky::Cholesky(const Matrix& a, const std::vector<std::array<double, 3>>& places)
    : place_(a.cols()), row_(a.cols(), -1) {
  expect(a.rows() == a.cols() && a.cols() == static_cast<Eigen::Index>(places.size()));
  order(a, places);
  find_beyond(a);
  eliminate(a);
}

void Cholesky::order(const Matrix& a, const std::vector<std::array<double, 3>>& places) {
  const std::vector<int> first = nodes_of(places);
  std::vector<std::array<double, 3>> at;
  for (std::size_t n = 0; n + 1 < first.size(); ++n) at.push_back(places[first[n]]);
  for (const element::Separator& separator : dissect(graph_of(a, first), at)) {
    Front front;
    front.first = static_cast<int>(old_.size());
    front.halves = separator.halves;
    for (const int n : separator.nodes)
      for (int i = first[n]; i < first[n + 1]; ++i) old_.push_back(i);
    front.count = static_cast<int>(old_.size()) - front.first;
    fronts_.push_back(std::move(front));
  }
  for (std::size_t i = 0; i < old_.size(); ++i) place_[old_[i]] = static_cast<int>(i);
}

void Cholesky::find_beyond(const Matrix& a) {
  std::vector<int> seen(a.cols(), -1);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    const int end = front.first + front.count;
    const auto add = [&](int place) {
      if (place < end || seen[place] == static_cast<int>(f)) return;
      seen[place] = static_cast<int>(f);
      front.beyond.push_back(place);
    };
    for (int i = front.first; i < end; ++i)
      for (Matrix::InnerIterator entry(a, old_[i]); entry; ++entry) add(place_[entry.row()]);
    for (const int half : front.halves)
      for (const int place : fronts_[half].beyond) add(place);
    std::sort(front.beyond.begin(), front.beyond.end());
  }
}

/// The lower half of what a front has to eliminate from: its columns of A, and what its halves have left.
Eigen::MatrixXd Cholesky::assembled(const Matrix& a, const Front& front, std::vector<Eigen::MatrixXd>& left) {
  const auto beyond = static_cast<int>(front.beyond.size()), size = front.count + beyond;
  for (int i = 0; i < front.count; ++i) row_[front.first + i] = i;
  for (int i = 0; i < beyond; ++i) row_[front.beyond[i]] = front.count + i;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (int j = 0; j < front.count; ++j) {
    for (Matrix::InnerIterator entry(a, old_[front.first + j]); entry; ++entry) {
      const int place = place_[entry.row()];
      if (place >= front.first + j) dense(row_[place], j) += entry.value();
    }
  }
  for (const int half : front.halves) {
    const std::vector<int>& from = fronts_[half].beyond;
    for (std::size_t j = 0; j < from.size(); ++j)
      for (std::size_t i = j; i < from.size(); ++i) dense(row_[from[i]], row_[from[j]]) += left[half](i, j);
    left[half].resize(0, 0);
  }
  return dense;
}

void Cholesky::eliminate(const Matrix& a) {
  std::vector<Eigen::MatrixXd> left(fronts_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    const auto beyond = static_cast<Eigen::Index>(front.beyond.size());
    Eigen::MatrixXd dense = assembled(a, front, left);
    if (front.count == 0) {
      left[f] = std::move(dense);
      continue;
    }
    auto own = dense.topLeftCorner(front.count, front.count), below = dense.bottomLeftCorner(beyond, front.count);
    definite_ = Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(own).info() == Eigen::Success;
    if (!definite_) return;
    own.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
    left[f] = dense.bottomRightCorner(beyond, beyond);
    left[f].selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
    front.columns = dense.leftCols(front.count);
  }
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  expect(definite_ && b.rows() == static_cast<Eigen::Index>(old_.size()));
  Eigen::MatrixXd x = b(old_, Eigen::all);
  for (const Front& front : fronts_) {
    auto own = x.middleRows(front.first, front.count);
    front.columns.topRows(front.count).triangularView<Eigen::Lower>().solveInPlace(own);
    x(front.beyond, Eigen::all) -= front.columns.bottomRows(front.beyond.size()) * own;
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    auto own = x.middleRows(front->first, front->count);
    own -= front->columns.bottomRows(front->beyond.size()).transpose() * x(front->beyond, Eigen::all);
    front->columns.topRows(front->count).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  return x(place_, Eigen::all);
}

}  // namespace greenwater
