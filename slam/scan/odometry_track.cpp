#include "slam/scan/odometry_track.h"

#include <algorithm>
#include <cmath>

#include "base/trajectory.h"

namespace rubble::slam {

using mrpt::math::TPose2D;
using robot::Odometry;

namespace {

constexpr double kGapOfIntervals = 4.0;  ///< an interval so many times the usual one is a gap
constexpr double kLearning = 0.05;       ///< weight of a new interval in the usual one

/// The arc that constant v and w describe in `dt`.
TPose2D arc(double v, double w, double dt) {
  const double turn = w * dt;
  const double half = 0.5 * turn;
  const double chord = v * dt * (std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half);
  return {chord * std::cos(half), chord * std::sin(half), turn};
}

}  // namespace

void OdometryTrack::add(const Odometry& odometry) {
  if (!track_.empty() && odometry.stamp <= track_.back().stamp) return;
  if (!track_.empty()) {
    const double interval = odometry.stamp - track_.back().stamp;
    const bool first = usual_interval_ <= 0.0;
    usual_interval_ +=
        (first ? 1.0 : kLearning) * (std::min(interval, first ? 1.0 : 4.0 * usual_interval_) - usual_interval_);
  }
  track_.push_back(odometry);
}

bool OdometryTrack::silent_at(Stamp stamp) const {
  if (track_.empty()) return true;
  const double longest = std::max(kShortestGap, kGapOfIntervals * usual_interval_);
  const double close = 0.25 * longest;
  if (stamp <= track_.front().stamp) return track_.front().stamp - stamp > longest;
  if (stamp >= track_.back().stamp) return stamp - track_.back().stamp > longest;
  const auto after = std::lower_bound(track_.begin(), track_.end(), stamp,
                                      [](const Odometry& odometry, Stamp s) { return odometry.stamp < s; });
  const auto before = after - 1;
  return after->stamp - before->stamp > longest && after->stamp - stamp > close && stamp - before->stamp > close;
}

TPose2D OdometryTrack::pose_at(Stamp stamp) const {
  if (track_.empty()) return {};
  const Odometry& newest = track_.back();
  if (stamp >= newest.stamp) {
    const double ahead = std::min(stamp - newest.stamp, kMaxExtrapolation);
    return newest.pose + arc(newest.v, newest.w, ahead);
  }
  if (stamp <= track_.front().stamp) return track_.front().pose;
  const auto after = std::upper_bound(track_.begin(), track_.end(), stamp,
                                      [](Stamp s, const Odometry& odometry) { return s < odometry.stamp; });
  const auto before = after - 1;
  const double u = (stamp - before->stamp) / (after->stamp - before->stamp);
  return interpolate(before->pose, after->pose, u);
}

TPose2D OdometryTrack::between(Stamp from, Stamp to) const { return pose_at(to) - pose_at(from); }

void OdometryTrack::forget_before(Stamp oldest_needed) {
  while (track_.size() > 2 && track_[1].stamp <= oldest_needed) track_.pop_front();
}

}  // namespace rubble::slam
