#include "app/build_structure.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "app/build_walls.hpp"
#include "app/formula.hpp"
#include "app/motion.hpp"
#include "app/scene_shape.hpp"

namespace greenwater {
namespace {

/// A formula of t that can be copied, as std::function wants it.
std::function<double(double)> of_time(const NumberFormula& formula) {
  const auto compiled = std::make_shared<Formula>(formula.text, formula.place, Variables::time);
  return [compiled](double t) { return (*compiled)(0, 0, 0, t); };
}

std::vector<int> nodes_of(const StructureCase& given, const SupportCase& support) {
  if (!support.part.empty()) return find_part(given.mesh, support.part)->nodes;
  std::vector<int> nodes;
  for (int i = 0; i < static_cast<int>(given.mesh.nodes.size()); ++i) {
    const Point& x = given.mesh.nodes[i];
    bool inside = true;
    for (int d = 0; d < 3; ++d) {
      const bool bounded = support.max[d] > support.min[d];  // a 2-D scene says nothing of z
      inside = inside && (!bounded || (x[d] >= support.min[d] && x[d] <= support.max[d]));
    }
    if (inside) nodes.push_back(i);
  }
  require_at(support.place, !nodes.empty(), "no node of \"", given.name, "\" lies in the box of this support");
  return nodes;
}

FieldAt field_of(const NumberFormula& formula) {
  const auto compiled = std::make_shared<Formula>(formula.text, formula.place);
  return [compiled](const Point& x) { return (*compiled)(x[0], x[1], x[2], 0); };
}

VectorAt vector_of(const VectorFormula& formulas) {
  const auto compiled = std::make_shared<std::array<Formula, 3>>(compile(formulas.text, formulas.place));
  return [compiled](const Point& x) {
    Point value{};
    for (std::size_t d = 0; d < 3; ++d) value[d] = (*compiled)[d](x[0], x[1], x[2], 0);
    return value;
  };
}

double area_of(const Solid& solid, const std::vector<Facet>& facets) {
  const Eigen::VectorXd f = traction_pattern(solid, facets, [](const Point&) { return Point{1, 0, 0}; });
  double area = 0;
  for (Eigen::Index i = 0; i < f.size(); i += solid.dim()) area += f[i];
  return area;
}

/// The motion of a geometry, also of one that stands.
std::function<Eigen::Affine3d(double)> motion_of(const Scene& scene, const std::string& name) {
  const GeometryCase& geometry = geometry_named(scene, name);
  if (!geometry.motion) return [](double) { return Eigen::Affine3d::Identity(); };
  const auto motion = std::make_shared<Motion>(*geometry.motion);
  const Eigen::Vector3d about(geometry.motion->about.data()), axis(geometry.motion->axis.data());
  return [motion, about, unit = axis.normalized().eval()](double t) {
    const Point moved = motion->displacement(t);
    return Eigen::Affine3d(Eigen::Translation3d(about + Eigen::Vector3d(moved.data())) *
                           Eigen::AngleAxisd(motion->angle(t), unit) * Eigen::Translation3d(-about));
  };
}

/// Keeps a reference to the solid.
Loads::Acceleration acceleration_of(const Solid& solid, const StructureLoadCase& load) {
  const auto compiled = std::make_shared<std::array<Formula, 3>>(compile(load.vector.text, load.vector.place));
  return [&solid, compiled, factor = of_time(load.factor)](double t, Eigen::VectorXd& acceleration) {
    const double times = factor(t);
    for (Eigen::Index i = 0; i < acceleration.size(); ++i) {
      const Point& x = solid.mesh().nodes[i / solid.dim()];
      acceleration[i] = times * (*compiled)[i % solid.dim()](x[0], x[1], x[2], t);
    }
  };
}

/// The force of a load at factor 1; that of a part without facets is shared evenly by its nodes.
Eigen::VectorXd pattern_of(const Solid& solid, const StructureLoadCase& load) {
  const MeshPart& part = *find_part(solid.mesh(), load.part);
  if (load.kind == "pressure") return pressure_pattern(solid, part.facets, field_of(load.pressure));
  const VectorAt vector = vector_of(load.vector);
  if (load.kind == "traction") return traction_pattern(solid, part.facets, vector);
  if (!part.facets.empty()) {
    const double area = area_of(solid, part.facets);
    return traction_pattern(solid, part.facets, [&](const Point& x) {
      Point force = vector(x);
      for (double& component : force) component /= area;
      return force;
    });
  }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(solid.unknowns());
  for (const int node : part.nodes) {
    Point force = vector(solid.mesh().nodes[node]);
    for (double& component : force) component /= static_cast<double>(part.nodes.size());
    f += nodal_pattern(solid, node, force);
  }
  return f;
}

}  // namespace

std::unique_ptr<Solid> build_solid(const StructureCase& given) {
  Material material{given.young, given.poisson, given.density, Law::linear};
  if (given.law == "neo_hookean") material.law = Law::neo_hookean;
  SolidOptions options;
  if (given.element == "full") options.element = ElementKind::full;
  if (given.element == "mean_dilatation") options.element = ElementKind::mean_dilatation;
  if (given.kinematics == "small") options.kinematics = Kinematics::small;
  if (given.kinematics == "total_lagrangian") options.kinematics = Kinematics::total_lagrangian;
  if (given.plane == "stress") options.plane = Plane::stress;
  options.thickness = given.depth;
  return built_at(given.place, [&] { return std::make_unique<Solid>(given.mesh, material, options); });
}

Supports build_supports(const Scene& scene, const StructureCase& given) {
  Supports supports;
  for (const SupportCase& support : given.supports) {
    const std::vector<int> nodes = nodes_of(given, support);
    if (!support.with.empty()) follow(supports, given.mesh, nodes, motion_of(scene, support.with));
    for (const int axis : support.axes) {
      if (support.displacement)
        move(supports, given.mesh.dim, nodes, axis, of_time(*support.displacement));
      else
        hold(supports, given.mesh.dim, nodes, axis);
    }
  }
  return supports;
}

Loads build_loads(const Scene& scene, const Solid& solid, const StructureCase& given) {
  Loads loads;
  if (given.weight) loads.add(gravity_pattern(solid, scene.gravity));
  for (const StructureLoadCase& load : given.loads) {
    const auto factor = of_time(load.factor);
    const bool steady = Formula(load.factor.text, load.factor.place, Variables::time).constant();
    if (load.kind == "acceleration") {
      loads.add_acceleration(acceleration_of(solid, load));
    } else if (load.follows) {
      const double pressure = Formula(load.pressure.text, load.pressure.place)(0, 0, 0, 0);
      const auto follower = [factor, pressure](double t) { return pressure * factor(t); };
      loads.add_follower(find_part(given.mesh, load.part)->facets, follower);
    } else if (steady) {
      loads.add(factor(0) * pattern_of(solid, load));
    } else {
      loads.add(pattern_of(solid, load), factor);
    }
  }
  return loads;
}

std::optional<Contact> build_contact(const Scene& scene, const Solid& solid, const StructureCase& given) {
  if (!given.contact) return {};
  const auto walls = std::make_shared<WallFaces>(build_walls(scene));
  const std::vector<std::string>& names = given.contact->walls;
  std::vector<std::size_t> touched;
  for (std::size_t f = 0; f < walls->faces.size(); ++f)
    if (std::count(names.begin(), names.end(), walls->bodies[walls->faces[f].body].name) > 0) touched.push_back(f);
  const auto place = [walls, touched, motion = build_motion(scene)](double t, std::vector<FaceCorners>& corners) {
    if (motion) motion(*walls, t);
    corners.clear();
    for (const std::size_t f : touched) corners.push_back(corners_of(walls->faces[f]));
  };
  return built_at(given.contact->place, [&] {
    return Contact(solid, {scene.dimension, place}, given.contact->stiffness);
  });
}

Eigen::VectorXd at_nodes(const Solid& solid, const VectorFormula& formulas) {
  const VectorAt value = vector_of(formulas);
  Eigen::VectorXd all(solid.unknowns());
  for (int i = 0; i < static_cast<int>(solid.mesh().nodes.size()); ++i) {
    const Point at = value(solid.mesh().nodes[i]);
    for (int d = 0; d < solid.dim(); ++d) all[solid.dim() * i + d] = at[d];
  }
  return all;
}

}  // namespace greenwater
