#pragma once
// The typed case: everything a run needs to know, SI units, every default filled in. Read from a case file by
// read_scene(), the only place that knows the keys; turned into fields and kernels by build.cpp.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/solid_mesh.hpp"
#include "core/triangle_mesh.hpp"
#include "io/case_file.hpp"

namespace greenwater {

/// A number or a formula in t [s].
struct NumberFormula {
  std::string text = "0";
  Place place;
};

/// A vector whose components are numbers or formulas; which variables they know, stands where it is used.
struct VectorFormula {
  Formulas text{"0", "0", "0"};
  Place place;
};

/// Numbers over time, straight lines between the rows; before the first row and after the last the value stays.
struct TimeTable {
  Place place;                             // where the case names its file
  std::vector<double> time;                // [s], ascending
  std::vector<std::vector<double>> value;  // as many columns as were asked for
};

/// How a geometry moves as a rigid body: x(t) = about + R(rotation(t)) (x(0) - about) + displacement(t). At t = 0 it is
/// where the case puts it; before that it was at rest. Formulas are in t. Of the four translations one at most is there,
/// of the two rotations one at most, of all of them one at least. Motion (app/motion.hpp) evaluates it.
struct MotionCase {
  Place place;
  std::optional<VectorFormula> displacement;  // [m]
  std::optional<TimeTable> displacement_table;
  std::optional<VectorFormula> velocity;  // [m/s], instead of a displacement
  std::optional<TimeTable> velocity_table;
  std::optional<NumberFormula> rotation;  // [rad] round `axis` by the right-hand rule; 2-D: anti-clockwise
  std::optional<TimeTable> rotation_table;
  Point about{};        // [m]
  Point axis{0, 0, 1};  // 3-D only; any length
};

/// What all geometries have.
struct GeometryCase {
  std::string name;
  Place place;
  std::optional<MotionCase> motion;
};

struct BoxCase : GeometryCase {   // a tank: walls on its sides but the open ones
  Point min, max;                 // [m]
  std::vector<std::string> open;  // of box_sides(): left is at min x, front at min y, bottom at min of the last axis
};

struct PolylineCase : GeometryCase {  // 2-D: connected straight walls; fluid on either side or on both
  std::vector<Point> points;          // [m]; typed, or read from a CSV file
  bool closed = false;
};

/// A rigid plate that stands on its base, wet on both sides; its free ends are open. In 3-D it is a rectangle that spans
/// `width` along y, half of it on either side of its base.
struct PlateCase : GeometryCase {
  Point base;                        // [m] foot point
  std::string base_side = "centre";  // where the foot point is: upstream (-x face) | centre | downstream
  double height = 0, thickness = 0;  // [m]; thickness 0 is allowed
  double width = 0;                  // [m] 3-D only
  double angle = 0;                  // [rad] from the vertical, positive leans downstream (+x)
  Place thickness_place;
};

struct MeshCase : GeometryCase {     // 3-D: walls from an STL file
  TriangleMesh mesh;                 // [m], scaled, moved, checked, and repaired where the case allows it
  bool closed = false;               // it has an inside
  std::vector<std::string> repairs;  // what was mended, in words; for the plan
};

struct BallCase {  // in 2-D a disc
  Point centre{};
  double radius = 0;  // [m]
};

struct FluidCase {
  std::string name;
  Place place;                       // of its region
  double density = 1000;             // rho [kg/m^3]
  Point min, max;                    // [m] box filled with particles at the cell centres of a lattice of the spacing
  std::optional<BallCase> ball;      // or: what is closer to a centre than a radius; min, max are then its bounds
  std::string inside;                // or: the inside of this geometry (box, closed polyline, closed mesh) ...
  double level = 0;                  // ... up to this height [m] along the last axis; min, max are then its bounds
  std::vector<std::string> without;  // closed polylines and meshes that are solid
  std::string packing = "lattice";   // lattice | relaxed: as many as have room by volume, spread evenly
  double jitter = 0;                 // x spacing: how far a particle starts from its place along an axis, at most
  VectorFormula velocity;            // [m/s] initial, in x, y, z
};

struct ViscosityCase {
  double kinematic = 0;              // nu [m^2/s]
  std::vector<std::string> no_slip;  // names of the geometries at which water sticks; at others it slips
};

struct CollisionCase {
  double distance = 0.85;    // x spacing
  double restitution = 0.2;  // -
  int sweeps = 5;            // at most, each step
};

struct BodyForceCase {
  VectorFormula acceleration;  // [m/s^2], added to gravity; may use the velocity u, v, w [m/s] beside x, y, z, t
};

struct PressureCase {
  std::string preconditioner = "multigrid";  // multigrid | jacobi | none
  std::string weights = "kept";              // kept (beside the rows) | recomputed (a third of the memory)
  double tolerance = 1e-8;                   // relative residual
  double absolute_tolerance = 0;             // residual norm [Pa/m^2]; 0 = off
  int max_iterations = 2000;
  std::string on_stall = "fail";   // fail (exit 3) | warn
  std::string source = "density";  // density | divergence
};

struct DefaultSchemeCase {     // and of scheme high
  double reference_speed = 0;  // [m/s]; 0: sqrt(|g| H) or the fastest start, whichever is more
  double drift = 0.3;          // x reference speed
  double shifting = 7;         // part of disorder undone while the bulk of the fluid goes one spacing
  double smoothing = 0.4;      // rate x spacing / reference speed
  double surface_smoothing = 0.6;
  double separation = 0.6;     // x spacing
  double diagonal_factor = 1;  // the paper's C, for comparison
};

/// When a step is undone and made again with half of its length.
struct UndoCase {
  int halvings = 8;         // of the step that the flow allows, at most; 0: nothing is kept and nothing looked at
  double displacement = 1;  // x spacing: no particle goes further in a step, but drops that fly by themselves
  double distance = 0.2;    // x spacing: no two run together to less in a step; 0: not looked at
};

struct MpsCase {
  std::string scheme = "default";
  DefaultSchemeCase parts;  // of scheme default
  double spacing = 0;       // l0 [m]
  Place spacing_place;
  std::int64_t expected_particles = 0;  // 0 = not checked
  Place expected_place;
  double time_step = 0;  // dt [s]; where steps adapt, the longest one
  Place time_step_place;
  bool adaptive = false;  // steps as long as the flow allows
  double courant = 0.25;  // adaptive: in a step the fluid moves so many spacings
  double growth = 1.1;    // adaptive: a step is at most so many times the one before
  double cfl_warn = 0.5;
  std::string kernel = "koshizuka_shifted";  // koshizuka_shifted (Eq. 3) | standard (re/r - 1)
  double kernel_shift = 0.05;                // the 0.05 of Eq. 3
  double radius_density = 3.1, radius_gradient = 3.1, radius_laplacian = 3.1;  // x spacing; in 3-D 2.1
  double multiplication_coefficient = 1.05;                                    // C on the diagonal
  double relaxation_factor = 1.0;                                              // gamma on the source
  double compressibility = 4.5e-10;  // [1/Pa] of water; keeps closed clusters regular
  double free_surface_ratio = 0.97;  // n < ratio n0 is the surface
  PressureCase pressure;
  UndoCase undo;
};

/// Where a structure is held, and how what holds it moves.
struct SupportCase {
  Place place;
  std::string part;                           // of the mesh; empty: the nodes in a box
  Point min{}, max{};                         // of that box [m]
  std::vector<int> axes;                      // along which it holds; 0, 1, 2 for x, y, z
  std::optional<NumberFormula> displacement;  // of t [m], along each of the axes; absent: held
  std::string with;                           // or: the geometry that it moves with; empty: none
};

/// What acts on a structure: a field over a part of its surface or over the body, times a factor in time.
struct StructureLoadCase {
  Place place;
  std::string part;        // of the mesh: its facets; of a force, its nodes
  std::string kind;        // pressure | traction | force | acceleration
  NumberFormula pressure;  // in x, y, z [Pa], against the outer side; with `follows` a number
  VectorFormula vector;    // traction in x, y, z [Pa], the force on the whole part [N], or the acceleration of the
                           // body in x, y, z, t [m/s^2]
  bool follows = false;    // the pressure stays normal to the deformed facets
  NumberFormula factor{"1", {}};  // in t
};

/// Rigid walls that a structure may touch.
struct ContactCase {
  Place place;
  std::vector<std::string> walls;  // names of geometries
  double stiffness = 0.02;         // of a node's spring, over its mass and omega_max^2 of the mesh
};

/// An elastic body.
struct StructureCase {
  std::string name, material;
  Place place;
  SolidMesh mesh;                              // [m], free of stress
  std::optional<PlateCase> plate;              // where its mesh was made from one
  double young = 0, poisson = 0, density = 0;  // [Pa], -, [kg/m^3]
  std::string law = "linear";                  // linear | neo_hookean
  std::string element = "incompatible";        // incompatible | full | mean_dilatation
  std::string kinematics = "corotational";     // corotational | small | total_lagrangian
  std::string plane = "strain";                // strain | stress; of a mesh of quadrilaterals
  double depth = 1;                            // of such a mesh [m]
  double time_step = 0;                        // h at most [s]; 0: safety x critical
  Place time_step_place, material_place;
  double safety = 0.9;                   // of the critical step
  double damping = 0;                    // alpha [1/s]
  std::optional<double> damping_ratio;   // instead: of the critical ...
  double damping_frequency = 0;          // ... at this frequency [Hz]; 0: the first one
  bool weight = true;                    // gravity acts
  VectorFormula displacement, velocity;  // [m], [m/s] at the start
  std::vector<SupportCase> supports;
  std::vector<StructureLoadCase> loads;
  std::optional<ContactCase> contact;
  std::vector<std::string> wet;  // parts of the mesh that the fluid touches; in scenes without fluid, none
  Place wet_place;
  bool no_slip = false;  // viscous fluid sticks to it
};

/// How fluid and structures march together.
struct CouplingCase {
  std::string scheme = "default";  // default | aitken | staggered
  std::string load = "transpose";  // transpose | least_squares | kernel_average
  double tolerance = 5e-3;         // of the walls' largest speed
  int max_iterations = 50;         // marches of the structures in one step
  double relaxation = 0.1;         // aitken: the first one
};

struct ProbeCase {
  std::string name;
  Place place;
  std::string kind;             // wave_front | surface_height | wall_pressure | wall_force | particle_count |
                                // structure_displacement | _velocity | _stress | _reaction | _energy | _pressure |
                                // _force
  double every_time = 0;        // [s]; 0 = every step
  Point point{};                // wall_pressure: where [m]
  double x = 0;                 // surface_height [m]
  std::optional<double> y;      // surface_height in 3-D [m]; without it the column is as wide as the scene
  std::string wall;             // wall_force: name of the geometry
  std::string component = "x";  // wall_force: x | y | z
  std::string reading;          // wall_pressure, wall_force: neumann | average; wall_force also: reaction
  Point facing{};               // wall_pressure on a wall: the direction from the wall into the water; zero: not said
  Point min{}, max{};           // particle_count: box; all of the fluid when equal
  std::size_t structure = 0;    // structure_*: which one; its place is `point`
  double height_fraction = 0;   // structure_pressure: where on the plate
  std::string part;             // structure_reaction: of the mesh; empty: all of it
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
  Point gravity{0, -9.81, 0};  // [m/s^2]; default in 3-D: 0, 0, -9.81
  bool has_domain = false;     // [domain] given: outside it particles are retired
  Point domain_min{}, domain_max{};
  std::array<bool, 3> repeats{};  // the domain is a period along these axes
  Place domain_place, repeats_place;
  std::vector<BoxCase> boxes;
  std::vector<PolylineCase> polylines;
  std::vector<PlateCase> plates;
  std::vector<MeshCase> meshes;
  bool has_fluid = true;  // else neither of the next two means anything
  FluidCase fluid;
  MpsCase mps;
  std::vector<StructureCase> structures;
  CouplingCase coupling;                 // with fluid and structures
  double step = 0;                       // without fluid: of the run, in substeps of the structures [s]
  std::vector<ViscosityCase> viscosity;  // each effect: none or one
  std::vector<CollisionCase> collision;
  std::vector<BodyForceCase> body_force;
  OutputCase output;
  std::vector<ProbeCase> probes;
};

/// Whether the probe is of a structure.
bool is_of_structure(const ProbeCase& probe);

/// The sides of a box: left right (x), in 3-D front back (y), bottom top (the last axis).
std::vector<std::string> box_sides(int dimension);

/// The names of all geometries: boxes, polylines, plates, meshes.
std::vector<std::string> wall_names(const Scene& scene);

/// Reads and checks the case; every key that it does not know, and every value out of range, is a CaseError with
/// `file:line:column`, what is wrong and how to mend it.
Scene read_scene(CaseFile& file);

}  // namespace greenwater
