#pragma once
// Nested dissection: in which order to eliminate, so that little fills up. Nodes along a plane part the rest in two halves
// that do not know each other; each half is parted in turn, and comes before the nodes between (George, SIAM J. Numer.
// Anal. 10:345, 1973).

#include <array>
#include <vector>

namespace greenwater::element {

/// Who knows whom: neighbours of node i are next[first[i]] to next[first[i + 1] - 1].
struct Graph {
  std::vector<int> first, next;
  int size() const { return static_cast<int>(first.size()) - 1; }
};

/// Nodes between two halves, or those of a piece that is not parted any more.
struct Separator {
  std::vector<int> nodes;
  std::vector<int> halves;  // the separators of its halves: earlier in the list
};

/// Every node is in one separator. Nodes know those of the same separator, of those in its halves, and so on down, and of
/// those whose half it is, and so on up; no others.
std::vector<Separator> dissect(const Graph& graph, const std::vector<std::array<double, 3>>& places);

}  // namespace greenwater::element
