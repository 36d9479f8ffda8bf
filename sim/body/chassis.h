#pragma once

#include <box2d/box2d.h>
#include <mrpt/math/TPose2D.h>

#include <array>
#include <vector>

#include "arenas/model/arena.h"
#include "base/stamp.h"
#include "robot/model.h"
#include "sim/body/attitude.h"
#include "sim/body/drive.h"
#include "sim/body/firmware.h"
#include "sim/body/obstacles.h"
#include "sim/body/servos.h"
#include "sim/body/terrain.h"
#include "sim/body/world_state.h"

namespace rubble::sim {

/// One robot's running gear and body in the physical world. On its own it moves in doubles; where something is near
/// enough to be touched, Box2D moves its body.
class Chassis {
 public:
  Chassis(b2World& box2d, const PlanOrigin& origin, const Terrain& terrain, Obstacles& obstacles,
          const robot::RobotModel& model, const ServoParameters& servos, const mrpt::math::TPose2D& start);

  /// Whether nothing can be touched in the next step.
  bool is_alone() const { return free_way_ > 0.0; }
  /// What the wheels make of the firmware's demand in the next step.
  void drive(double dt);
  void move_freely(double dt);
  /// How far the outline moves at most in the step being made [m].
  double way(double dt) const;
  /// Others came nearer by so much [m].
  void others_moved(double way) { free_way_ -= way; }
  /// Hands pose and velocity to Box2D, before the world's step.
  void enter_box2d();
  /// Takes over what Box2D made of it. `others_move`: something near may move on its own: stay with Box2D.
  void leave_box2d(bool others_move, double dt);
  /// Ground, attitude, servos and time after the move.
  void settle(double dt);

  /// Puts the robot somewhere else, at rest.
  void place(const mrpt::math::TPose2D& pose);

  /// The body's upright sides and top as the lasers of other robots see them.
  void add_shell(std::vector<arenas::Face>& faces) const;

  const robot::RobotModel& model() const { return model_; }
  const WorldState& state() const { return state_; }
  const Drive& wheels() const { return drive_; }
  Firmware& firmware() { return firmware_; }
  Servos& servos() { return servos_; }

 private:
  void find_stops();
  double clearance(double dt) const;
  double most_way(double dt) const;
  HeightBand band() const;

  b2World& box2d_;
  PlanOrigin origin_;
  const Terrain& terrain_;
  Obstacles& obstacles_;
  robot::RobotModel model_;
  b2Body* body_ = nullptr;
  std::uintptr_t body_handle_ = 0;
  Drive drive_;
  Firmware firmware_;
  Servos servos_;
  std::array<Ground, 4> ground_;  ///< under the wheels now
  Attitude attitude_;
  std::vector<Stop> stops_;
  PlanVelocity driven_;        ///< what the wheels want in the step being made
  bool moved_freely_ = false;  ///< Box2D does not know the pose
  double free_way_ = 0.0;      ///< the outline cannot touch anything before it has moved so far [m]
  WorldState state_;
};

}  // namespace rubble::sim
