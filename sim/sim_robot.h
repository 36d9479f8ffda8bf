#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "arenas/model/arena.h"
#include "base/trajectory.h"
#include "robot/robot.h"

namespace rubble::sim {

/// How the levelling unit fails: from then on it says nothing and holds its servos; its accelerometer says nothing; its
/// servos no longer turn, whatever their pulses say.
enum class LevellingFault { None, Silent, NoAccelerometer, Jammed };

/// "none", "silent", ...: as files call them, in the order of LevellingFault.
const std::vector<std::string>& levelling_faults();

/// Which effects are simulated and how strongly; defaults are the documented hardware.
struct SimConfig {
  double physics_step = 0.01;       ///< [s]
  double range_noise = 1.0;         ///< factor on the scanner's noise model; 0: exact ranges (still 1 mm steps)
  double acceleration_noise = 1.0;  ///< factor on the ADXL202 noise
  double time_limit = 1200.0;       ///< read() ends after this much simulated time [s]
  bool sweep = true;                ///< each beam from the pose at its own time; false: the whole scan at once
  bool microphones = true;          ///< fitted: sound cues, heard all round and badly placed
  bool co2_probe = true;            ///< fitted: CO2 cues, close by
  double battery_wh = 0.0;          ///< it holds so much when it starts; 0: no end of it, and nothing is told [Wh]
  LevellingFault levelling_fault = LevellingFault::None;
  double levelling_fault_from = 60.0;  ///< it fails then [s], ...
  double levelling_fault_tilt = 0.0;   ///< ... once it holds the laser so far from the body's own level [rad]
};

/// The simulated robot in its arena. The truth is offered beside the Robot interface, for the run folder and scoring
/// only.
class SimRobot : public robot::Robot {
 public:
  /// Throws InputError when config.physics_step is not whole milliseconds or does not divide model.tick.
  SimRobot(const arenas::Arena& arena, const robot::RobotModel& model, const SimConfig& config, std::uint64_t seed);
  ~SimRobot() override;

  const robot::RobotModel& model() const override;
  std::optional<robot::Inputs> read() override;
  void command(const robot::Commands& commands) override;

  /// Puts the robot somewhere else in the arena, at rest; its odometry does not notice.
  void place(const mrpt::math::TPose2D& T_arena_base);

  /// True pose of the base in the arena frame, one entry a tick, from stamp 0 on.
  const Trajectory& truth() const;
  /// Where the paper balls lie now (they are pushed about).
  std::vector<arenas::PaperBall> balls() const;
  /// Where the loose objects stand now.
  std::vector<arenas::LooseObject> objects() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::sim
