#pragma once

#include <cstdint>
#include <vector>

#include "arenas/model/arena.h"
#include "base/trajectory.h"
#include "robot/measurements.h"
#include "sim/accelerometer.h"
#include "sim/battery.h"
#include "sim/body/world_state.h"
#include "sim/laser/laser.h"
#include "sim/sim_robot.h"
#include "sim/victim_sensor.h"

namespace rubble::sim {

class World;

/// Something that happens every `period`, counted in nanoseconds so that it never drifts.
struct Clock {
  explicit Clock(double period, double offset = 0.0)
      : period_ns(Stamp::from_seconds(period).ns), next(Stamp::from_seconds(offset)) {}
  bool due(Stamp now) const { return next <= now; }
  void advance() { next.ns += period_ns; }
  std::int64_t period_ns;
  Stamp next;
};

/// The sensors of one robot in the world, and its true trajectory.
class Rig {
 public:
  /// `index`: which of the world's robots.
  Rig(const arenas::Arena& arena, const robot::RobotModel& model, const SimConfig& config, const World& world,
      std::size_t index, std::uint64_t seed);

  /// After a step of the world: what arrives now is added to `inputs`.
  void follow(World& world, robot::Inputs& inputs);
  /// What arrives at the very start.
  void measure(World& world, robot::Inputs& inputs);
  /// The tick is over: what was told the robot during it is in `inputs`, too.
  void finish(Stamp end, const World& world, robot::Inputs& inputs);
  /// What the robot is told for the ticks to come.
  void command(const robot::Commands& commands, World& world);

  const robot::RobotModel& model() const { return model_; }
  const Trajectory& truth() const { return truth_; }

 private:
  void forget_old_states();
  void fail_in_time(World& world);
  void draw_from_battery(World& world);
  bool has_current() const { return config_.battery_wh <= 0.0 || !battery_.empty(); }

  std::size_t index_;
  robot::RobotModel model_;
  SimConfig config_;
  Laser laser_;
  Accelerometer accelerometer_;
  VictimSensor victims_;
  Clock odometry_clock_;
  Clock unit_clock_;
  Clock victim_clock_;
  Battery battery_;
  Clock battery_clock_;
  Clock rotor_clock_;  ///< next: the zero of the sweep that is delivered next
  std::vector<WorldState> states_;
  Trajectory truth_;
  robot::Commands in_force_;
  LevellingFault fault_ = LevellingFault::None;  ///< of the levelling unit, once it has happened
};

/// Throws InputError unless the physics step is whole milliseconds and divides the robot's tick.
void check_step(const SimConfig& config, const robot::RobotModel& model);

}  // namespace rubble::sim
