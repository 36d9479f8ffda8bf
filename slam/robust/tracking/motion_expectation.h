#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <optional>

#include "robot/measurements.h"
#include "slam/robust/tracking/local_tracker.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/odometry_track.h"

namespace rubble::slam {

/// Stamps closer than any scanner's say the order, not how long it took [s].
constexpr double kNoDuration = 1e-3;

/// How the robot is expected to have moved from scan to scan: by its odometry as far as that can be true, else as the
/// last scans moved on.
class MotionExpectation {
 public:
  /// scan_period: the scanner's own [s].
  explicit MotionExpectation(double scan_period) : scan_period_(scan_period) {}

  /// Takes a report; one with numbers that are none, or from the future, is ignored.
  void hear(const robot::Odometry& report, Stamp now);
  /// Call after the reports of a tick: odometry that begins only after the first scan is taken from where it begins.
  void begin_late();
  const OdometryTrack& odometry() const { return odometry_; }

  /// What odometry says of the motion up to a scan; how the motion would go on where that cannot be true or nothing was
  /// reported. Before the first scan: no motion.
  ExpectedMotion expect(const robot::LaserScan& scan);
  /// How the base moved during a sweep, given that.
  std::optional<SweepMotion> sweep(const robot::LaserScan& scan, const ExpectedMotion& motion) const;
  /// How the base moved during a sweep if it moved by `motion` in `time` [s].
  std::optional<SweepMotion> sweep_at(const robot::LaserScan& scan, const mrpt::math::TPose2D& motion,
                                      double time) const;

  /// The step from scan to scan as it was found, in `time` [s]; whether it contradicts what odometry said.
  void found(const mrpt::math::TPose2D& step, double time, bool contradicted);
  /// That of the last scan.
  const mrpt::math::TPose2D& last_step() const { return last_step_; }
  /// A scan was dealt with.
  void scan_taken(Stamp reference);
  /// By odometry, from the last scan to `stamp`.
  mrpt::math::TPose2D since_scan(Stamp stamp) const;
  /// The same without steps that no robot makes, for those who cannot wait for what the next scan says.
  mrpt::math::TPose2D believed_since_scan(Stamp stamp) const;
  bool hears_odometry() const { return T_odom_scan_.has_value(); }
  /// Forgets reports that no question about `oldest_needed` or later can touch.
  void forget_before(Stamp oldest_needed);

  std::uint64_t jumps() const { return jumps_; }    ///< steps of the odometry that no robot can make
  std::uint64_t silent() const { return silent_; }  ///< scans without odometry around them
  /// Whether the scans of the whole drive turned the other way than the wheels told: a laser that hangs upside down
  /// unknown to the mapper, or encoders exchanged. The map of such a drive may look like one and is none.
  bool turns_against() const;

 private:
  bool jumps_within(const robot::LaserScan& scan) const;
  bool jumps_between_reports(Stamp reference) const;
  std::optional<mrpt::math::TPose2D> carried(double time) const;
  double in_vain(double time) const;

  const double scan_period_;  ///< [s]
  OdometryTrack odometry_;
  OdometryTrack without_jumps_;  ///< the same as if steps that no robot makes had not been
  Stamp last_jump_ = Stamp::never();
  std::optional<Stamp> last_scan_;
  std::optional<mrpt::math::TPose2D> T_odom_scan_;  ///< at the last scan; nothing while no odometry has come
  mrpt::math::TPose2D T_smooth_scan_;               ///< the same in without_jumps_
  /// Whether odometry was silent at the last scan, once what was said is forgotten.
  std::optional<bool> silent_at_scan_;
  mrpt::math::TPose2D last_step_;  ///< between the last two scans, as matched
  double last_step_time_ = 0.0;    ///< [s]
  bool leapt_ = false;             ///< the odometry, at the last scan, which may lie in the middle of that
  double doubt_ = 0.0;             ///< of the odometry, by what the last scans said of it
  double turn_now_ = 0.0;          ///< told since the last scan [rad]
  // Of the turns of the last moments, fading, by their rates, so that it does not matter how often a scanner scans.
  double turns_told_ = 0.0;   ///< squares [rad^2/s]
  double turns_found_ = 0.0;  ///< products with what the scans said of them [rad^2/s]
  // Of the whole drive.
  double all_turns_ = 0.0;        ///< told [rad]
  double all_turns_told_ = 0.0;   ///< squares [rad^2]
  double all_turns_found_ = 0.0;  ///< products with what the scans said of them [rad^2]
  std::uint64_t jumps_ = 0;
  std::uint64_t silent_ = 0;
};

}  // namespace rubble::slam
