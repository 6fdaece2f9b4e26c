#include <utility>

#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

// Moves the faces from fluid.time to dt later, with their mean velocity on the way and their acceleration.
void move_faces(const WallMotion& motion, WallFaces& faces, double time, real dt) {
  WallFaces before = faces, now = faces;
  motion(before, time - dt);
  motion(now, time);
  motion(faces, time + dt);
  for (std::size_t f = 0; f < faces.faces.size(); ++f)
    for (int e = 0; e < faces.dim; ++e) {
      WallPoint& point = faces.faces[f].corner[e];
      for (int d = 0; d < faces.dim; ++d) {
        const coord x0 = before.faces[f].corner[e].position[d], x1 = now.faces[f].corner[e].position[d];
        point.velocity[d] = (point.position[d] - x1) / dt;
        point.acceleration[d] = (point.position[d] - 2 * x1 + x0) / (coord(dt) * dt);
      }
    }
}

class MovingWalls : public Effect {
 public:
  explicit MovingWalls(WallMotion motion) : motion_(std::move(motion)) {}
  std::string_view name() const override { return "moving_walls"; }
  Stage stage() const override { return Stage::walls; }

  void apply(Fluid& fluid, real dt) override {
    move_faces(motion_, fluid.faces, fluid.time, dt);
    make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
  }

 private:
  WallMotion motion_;
};

class WallSpeeds : public Effect {
 public:
  explicit WallSpeeds(WallMotion motion) : motion_(std::move(motion)) {}
  std::string_view name() const override { return "moving_walls"; }
  Stage stage() const override { return Stage::wall_speeds; }

  void apply(Fluid& fluid, real dt) override {
    WallFaces moved = fluid.faces;
    move_faces(motion_, moved, fluid.time, dt);
    for (std::size_t f = 0; f < moved.faces.size(); ++f)
      for (int e = 0; e < moved.dim; ++e) {
        WallPoint& point = fluid.faces.faces[f].corner[e];
        point.velocity = moved.faces[f].corner[e].velocity;
        point.acceleration = moved.faces[f].corner[e].acceleration;
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

std::unique_ptr<Effect> make_wall_speeds(WallMotion motion) { return std::make_unique<WallSpeeds>(std::move(motion)); }

}  // namespace greenwater
