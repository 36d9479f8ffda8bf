#include "slam/calibration/wheel_track.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

/// Cubic through b and c whose slopes there follow the neighbours a and d (Catmull-Rom for uneven times); `u` of 0
/// gives b, 1 gives c. `ab`, `bc`, `cd`: times between them; 0 where there is no neighbour.
double smooth(double a, double b, double c, double d, double ab, double bc, double cd, double u) {
  const double straight = (c - b) / bc;
  const double first = ab > 0.0 ? (c - a) / (ab + bc) : straight;
  const double last = cd > 0.0 ? (d - b) / (bc + cd) : straight;
  const double v = 1.0 - u;
  return v * v * (1.0 + 2.0 * u) * b + u * u * (3.0 - 2.0 * u) * c + u * v * bc * (v * first - u * last);
}

}  // namespace

void WheelTrack::add(const robot::Odometry& odometry) {
  if (!reports_.empty() && odometry.stamp <= reports_.back().stamp) return;
  reports_.push_back(odometry);
  const TPose2D step = poses_.empty() ? TPose2D{} : odometry.pose - reports_[reports_.size() - 2].pose;
  TPose2D pose = poses_.empty() ? odometry.pose : poses_.back() + step;
  if (!poses_.empty()) pose.phi = poses_.back().phi + wrap_angle(step.phi);
  distance_ += length(step.x, step.y);
  turn_ += std::abs(wrap_angle(step.phi));
  poses_.push_back(pose);
}

void WheelTrack::scale(double distance, double turn) {
  distance_ = turn_ = 0.0;
  for (std::size_t i = 1; i < reports_.size(); ++i) {
    const TPose2D step = reports_[i].pose - reports_[i - 1].pose;
    const double dphi = turn * wrap_angle(step.phi);
    const TPose2D& before = poses_[i - 1];
    poses_[i] = before + TPose2D{distance * step.x, distance * step.y, 0.0};
    poses_[i].phi = before.phi + dphi;
    distance_ += distance * length(step.x, step.y);
    turn_ += std::abs(dphi);
  }
}

bool WheelTrack::covers(Stamp stamp) const {
  return !reports_.empty() && reports_.front().stamp <= stamp && stamp <= reports_.back().stamp;
}

double WheelTrack::gap_at(Stamp stamp) const {
  const std::size_t after = after_or_at(stamp);
  return after == 0 ? 0.0 : reports_[after].stamp - reports_[after - 1].stamp;
}

/// The first report at `stamp` or after it.
std::size_t WheelTrack::after_or_at(Stamp stamp) const {
  const auto after = std::lower_bound(reports_.begin(), reports_.end(), stamp,
                                      [](const robot::Odometry& o, Stamp s) { return o.stamp < s; });
  return static_cast<std::size_t>(after - reports_.begin());
}

TPose2D WheelTrack::pose_at(Stamp stamp) const {
  const std::size_t c = after_or_at(stamp);
  if (c == 0) return poses_.empty() ? TPose2D{} : poses_.front();
  if (c == reports_.size()) return poses_.back();
  const std::size_t b = c - 1;
  const std::size_t a = b > 0 ? b - 1 : b;
  const std::size_t d = c + 1 < reports_.size() ? c + 1 : c;
  const auto time = [this](std::size_t i, std::size_t j) { return reports_[j].stamp - reports_[i].stamp; };
  const double u = (stamp - reports_[b].stamp) / time(b, c);
  const auto along = [&](double TPose2D::*part) {
    return smooth(poses_[a].*part, poses_[b].*part, poses_[c].*part, poses_[d].*part, time(a, b), time(b, c),
                  time(c, d), u);
  };
  TPose2D pose;
  pose.x = along(&TPose2D::x);
  pose.y = along(&TPose2D::y);
  pose.phi = along(&TPose2D::phi);
  return pose;
}

TPose2D WheelTrack::between(Stamp from, Stamp to) const { return pose_at(to) - pose_at(from); }

}  // namespace rubble::slam
