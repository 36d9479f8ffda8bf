#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "arenas/model/arena.h"
#include "robot/model.h"
#include "sim/body/firmware.h"
#include "sim/body/servos.h"
#include "sim/body/world_state.h"

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
  void place(const mrpt::math::TPose2D& pose, std::size_t robot = 0);

  std::size_t robots() const;
  const WorldState& state(std::size_t robot = 0) const;
  const Drive& drive(std::size_t robot = 0) const;
  Firmware& firmware(std::size_t robot = 0);
  Servos& servos(std::size_t robot = 0);

  /// The balls as rays meet them, and as an arena holds them.
  const std::vector<Sphere>& spheres() const;
  std::vector<arenas::PaperBall> balls() const;
  std::vector<arenas::LooseObject> objects() const;

  /// What of the other robots and of loose objects can stand in the way of rays that leave robot `seen_by`.
  std::vector<arenas::Face> moving_faces(std::size_t seen_by, double range) const;

 private:
  struct Inside;  ///< chassis, obstacles and clutter, in Box2D's world
  std::unique_ptr<Inside> inside_;
};

}  // namespace rubble::sim
