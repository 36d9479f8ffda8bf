#pragma once

#include <mrpt/math/TPose2D.h>

#include <deque>

#include "robot/measurements.h"

namespace rubble::slam {

/// Keeps the odometry of the last while and answers for any stamp: "the a-priori robot pose at that moment is
/// interpolated by the odometry data reported right before and right after the LRF measurement" (section III.B).
class OdometryTrack {
 public:
  /// Takes the next odometry; one that is not younger than the newest is ignored.
  void add(const robot::Odometry& odometry);

  bool empty() const { return track_.empty(); }
  /// Stamp of the newest odometry; Stamp::never() when empty.
  Stamp newest() const { return track_.empty() ? Stamp::never() : track_.back().stamp; }

  /// T_odom_base at `stamp`: linear in x and y, shortest way round in the angle; before the oldest: the oldest pose;
  /// after the newest: carried on by its v and w for at most `kMaxExtrapolation`. Empty track: the identity.
  mrpt::math::TPose2D pose_at(Stamp stamp) const;
  /// Motion of the base from `from` to `to`, in the base frame at `from`: T_from_to.
  mrpt::math::TPose2D between(Stamp from, Stamp to) const;
  /// Calls `use(step, time)` with each step from one report to the next that lies between `from` and `to`, or reaches
  /// in there: T_before_after, and how long it took [s].
  template <class Use>
  void for_steps(Stamp from, Stamp to, const Use& use) const;
  /// Whether nothing was reported about the motion at `stamp`: it lies in a gap much longer than the odometry's usual
  /// interval (and kShortestGap), and not next to a report.
  bool silent_at(Stamp stamp) const;
  /// Forgets what no question about `oldest_needed` or later can touch.
  void forget_before(Stamp oldest_needed);

  std::size_t size() const { return track_.size(); }

  static constexpr double kMaxExtrapolation = 0.2;  ///< [s]
  static constexpr double kShortestGap = 0.4;       ///< [s]

 private:
  std::deque<robot::Odometry> track_;
  double usual_interval_ = 0.0;  ///< [s]
};

template <class Use>
void OdometryTrack::for_steps(Stamp from, Stamp to, const Use& use) const {
  for (std::size_t i = track_.size(); i > 1 && from < track_[i - 1].stamp; --i) {
    const robot::Odometry& before = track_[i - 2];
    const robot::Odometry& after = track_[i - 1];
    if (before.stamp < to) use(after.pose - before.pose, after.stamp - before.stamp);
  }
}

}  // namespace rubble::slam
