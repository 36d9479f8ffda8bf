#pragma once

#include <deque>
#include <optional>

#include "robot/felt_tilt.h"
#include "robot/measurements.h"
#include "slam/scan/level_scan.h"

namespace rubble::slam {

struct TiltConfig {
  double filter_hz = 2.0;  ///< low pass on what the accelerometer feels
  double lag = 0.08;       ///< of that filter: a scan's tilt is read so much later [s]
};

/// How scan plane and body were inclined at any stamp of the last while. The accelerometer on the levelled platform
/// feels gravity and motion; what the wheels say about the motion is taken out, the rest is low-passed. The servos'
/// angles off that leave the body's.
class TiltTrack {
 public:
  explicit TiltTrack(const TiltConfig& config) : config_(config) {}

  void add(const robot::Inputs& inputs);
  /// Whether nothing more that arrives could change at(stamp), or what comes is too late to wait for.
  bool ready(Stamp stamp, Stamp now) const;
  /// Nothing where no acceleration lies within a quarter of a second.
  std::optional<ScanTilt> at(Stamp stamp) const;
  void forget_before(Stamp oldest_needed);

 private:
  struct Lean {
    Stamp stamp;
    double pitch;
    double roll;
  };
  void follow(const robot::Odometry& odometry);
  void follow(const robot::Acceleration& acceleration);
  robot::AimState aim_at(Stamp stamp) const;

  const TiltConfig config_;
  robot::FeltTilt felt_;
  std::deque<Lean> leans_;
  std::deque<robot::AimState> aims_;
};

}  // namespace rubble::slam
