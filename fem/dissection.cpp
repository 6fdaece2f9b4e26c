#include "fem/dissection.hpp"

#include <algorithm>

namespace greenwater::element {
namespace {

constexpr std::size_t whole = 24;  // nodes of a piece that is not worth parting

struct Parting {
  std::vector<int> low, high, between;

  /// Nodes between for each of the smaller half: small is good.
  double cost() const {
    return static_cast<double>(between.size() + 1) / static_cast<double>(std::min(low.size(), high.size()) + 1);
  }
};

class Dissection {
 public:
  Dissection(const Graph& graph, const std::vector<std::array<double, 3>>& places)
      : graph_(graph), places_(places), mark_(graph.size(), 0) {}

  /// Returns the separator of these nodes.
  int add(std::vector<int> nodes) {
    Separator separator;
    const Parting best = nodes.size() > whole ? parted(nodes) : Parting{};
    if (best.low.empty()) {
      separator.nodes = std::move(nodes);
    } else {
      separator.halves.push_back(add(best.low));
      if (!best.high.empty()) separator.halves.push_back(add(best.high));
      separator.nodes = best.between;
    }
    found_.push_back(std::move(separator));
    return static_cast<int>(found_.size()) - 1;
  }

  std::vector<Separator> take() { return std::move(found_); }

 private:
  Parting parted(const std::vector<int>& nodes) {
    Parting best;
    for (int axis = 0; axis < 3; ++axis) {
      Parting next = parted(nodes, axis);
      if (!next.low.empty() && (best.low.empty() || next.cost() < best.cost())) best = std::move(next);
    }
    return best;
  }

  /// At the middle node along an axis; nothing in `low` where all are at one place.
  Parting parted(const std::vector<int>& nodes, int axis) {
    std::vector<double> along;
    for (const int n : nodes) along.push_back(places_[n][axis]);
    const auto [least, most] = std::minmax_element(along.begin(), along.end());
    const double tolerance = 1e-6 * (*most - *least), low = *least, high = *most;
    if (!(high > low)) return {};
    std::nth_element(along.begin(), along.begin() + along.size() / 2, along.end());
    // Just below the middle node, so that a plane of a regular mesh stays together.
    const double middle = std::max(along[along.size() / 2] - tolerance, low + tolerance);
    Parting parting;
    const int seen = ++mark_count_;
    for (const int n : nodes) {
      if (places_[n][axis] >= middle) continue;
      parting.low.push_back(n);
      for (int i = graph_.first[n]; i < graph_.first[n + 1]; ++i) mark_[graph_.next[i]] = seen;
    }
    for (const int n : nodes)
      if (places_[n][axis] >= middle) (mark_[n] == seen ? parting.between : parting.high).push_back(n);
    return parting;
  }

  const Graph& graph_;
  const std::vector<std::array<double, 3>>& places_;
  std::vector<int> mark_;  // the last parting whose low half knows the node
  int mark_count_ = 0;
  std::vector<Separator> found_;
};

}  // namespace

std::vector<Separator> dissect(const Graph& graph, const std::vector<std::array<double, 3>>& places) {
  std::vector<int> all(graph.size());
  for (int i = 0; i < graph.size(); ++i) all[i] = i;
  Dissection dissection(graph, places);
  dissection.add(std::move(all));
  return dissection.take();
}

}  // namespace greenwater::element
