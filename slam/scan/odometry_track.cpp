#include "slam/scan/odometry_track.h"

#include <algorithm>
#include <cmath>

#include "base/trajectory.h"

namespace rubble::slam {

using mrpt::math::TPose2D;
using robot::Odometry;

namespace {

/// The arc that constant v and w describe in `dt`.
TPose2D arc(double v, double w, double dt) {
  const double turn = w * dt;
  const double half = 0.5 * turn;
  const double chord = v * dt * (std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half);
  return {chord * std::cos(half), chord * std::sin(half), turn};
}

}  // namespace

void OdometryTrack::add(const Odometry& odometry) {
  if (track_.empty() || odometry.stamp > track_.back().stamp) track_.push_back(odometry);
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
