#include <utility>

#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

class MovingWalls : public Effect {
 public:
  explicit MovingWalls(WallMotion motion) : motion_(std::move(motion)) {}
  std::string_view name() const override { return "moving_walls"; }
  Stage stage() const override { return Stage::walls; }

  void apply(Fluid& fluid, real dt) override {
    WallFaces before = fluid.faces, now = fluid.faces;
    motion_(before, fluid.time - dt);
    motion_(now, fluid.time);
    motion_(fluid.faces, fluid.time + dt);
    for (std::size_t f = 0; f < fluid.faces.faces.size(); ++f)
      for (int e = 0; e < fluid.faces.dim; ++e) {
        WallPoint& point = fluid.faces.faces[f].corner[e];
        for (int d = 0; d < fluid.faces.dim; ++d) {
          const coord x0 = before.faces[f].corner[e].position[d], x1 = now.faces[f].corner[e].position[d];
          point.velocity[d] = (point.position[d] - x1) / dt;
          point.acceleration[d] = (point.position[d] - 2 * x1 + x0) / (coord(dt) * dt);
        }
      }
    make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
  }

 private:
  WallMotion motion_;
};

}  // namespace

std::unique_ptr<Effect> make_moving_walls(WallMotion motion) {
  return std::make_unique<MovingWalls>(std::move(motion));
}

}  // namespace greenwater
