#pragma once

#include <deque>
#include <optional>

#include "robot/felt_tilt.h"
#include "robot/levelling_watch.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/scan/level_scan.h"

namespace rubble::slam {

struct TiltConfig {
  double filter_hz = 2.0;  ///< low pass on the body's tilt
  double lag = 0.08;       ///< of that filter: a scan's tilt is read so much later [s]
};

/// How scan plane and body were inclined at any stamp of the last while. The accelerometer feels gravity and motion;
/// what the wheels say about the motion before and after is taken out. On the levelled platform it feels the servos as
/// well: their angles off leave the tilt of the body, which changes slowly and is low-passed; the servos' angles, which
/// change fast but are known, are added again at the scan. Servos that jammed are known to stand still.
class TiltTrack {
 public:
  TiltTrack(const robot::RobotModel& model, const TiltConfig& config)
      : config_(config),
        unit_(model),
        place_(robot::accelerometer_place(model)),
        on_platform_(model.accelerometer_mount == robot::AccelerometerMount::Platform) {}

  void add(const robot::Inputs& inputs);
  /// Whether nothing more that arrives could change at(stamp), or what comes is too late to wait for.
  bool ready(Stamp stamp, Stamp now) const;
  /// Nothing where no acceleration lies within a quarter of a second.
  std::optional<ScanTilt> at(Stamp stamp) const;
  /// The body's lean was told before, and is not around `stamp`.
  bool fell_silent(Stamp stamp) const;
  /// Servos hold the scan plane, and hold it still when they say nothing more.
  bool knows_servos() const { return !aims_.empty(); }
  /// Of a body that leans so [rad].
  ScanTilt on_body(double pitch, double roll, Stamp stamp) const;
  void forget_before(Stamp oldest_needed);
  /// Samples that are kept.
  std::size_t size() const { return wheels_.size() + waiting_.size() + leans_.size() + aims_.size(); }

 private:
  /// Of the body.
  struct Lean {
    Stamp stamp;
    double pitch;
    double roll;
  };
  void follow(const robot::AimState& aim);
  void follow(const robot::Acceleration& acceleration);
  robot::WheelMotion motion_at(Stamp stamp) const;
  robot::AimState aim_at(Stamp stamp) const;

  const TiltConfig config_;
  robot::LevellingWatch unit_;
  const mrpt::math::TPoint2D place_;
  const bool on_platform_;
  std::deque<robot::Odometry> wheels_;
  std::deque<robot::Acceleration> waiting_;  ///< for what the wheels say of their time
  std::deque<Lean> leans_;
  std::deque<robot::AimState> aims_;  ///< where the servos are thought to stand
};

}  // namespace rubble::slam
