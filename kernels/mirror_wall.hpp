#pragma once
// Walls by mirror symmetry, without ghost particles: a particle near a wall sees the images of its neighbours, and of
// itself, in the wall. A plate of no thickness is wet on both sides, and the fluid sees itself round its free end.
//
// What sees what is a question of paths. Two particles see each other when the straight line between them meets no face.
// A particle sees the image of another in a face when the path by way of the face, in at the angle it goes out, meets no
// other face: the line to the image passes through the face itself. In a right-angled corner there is one image more,
// by way of both faces. Every such path is the same backwards; and as each pair is always looked at from the one with
// the lower index, both get the same answer to the last bit, which makes the pressure matrix symmetric.

#include "core/wall_faces.hpp"
#include "kernels/cell_grid.hpp"

namespace greenwater {

/// One way to make an image: x' = map x + shift, u' = map u + velocity.
struct Mirror {
  coord map[3][3];
  coord shift[3];
  real velocity[3];      // 2 (u_w . n) n, summed over the faces of a corner [m/s]
  real acceleration[3];  // (a_w . n) n, summed over the faces of a corner [m/s^2]
  coord end[2][3];       // of the face [m]; of a corner: both its point
  coord normal[3];       // of the face; not of a corner
  int face[2];           // the mirrors of a corner's two faces, or -1, -1 for a plain face
  int body;              // named geometry of the face, -1 for a corner
};

/// x' = map x + shift
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec<Dim, coord> image_position(const Mirror& m, const Vec<Dim, coord>& x) {
  Vec<Dim, coord> y;
  for (int d = 0; d < Dim; ++d) {
    y[d] = m.shift[d];
    for (int e = 0; e < Dim; ++e) y[d] += m.map[d][e] * x[e];
  }
  return y;
}

/// u' = map u + velocity: free slip, the image moves with the wall's normal velocity mirrored.
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec<Dim> image_velocity(const Mirror& m, const Vec<Dim>& u) {
  Vec<Dim> v;
  for (int d = 0; d < Dim; ++d) {
    v[d] = m.velocity[d];
    for (int e = 0; e < Dim; ++e) v[d] += static_cast<real>(m.map[d][e]) * u[e];
  }
  return v;
}

/// The mirrors of a scene, and for each cell of the grid those that a particle in it can reach.
struct MirrorWalls {
  int count = 0;                         // 0: no walls, and then nothing here is allocated
  Kokkos::View<Mirror*, Device> mirror;  // faces first, then corners
  IndexField first, reach;               // of cell c: reach(first(c)) ... reach(first(c + 1) - 1), ascending;
                                         // after the last cell: all of them
  coord tolerance = 0;                   // a face's ends are that much longer than they are [m]
};

/// Makes mirrors of the faces and of every right-angled corner between two of them, and bins them into the grid.
/// Throws CaseError when faces meet at another angle.
MirrorWalls make_mirror_walls(const WallFaces& walls, const GridShape& grid, coord spacing);

/// Device view of the mirrors near one cell: the questions of sight.
template <int Dim>
struct Sight {
  Kokkos::View<const Mirror*, Device> mirror;
  Read<IndexField> reach;
  int begin, end;
  coord tolerance;

  KOKKOS_INLINE_FUNCTION static coord side(const Mirror& m, const Vec<Dim, coord>& x) {
    coord s = 0;
    for (int d = 0; d < Dim; ++d) s += m.normal[d] * (x[d] - m.end[0][d]);
    return s;
  }

  KOKKOS_INLINE_FUNCTION bool on_face(const Mirror& m, const Vec<Dim, coord>& q) const {
    coord along_face = 0, length2 = 0;
    for (int d = 0; d < Dim; ++d) {
      const coord t = m.end[1][d] - m.end[0][d];
      along_face += t * (q[d] - m.end[0][d]);
      length2 += t * t;
    }
    const coord length = sqrt(length2);
    return along_face >= -tolerance * length && along_face <= length2 + tolerance * length;
  }

  KOKKOS_INLINE_FUNCTION static bool is_face(const Mirror& m) { return m.face[0] < 0; }

  /// Does the segment from p to q meet the face? Its ends count, so that nothing slips through along an edge.
  KOKKOS_INLINE_FUNCTION bool meets(const Mirror& m, const Vec<Dim, coord>& p, const Vec<Dim, coord>& q) const {
    const coord sp = side(m, p), sq = side(m, q);
    if (sp * sq > 0 || sp == sq) return false;
    return on_face(m, along(p, sp / (sp - sq), difference(q, p)));
  }

  /// Does the segment meet no face but those of the path (which are given by number, or -1)?
  KOKKOS_INLINE_FUNCTION bool open(const Vec<Dim, coord>& p, const Vec<Dim, coord>& q, int one, int two) const {
    for (int k = begin; k < end; ++k) {
      const int f = reach(k);
      if (f == one || f == two || !is_face(mirror(f))) continue;
      if (meets(mirror(f), p, q)) return false;
    }
    return true;
  }

  /// Do a and b see each other?
  KOKKOS_INLINE_FUNCTION bool sees(const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) const {
    return open(a, b, -1, -1);
  }

  /// Does a see the image of b in mirror number k (and b that of a)? a may be b: its own image.
  KOKKOS_INLINE_FUNCTION bool sees_image(int k, const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) const {
    return is_face(mirror(k)) ? by_face(k, a, b) : by_corner(k, a, b);
  }

 private:
  KOKKOS_INLINE_FUNCTION bool by_face(int k, const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) const {
    const Mirror& m = mirror(k);
    const coord sa = side(m, a), sb = side(m, b);
    if (!(sa * sb > 0)) return false;
    const auto q = along(a, sa / (sa + sb), difference(image_position(m, b), a));
    return on_face(m, q) && open(a, q, k, -1) && open(q, b, k, -1);
  }

  // The corner's point is c. The line to the image crosses the plane of face f at |y0| from c and that of g at |x0|;
  // the path meets the faces there, on the particles' side of c, in the order in which the line crosses the planes.
  KOKKOS_INLINE_FUNCTION bool by_corner(int k, const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) const {
    const int kf = mirror(k).face[0], kg = mirror(k).face[1];
    const Mirror &f = mirror(kf), &g = mirror(kg);
    const coord fa = side(f, a), fb = side(f, b), ga = side(g, a), gb = side(g, b);
    if (!(fa * fb > 0) || !(ga * gb > 0)) return false;
    const coord at_f = fa / (fa + fb), at_g = ga / (ga + gb);
    const coord y0 = fabs(ga - at_f * (ga + gb)), x0 = fabs(fa - at_g * (fa + fb));
    Vec<Dim, coord> on_f, on_g;
    for (int d = 0; d < Dim; ++d) {
      on_f[d] = mirror(k).end[0][d] + (ga > 0 ? y0 : -y0) * g.normal[d];
      on_g[d] = mirror(k).end[0][d] + (fa > 0 ? x0 : -x0) * f.normal[d];
    }
    if (!on_face(f, on_f) || !on_face(g, on_g)) return false;
    const auto& q1 = at_f < at_g ? on_f : on_g;
    const auto& q2 = at_f < at_g ? on_g : on_f;
    return open(a, q1, kf, kg) && open(q1, q2, kf, kg) && open(q2, b, kf, kg);
  }
};

/// What can be met within one radius of x; empty without walls. `far`: at any distance.
template <int Dim>
KOKKOS_INLINE_FUNCTION Sight<Dim> sight_from(const MirrorWalls& walls, const GridShape& grid, const Vec<Dim, coord>& x,
                                             bool far = false) {
  if (walls.count == 0) return {walls.mirror, walls.reach, 0, 0, 0};
  const int c = far ? grid.count() : grid.cell_of(x);
  return {walls.mirror, walls.reach, walls.first(c), walls.first(c + 1), walls.tolerance};
}

}  // namespace greenwater
