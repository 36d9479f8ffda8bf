#pragma once

#include <mrpt/math/TPose2D.h>

#include <box2d/box2d.h>

#include <array>
#include <memory>
#include <vector>

#include "arenas/arena.h"
#include "base/stamp.h"
#include "robot/model.h"
#include "sim/attitude.h"
#include "sim/clutter.h"
#include "sim/drive.h"
#include "sim/firmware.h"
#include "sim/obstacles.h"
#include "sim/servos.h"
#include "sim/terrain.h"

namespace rubble::sim {

/// Where everything of the robot is at one instant.
struct WorldState {
  Stamp stamp;
  mrpt::math::TPose2D pose;  ///< of the base in the arena, plan view
  Stance stance;
  robot::LaserAim aim;  ///< true servo angles
  PlanVelocity velocity;
};

/// The physical world: robot, floor, walls and clutter, advanced in fixed steps. Nothing in it is random. Box2D works
/// only where something is near enough to be touched; on its own the robot moves in doubles.
class World {
 public:
  World(const arenas::Arena& arena, const robot::RobotModel& model, const ServoParameters& servos, double step);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void step();

  const WorldState& state() const { return state_; }
  const Terrain& terrain() const { return terrain_; }
  const Clutter& clutter() const { return *clutter_; }
  const Drive& drive() const { return drive_; }
  Firmware& firmware() { return firmware_; }
  Servos& servos() { return servos_; }

 private:
  void find_stops();
  void move_freely(const PlanVelocity& velocity);
  void move_among_others(const PlanVelocity& velocity);
  double clearance() const;
  HeightBand robot_band() const;

  robot::RobotModel model_;
  double dt_;
  PlanOrigin origin_;
  Terrain terrain_;
  b2World box2d_;
  Obstacles obstacles_;
  b2Body* body_ = nullptr;
  std::uintptr_t body_handle_ = 0;
  std::unique_ptr<Clutter> clutter_;
  Drive drive_;
  Firmware firmware_;
  Servos servos_;
  std::array<Ground, 4> ground_;  ///< under the wheels now
  Attitude attitude_;
  std::vector<Stop> stops_;
  bool moved_freely_ = false;  ///< Box2D does not know the pose
  double free_way_ = 0.0;      ///< the outline cannot touch anything before it has moved so far [m]
  WorldState state_;
};

}  // namespace rubble::sim
