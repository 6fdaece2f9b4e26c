#include "core/mesh_faults.hpp"

#include <algorithm>
#include <numeric>

#include "core/check.hpp"
#include "core/mesh_edges.hpp"

namespace greenwater {
namespace {

std::string at(const Triple& x) {
  const auto plain = [](coord c) { return c == 0 ? coord(0) : c; };  // no -0
  return text_of('(', plain(x[0]), ", ", plain(x[1]), ", ", plain(x[2]), ')');
}

Triple middle(const TriangleMesh& mesh, int t) {
  const auto& c = triangle(mesh, t);
  return scaled(sum(sum(vertex(mesh, c[0]), vertex(mesh, c[1])), vertex(mesh, c[2])), coord(1) / 3);
}

std::string triangle_at(const TriangleMesh& mesh, int t) {
  return text_of("triangle ", t + 1, " at ", at(middle(mesh, t)));
}

std::string counted(std::size_t count, const std::string& one, const std::string& more) {
  return text_of(count, ' ', count == 1 ? one : more);
}

std::string first_of(std::size_t count) { return count == 1 ? ": " : "; the first: "; }

/// Each triangle that is there already, and the earlier one.
std::vector<std::pair<int, int>> duplicates(const TriangleMesh& mesh) {
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> corners = mesh.triangles[t];
    if (has_equal_corners(corners)) continue;
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, static_cast<int>(t));
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 1, first = 0; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[first].first) {
      first = i;
    } else {
      found.emplace_back(sorted[i].second, sorted[first].second);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool is_sliver(const TriangleShape& shape) { return shape.smallest_height < sliver_height * shape.longest_length; }

void find_flat(const TriangleMesh& mesh, MeshFaults& faults) {
  std::vector<int> without_area, slivers;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const bool flat = has_equal_corners(corners);
    if (flat || is_sliver(shape_of(mesh, corners))) (flat ? without_area : slivers).push_back(static_cast<int>(t));
  }
  if (const auto n = without_area.size(); n > 0) {
    faults.words.push_back(counted(n, "triangle has", "triangles have") +
                           " two corners at the same place, and so no area" + first_of(n) +
                           triangle_at(mesh, without_area.front()));
  }
  if (const auto n = slivers.size(); n > 0) {
    faults.words.push_back(counted(n, "triangle is a sliver", "triangles are slivers") +
                           ", with a height below 1e-6 of the longest edge" + first_of(n) +
                           triangle_at(mesh, slivers.front()));
  }
}

void find_crowded_edges(const TriangleMesh& mesh, const MeshEdges& edges, MeshFaults& faults) {
  std::size_t count = 0;
  std::string first;
  for (std::size_t e = 0; e < edges.count(); ++e) {
    if (edges.uses(e) <= 2 || ++count > 1) continue;
    first = text_of("from ", at(vertex(mesh, edges.begin(e)->from)), " to ", at(vertex(mesh, edges.begin(e)->to)),
                    " for triangles");
    for (const MeshSide* s = edges.begin(e); s != edges.end(e); ++s) {
      first += text_of(s == edges.begin(e) ? " " : s + 1 == edges.end(e) ? " and " : ", ", s->triangle + 1);
    }
  }
  if (count == 0) return;
  faults.words.push_back(counted(count, "edge belongs", "edges belong") + " to more than two triangles" +
                         first_of(count) + first);
}

void find_disagreement(const TriangleMesh& mesh, const MeshEdges& edges, MeshFaults& faults) {
  std::size_t count = 0;
  std::string first;
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const MeshSide* s = edges.begin(e);
    if (edges.uses(e) != 2 || s[0].from != s[1].from || ++count > 1) continue;
    first = text_of("triangles ", s[0].triangle + 1, " and ", s[1].triangle + 1, " at the edge from ",
                    at(vertex(mesh, s->from)), " to ", at(vertex(mesh, s->to)));
  }
  if (count == 0) return;
  faults.words.push_back(counted(count, "pair", "pairs") + " of neighbours face opposite ways" + first_of(count) +
                         first);
}

void find_wrong_sides(const TriangleMesh& mesh, const MeshEdges& edges, MeshFaults& faults) {
  for (const MeshParts::Part& part : parts_of(mesh, edges).parts) {
    const std::string where = "the part with " + triangle_at(mesh, part.first);
    if (part.one_sided) {
      faults.words.push_back(where +
                             " has one side only, as a Moebius strip: its neighbours cannot agree where outside is");
    } else if (part.closed && part.turned == 0 && (part.volume < 0) != (part.depth % 2 == 1)) {
      faults.words.push_back(where + (part.depth % 2 == 1 ? " is a cavity in another one and has to face inwards"
                                                          : " is inside out: its triangles face inwards"));
    }
  }
}

void find_split_edges(const TriangleMesh& mesh, const MeshEdges& edges, MeshFaults& faults) {
  const auto found = vertices_on_edges(mesh, edges);
  if (found.empty()) return;
  faults.words.push_back(counted(found.size(), "vertex lies", "vertices lie") +
                         " on an edge that does not end there (T-junction)" + first_of(found.size()) +
                         at(vertex(mesh, found.front().vertex)) + " on the edge of " +
                         triangle_at(mesh, found.front().side.triangle));
}

/// Edges of one triangle, put together where they meet.
std::vector<MeshHole> holes_of(const TriangleMesh& mesh, const MeshEdges& edges) {
  std::vector<int> leader(mesh.vertices.size());
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int v) {
    while (leader[static_cast<std::size_t>(v)] != v) {
      int& up = leader[static_cast<std::size_t>(v)];
      v = up = leader[static_cast<std::size_t>(up)];
    }
    return v;
  };
  for (std::size_t e = 0; e < edges.count(); ++e) {
    const MeshSide* s = edges.begin(e);
    if (edges.uses(e) == 1) leader[static_cast<std::size_t>(find(s->from))] = find(s->to);
  }
  std::vector<int> number(mesh.vertices.size(), -1);
  std::vector<MeshHole> holes;
  for (std::size_t e = 0; e < edges.count(); ++e) {
    if (edges.uses(e) != 1) continue;
    const MeshSide* s = edges.begin(e);
    int& mine = number[static_cast<std::size_t>(find(s->from))];
    if (mine < 0) {
      mine = static_cast<int>(holes.size());
      holes.push_back({});
    }
    MeshHole& hole = holes[static_cast<std::size_t>(mine)];
    const Triple &from = vertex(mesh, s->from), &to = vertex(mesh, s->to);
    ++hole.edges;
    hole.length += distance(from, to);
    hole.centre = sum(hole.centre, scaled(sum(from, to), 0.5));
  }
  for (MeshHole& hole : holes) hole.centre = scaled(hole.centre, coord(1) / hole.edges);
  std::stable_sort(holes.begin(), holes.end(), [](const auto& a, const auto& b) { return a.length > b.length; });
  return holes;
}

// ---- mending ----

struct Work {
  std::size_t welded = 0, without_area = 0, twice = 0, slivers = 0, split = 0, turned = 0;
};

/// Takes out the triangles that are marked; returns how many.
std::size_t drop(TriangleMesh& mesh, const std::vector<char>& marked) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < marked.size(); ++t)
    if (marked[t] == 0) mesh.triangles[kept++] = mesh.triangles[t];
  mesh.triangles.resize(kept);
  return marked.size() - kept;
}

std::size_t drop_without_area(TriangleMesh& mesh) {
  std::vector<char> marked(mesh.triangles.size(), 0);
  std::transform(mesh.triangles.begin(), mesh.triangles.end(), marked.begin(),
                 [](const auto& t) { return static_cast<char>(has_equal_corners(t)); });
  return drop(mesh, marked);
}

std::size_t drop_duplicates(TriangleMesh& mesh) {
  std::vector<char> marked(mesh.triangles.size(), 0);
  for (const auto& [again, first] : duplicates(mesh)) marked[static_cast<std::size_t>(again)] = 1;
  return drop(mesh, marked);
}

void replace(std::array<int, 3>& corners, int old, int by) { std::replace(corners.begin(), corners.end(), old, by); }

/// A sliver with a short edge loses that edge. One without has a corner on its longest edge: the triangle behind that
/// edge is parted at the corner. Each changes a place once in a pass, so that none spoils what another has seen.
std::size_t undo_slivers(TriangleMesh& mesh) {
  constexpr coord short_edge = 4 * sliver_height;  // of the longest
  const MeshEdges edges(mesh);
  std::vector<char> touched(mesh.triangles.size(), 0), moved(mesh.vertices.size(), 0), gone(mesh.triangles.size(), 0);
  std::vector<std::pair<int, int>> joined;
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<int, 3> corners = mesh.triangles[t];
    const TriangleShape shape = shape_of(mesh, corners);
    if (touched[t] != 0 || !is_sliver(shape)) continue;
    const auto corner = [&](int side) { return corners[static_cast<std::size_t>(side % 3)]; };
    if (shape.shortest_length < short_edge * shape.longest_length) {
      const int keep = corner(shape.shortest), lose = corner(shape.shortest + 1);
      char &keep_moved = moved[static_cast<std::size_t>(keep)], &lose_moved = moved[static_cast<std::size_t>(lose)];
      if (keep_moved != 0 || lose_moved != 0) continue;
      keep_moved = lose_moved = 1;
      joined.emplace_back(keep, lose);
      ++count;
      continue;
    }
    const int a = corner(shape.longest), b = corner(shape.longest + 1), c = corner(shape.longest + 2);
    const std::size_t e = edges.find(a, b);
    if (edges.uses(e) > 2) continue;
    touched[t] = 1;
    if (edges.uses(e) == 1) {
      gone[t] = 1;
      ++count;
      continue;
    }
    const int neighbour =
        edges.begin(e)->triangle == static_cast<int>(t) ? edges.begin(e)[1].triangle : edges.begin(e)->triangle;
    const auto n = static_cast<std::size_t>(neighbour);
    if (touched[n] != 0) continue;
    touched[n] = 1;
    mesh.triangles[t] = mesh.triangles[n];
    replace(mesh.triangles[t], a, c);
    replace(mesh.triangles[n], b, c);
    ++count;
  }
  std::vector<int> now(mesh.vertices.size());
  std::iota(now.begin(), now.end(), 0);
  for (const auto& [keep, lose] : joined) now[static_cast<std::size_t>(lose)] = keep;
  for (auto& corners : mesh.triangles)
    for (int& corner : corners) corner = now[static_cast<std::size_t>(corner)];
  drop(mesh, gone);
  return count;
}

/// Parts triangles at the vertices that lie on one of their edges: a fan from the corner opposite of it.
std::size_t split_edges(TriangleMesh& mesh) {
  const std::vector<VertexOnEdge> found = vertices_on_edges(mesh, MeshEdges(mesh));
  std::vector<char> touched(mesh.triangles.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 0, end = 0; i < found.size(); i = end) {
    const MeshSide& side = found[i].side;
    const auto t = static_cast<std::size_t>(side.triangle);
    while (end < found.size() && found[end].side.triangle == side.triangle && found[end].side.from == side.from) ++end;
    if (touched[t] != 0) continue;
    touched[t] = 1;
    ++count;
    int last = side.from;
    const std::array<int, 3> whole = mesh.triangles[t];
    for (std::size_t k = i; k < end; ++k) {
      std::array<int, 3> piece = whole;
      replace(piece, side.to, found[k].vertex);
      replace(piece, side.from, last);
      mesh.triangles.push_back(piece);
      last = found[k].vertex;
    }
    replace(mesh.triangles[t], side.from, last);
  }
  return count;
}

std::size_t face_outwards(TriangleMesh& mesh) {
  const MeshParts all = parts_of(mesh, MeshEdges(mesh));
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (all.part[t] < 0) continue;
    const MeshParts::Part& part = all.parts[static_cast<std::size_t>(all.part[t])];
    if (part.one_sided) continue;
    const bool first_is_wrong =
        part.closed ? (part.volume < 0) != (part.depth % 2 == 1) : 2 * part.turned > part.triangles;
    if ((all.turned[t] != 0) == first_is_wrong) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++count;
  }
  return count;
}

std::vector<std::string> words_of(const Work& work) {
  std::vector<std::string> words;
  const auto say = [&](std::size_t count, const std::string& verb, const std::string& rest) {
    if (count > 0) words.push_back(verb + counted(count, "triangle", "triangles") + rest);
  };
  if (work.welded > 0) words.push_back("joined " + counted(work.welded, "vertex", "vertices") + " with a near one");
  say(work.without_area, "took out ", " without area");
  say(work.twice, "took out ", " that stood there twice");
  say(work.slivers, "undid ", " as slivers");
  say(work.split, "parted ", " at vertices on their edges");
  say(work.turned, "turned ", " to face as the others do, outwards where the surface is closed");
  return words;
}

}  // namespace

MeshFaults find_faults(const TriangleMesh& mesh) {
  MeshFaults faults;
  if (mesh.triangles.empty()) faults.words.emplace_back("there is no triangle with an area");
  find_flat(mesh, faults);
  // Without the second ones: what follows from them is no fault of its own.
  TriangleMesh once = mesh;
  const auto twice = duplicates(mesh);
  for (const auto& [again, first] : twice) once.triangles[static_cast<std::size_t>(again)] = {0, 0, 0};
  if (const auto n = twice.size(); n > 0) {
    faults.words.push_back(counted(n, "triangle stands", "triangles stand") + " at the place of another" + first_of(n) +
                           text_of("triangle ", twice.front().second + 1, " and again ") +
                           triangle_at(mesh, twice.front().first));
  }
  const MeshEdges edges(once);
  find_crowded_edges(mesh, edges, faults);
  find_split_edges(mesh, edges, faults);
  find_disagreement(mesh, edges, faults);
  find_wrong_sides(once, edges, faults);
  faults.holes = holes_of(mesh, edges);
  return faults;
}

std::string words_of(const std::vector<MeshHole>& holes) {
  if (holes.empty()) return {};
  const MeshHole& hole = holes.front();
  return text_of(counted(holes.size(), "hole", "holes"), holes.size() == 1 ? ": " : "; the largest: ", hole.edges,
                 " edges, ", hole.length, " round, about ", at(hole.centre));
}

std::vector<std::string> mend(TriangleMesh& mesh) {
  constexpr int most_passes = 30;  // one thing mended may show the next
  Work work;
  work.welded = static_cast<std::size_t>(weld(mesh, sliver_height * diagonal_of(mesh)));
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::size_t flat = drop_without_area(mesh), twice = drop_duplicates(mesh), slivers = undo_slivers(mesh);
    const std::size_t split = slivers == 0 ? split_edges(mesh) : 0;
    work.without_area += pass == 0 ? flat : 0;  // later ones are collapsed slivers, and counted there
    work.twice += twice;
    work.slivers += slivers;
    work.split += split;
    if (flat + twice + slivers + split == 0) break;
  }
  work.turned = face_outwards(mesh);
  weld(mesh, 0);  // unused vertices go
  return words_of(work);
}

}  // namespace greenwater
