#pragma once
// The typed case: everything a run needs to know, SI units, every default filled in. Read from a case file by
// read_scene(), the only place that knows the keys; turned into fields and kernels by build.cpp.

#include <cstdint>
#include <string>
#include <vector>

#include "io/case_file.hpp"

namespace greenwater {

/// A vector whose components are numbers or formulas in x, y, z [m] and t [s].
struct VectorFormula {
  Formulas text{"0", "0", "0"};
  Place place;
};

struct BoxCase {  // a tank: walls on its sides but the open ones
  std::string name;
  Place place;
  Point min, max;                 // [m]
  std::vector<std::string> open;  // left right bottom top (3-D: also front back)
};

struct PolylineCase {  // connected straight walls; fluid on either side or on both
  std::string name;
  Place place;
  std::vector<Point> points;  // [m]
  bool closed = false;
};

struct PlateCase {  // a rigid plate that stands on its base, wet on both sides; its free end is open
  std::string name;
  Place place;
  Point base;                        // [m] foot point
  std::string base_side = "centre";  // where the foot point is: upstream (-x face) | centre | downstream
  double height = 0, thickness = 0;  // [m]; thickness 0 is allowed
  double angle = 0;                  // [rad] from the vertical, positive leans downstream (+x)
};

struct FluidCase {
  std::string name;
  Place place;             // of its region
  double density = 1000;   // rho [kg/m^3]
  Point min, max;          // [m] box filled with particles at the cell centres of a lattice of the spacing
  VectorFormula velocity;  // [m/s] initial
};

struct ViscosityCase {
  double kinematic = 0;  // nu [m^2/s]
};

struct CollisionCase {
  double distance = 0.85;    // x spacing
  double restitution = 0.2;  // -
  int sweeps = 5;            // at most, each step
};

struct BodyForceCase {
  VectorFormula acceleration;  // [m/s^2], added to gravity
};

struct PressureCase {
  std::string preconditioner = "jacobi";  // jacobi | none
  std::string weights = "kept";           // kept (beside the rows) | recomputed (a third of the memory)
  double tolerance = 1e-8;                // relative residual
  double absolute_tolerance = 0;          // residual norm [Pa/m^2]; 0 = off
  int max_iterations = 2000;
  std::string on_stall = "fail";   // fail (exit 3) | warn
  std::string source = "density";  // density | divergence
};

struct MpsCase {
  std::string scheme = "classic";
  double spacing = 0;  // l0 [m]
  Place spacing_place;
  std::int64_t expected_particles = 0;  // 0 = not checked
  Place expected_place;
  double time_step = 0;  // dt [s]
  Place time_step_place;
  double cfl_warn = 0.5;
  std::string kernel = "koshizuka_shifted";  // koshizuka_shifted (Eq. 3) | standard (re/r - 1)
  double kernel_shift = 0.05;                // the 0.05 of Eq. 3
  double radius_density = 3.1, radius_gradient = 3.1, radius_laplacian = 3.1;  // x spacing
  double multiplication_coefficient = 1.05;                                    // C on the diagonal
  double relaxation_factor = 1.0;                                              // gamma on the source
  double compressibility = 4.5e-10;  // [1/Pa] of water; keeps closed clusters regular
  double free_surface_ratio = 0.97;  // n < ratio n0 is the surface
  PressureCase pressure;
};

struct ProbeCase {
  std::string name;
  Place place;
  std::string kind;             // wave_front | surface_height | wall_pressure | wall_force | particle_count
  double every_time = 0;        // [s]; 0 = every step
  Point point{};                // wall_pressure: where [m]
  double x = 0;                 // surface_height [m]
  std::string wall;             // wall_force: name of the geometry
  std::string component = "x";  // wall_force: x | y
  Point facing{};               // wall_pressure on a wall: the direction from the wall into the water; zero: not said
  Point min{}, max{};           // particle_count: box; all of the fluid when equal
};

struct OutputCase {
  std::string directory = "runs/{name}";  // {name} {date}
  Place directory_place;
  double every_time = 0;  // frames [s]; 0 = no frames
  int history_every_steps = 20;
  std::string precision = "float32";  // float32 | float64
  std::vector<std::string> paraview{"vtp"};
};

struct Scene {
  std::string name, title, reference;
  int dimension = 2;
  double end = 0;              // [s]
  Point gravity{0, -9.81, 0};  // [m/s^2]
  bool has_domain = false;     // [domain] given: outside it particles are retired
  Point domain_min{}, domain_max{};
  Place domain_place;
  std::vector<BoxCase> boxes;
  std::vector<PolylineCase> polylines;
  std::vector<PlateCase> plates;
  FluidCase fluid;
  MpsCase mps;
  std::vector<ViscosityCase> viscosity;  // each effect: none or one
  std::vector<CollisionCase> collision;
  std::vector<BodyForceCase> body_force;
  OutputCase output;
  std::vector<ProbeCase> probes;
};

/// Reads and checks the case; every key that it does not know, and every value out of range, is a CaseError with
/// `file:line:column`, what is wrong and how to mend it.
Scene read_scene(CaseFile& file);

}  // namespace greenwater
