#pragma once

#include <box2d/box2d.h>

#include <vector>

#include "arenas/model/arena.h"
#include "sim/body/obstacles.h"
#include "sim/body/terrain.h"
#include "sim/body/world_state.h"

namespace rubble::sim {

/// Crumpled paper and loose objects: Box2D circles that slide with friction when pushed and sleep when left alone.
/// Objects stay upright.
class Clutter {
 public:
  Clutter(b2World& world, const PlanOrigin& origin, const Terrain& terrain, Obstacles& obstacles,
          const std::vector<arenas::PaperBall>& balls, const std::vector<arenas::LooseObject>& objects);

  /// Friction of the floor on the moving balls; call before the world's step.
  void brake(double dt);
  /// Takes over where the balls are; call after the world's step. Whether one still moves.
  bool settle();

  const std::vector<Sphere>& spheres() const { return spheres_; }
  const std::vector<Cylinder>& cylinders() const { return cylinders_; }
  std::vector<arenas::PaperBall> balls() const;
  std::vector<arenas::LooseObject> objects() const;

 private:
  void add(b2World& world, const mrpt::math::TPoint2D& position, double radius, double mass);
  void place(std::size_t i);

  PlanOrigin origin_;
  const Terrain& terrain_;
  Obstacles& obstacles_;
  std::vector<arenas::PaperBall> initial_;
  std::vector<arenas::LooseObject> objects_;
  std::vector<b2Body*> bodies_;  ///< of the balls, then of the objects
  std::vector<std::uintptr_t> handles_;
  std::vector<Sphere> spheres_;
  std::vector<Cylinder> cylinders_;
};

}  // namespace rubble::sim
