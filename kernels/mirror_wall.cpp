#include "kernels/mirror_wall.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kernels/wall_panels.hpp"

namespace greenwater {
namespace {

// Memory is only ever grown, so that walls that move allocate nothing.
template <class View, class T>
void upload(View& to, const std::string& label, const std::vector<T>& from) {
  if (from.empty()) return;
  if (to.extent(0) < from.size()) to = uncleared<View>(label, from.size() + from.size() / 4);
  Kokkos::deep_copy(Kokkos::subview(to, std::pair<std::size_t, std::size_t>(0, from.size())),
                    Kokkos::View<const T*, Kokkos::HostSpace>(from.data(), from.size()));
}

std::array<coord, 3> centre_of(const GridShape& grid, const std::array<int, 3>& cell, int dim) {
  std::array<coord, 3> x{};
  for (int d = 0; d < dim; ++d) x[d] = grid.origin[d] + (cell[d] + 0.5) * grid.cell;
  return x;
}

// For each cell the panels within one radius of any point in it.
std::vector<std::vector<int>> panels_near(const WallPanels& walls, const GridShape& grid, int dim) {
  const coord within = grid.cell * (1 + std::sqrt(dim) / 2);  // one radius from a corner, seen from the centre
  std::vector<std::vector<int>> near(grid.count());
  for (int p = 0; p < static_cast<int>(walls.panels.size()); ++p)
    for (int k = walls.panels[p].first_piece; k < walls.panels[p].last_piece; ++k) {
      const Piece& piece = walls.pieces[k];
      FaceCorners corner{};
      for (int e = 0; e < dim; ++e) corner[e] = {piece.corner[e][0], piece.corner[e][1], piece.corner[e][2]};
      std::array<int, 3> low{}, high{};
      for (int d = 0; d < dim; ++d) {
        coord from = corner[0][d], to = from;
        for (int e = 1; e < dim; ++e) {
          from = std::min(from, corner[e][d]);
          to = std::max(to, corner[e][d]);
        }
        low[d] = grid.along(d, from - within);
        high[d] = grid.along(d, to + within);
      }
      std::array<int, 3> c;
      for (c[2] = low[2]; c[2] <= high[2]; ++c[2])
        for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
          for (c[0] = low[0]; c[0] <= high[0]; ++c[0]) {
            auto& list = near[(c[2] * grid.cells[1] + c[1]) * grid.cells[0] + c[0]];
            if (!list.empty() && list.back() == p) continue;
            if (distance_to_face(corner, dim, centre_of(grid, c, dim)) < within) list.push_back(p);
          }
    }
  return near;
}

std::vector<int> panels_of(const Mirror& m, const WallPanels& walls) {
  std::vector<int> panels;
  if (m.joint >= 0) panels = {walls.joints[m.joint].panel[0], walls.joints[m.joint].panel[1]};
  if (m.joint < 0 && m.length > 0) panels = {m.panel};
  for (int e = 0; e < 3 && m.also[e] >= 0; ++e) panels.push_back(m.also[e]);
  return panels;
}

// A corner can be reached where all its panels can.
void bin(MirrorWalls& made, const WallPanels& walls, const GridShape& grid, int dim) {
  const int panels = static_cast<int>(walls.panels.size()), mirrors = static_cast<int>(walls.mirrors.size());
  std::vector<std::vector<int>> corners_of(panels);  // by their lowest panel
  std::vector<std::vector<int>> panels_of_mirror(mirrors);
  for (int k = panels; k < mirrors; ++k) {
    panels_of_mirror[k] = panels_of(walls.mirrors[k], walls);
    corners_of[*std::min_element(panels_of_mirror[k].begin(), panels_of_mirror[k].end())].push_back(k);
  }
  std::vector<int> first{0}, reach;
  for (const auto& near : panels_near(walls, grid, dim)) {
    reach.insert(reach.end(), near.begin(), near.end());
    for (const int p : near)
      for (const int k : corners_of[p])
        if (std::all_of(panels_of_mirror[k].begin(), panels_of_mirror[k].end(),
                        [&](int q) { return std::binary_search(near.begin(), near.end(), q); }))
          reach.push_back(k);
    first.push_back(static_cast<int>(reach.size()));
  }
  for (int k = 0; k < mirrors; ++k) reach.push_back(k);
  first.push_back(static_cast<int>(reach.size()));
  upload(made.first, "greenwater::mirror_first", first);
  upload(made.reach, "greenwater::mirror_reach", reach);
}

template <int Dim>
void set_wall_motion_in(const MirrorWalls& walls, const CornerMotion& motion) {
  const auto panels = walls.panel;
  const auto pieces = walls.piece;
  const CornerMotion go = motion;
  Kokkos::parallel_for(
      "greenwater::wall_motion", Range(0, walls.panels), KOKKOS_LAMBDA(const int k) {
        Panel& panel = panels(k);
        if (panel.body != go.body) return;
        coord velocity[3][3] = {}, acceleration[3][3] = {};
        for (int e = 0; e < Dim; ++e) {
          const int c = go.corner_of_face(Dim * (panel.face - go.first_face) + e);
          for (int d = 0; d < Dim; ++d) {
            velocity[e][d] = go.velocity(c, d);
            acceleration[e][d] = go.acceleration(c, d);
          }
        }
        panel.velocity = linear_field<Dim>(pieces(panel.first_piece), velocity);
        panel.acceleration = linear_field<Dim>(pieces(panel.first_piece), acceleration);
      });
}

}  // namespace

void set_wall_motion(const MirrorWalls& walls, int dim, const CornerMotion& motion) {
  dim == 2 ? set_wall_motion_in<2>(walls, motion) : set_wall_motion_in<3>(walls, motion);
}

void make_mirror_walls(MirrorWalls& made, const WallFaces& faces, const GridShape& grid, coord spacing) {
  if (faces.faces.empty()) return;
  made.tolerance = 1e-9 * spacing;
  const WallPanels walls = find_panels(faces, 1e-6 * spacing);
  made.count = static_cast<int>(walls.mirrors.size());
  made.panels = static_cast<int>(walls.panels.size());
  upload(made.panel, "greenwater::mirror_panels", walls.panels);
  upload(made.piece, "greenwater::mirror_pieces", walls.pieces);
  upload(made.rim, "greenwater::mirror_rims", walls.rims);
  upload(made.joint, "greenwater::mirror_joints", walls.joints);
  upload(made.joint_of_panel, "greenwater::mirror_joint_of_panel", walls.joint_of_panel);
  upload(made.mirror, "greenwater::mirrors", walls.mirrors);
  bin(made, walls, grid, faces.dim);
}

}  // namespace greenwater
