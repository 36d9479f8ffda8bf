#pragma once

#include <box2d/box2d.h>
#include <mrpt/math/TPose2D.h>

#include <memory>
#include <vector>

#include "arenas/model/arena.h"
#include "robot/model.h"
#include "sim/body/chassis.h"
#include "sim/body/clutter.h"
#include "sim/body/obstacles.h"
#include "sim/body/servos.h"
#include "sim/body/terrain.h"

namespace rubble::sim {

/// A robot that enters the world.
struct Entrant {
  robot::RobotModel model;
  ServoParameters servos;
  mrpt::math::TPose2D start;
};

/// The physical world: robots, floor, walls and clutter, advanced in fixed steps. Nothing in it is random, and robots
/// are moved in the order they entered. Box2D works only where something is near enough to be touched; on their own
/// robots move in doubles.
class World {
 public:
  World(const arenas::Arena& arena, const robot::RobotModel& model, const ServoParameters& servos, double step);
  /// Several robots, at least one; how high a step can be climbed is the first one's.
  World(const arenas::Arena& arena, const std::vector<Entrant>& entrants, double step);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void step();

  /// Puts a robot somewhere else, at rest.
  void place(const mrpt::math::TPose2D& pose, std::size_t robot = 0) { chassis_[robot]->place(pose); }

  std::size_t robots() const { return chassis_.size(); }
  const WorldState& state(std::size_t robot = 0) const { return chassis_[robot]->state(); }
  const Drive& drive(std::size_t robot = 0) const { return chassis_[robot]->wheels(); }
  Firmware& firmware(std::size_t robot = 0) { return chassis_[robot]->firmware(); }
  Servos& servos(std::size_t robot = 0) { return chassis_[robot]->servos(); }
  const Terrain& terrain() const { return terrain_; }
  const Clutter& clutter() const { return *clutter_; }

  /// What of the other robots and of loose objects can stand in the way of rays that leave robot `seen_by`.
  std::vector<arenas::Face> moving_faces(std::size_t seen_by, double range) const;

 private:
  void move_freely();
  void move_among_others();

  double dt_;
  PlanOrigin origin_;
  Terrain terrain_;
  b2World box2d_;
  Obstacles obstacles_;
  std::vector<std::unique_ptr<Chassis>> chassis_;
  std::unique_ptr<Clutter> clutter_;
};

}  // namespace rubble::sim
