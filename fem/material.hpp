#pragma once
// What a structure is made of.

namespace greenwater {

enum class Law {
  linear,      // S = lambda tr(E) I + 2 mu E: Hooke, and in large displacement St. Venant-Kirchhoff
  neo_hookean  // S = mu (I - C^-1) + lambda ln(J) C^-1: stays stiff in compression
};

struct Material {
  double young = 0;    // E    [Pa]
  double poisson = 0;  // nu   [-]
  double density = 0;  // rho  [kg/m3]
  Law law = Law::linear;
};

/// Lame's constants [Pa].
struct Lame {
  double lambda = 0;
  double mu = 0;
};

/// Throws CaseError for a stiffness or density that is not positive and for nu outside (-1, 0.5).
void check(const Material& material);

Lame lame(const Material& material);

/// Those for strains in the plane, the stress across it being zero.
Lame lame_plane_stress(const Material& material);

}  // namespace greenwater
