#include "explore/motion/path_watch.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kCheckPeriod = 0.2;  ///< [s]
constexpr int kBlockingHits = 3;      ///< fewer may be noise
constexpr double kMemory = 10.0;      ///< [s]
constexpr double kReach = 1.5;        ///< hits farther away are not remembered [m]
constexpr double kAhead = 0.5;        ///< looked ahead beside the braking way [m]
constexpr double kCreepTime = 3.0;    ///< [s]
constexpr double kCreepSpeed = 0.15;  ///< [m/s]
constexpr double kSlowTime = 1.0;     ///< [s]

}  // namespace

bool PathWatch::due(Stamp now) {
  if (now < next_check_) return false;
  next_check_ = now + kCheckPeriod;
  return true;
}

bool PathWatch::check(const PathFollower& follower, const std::vector<TPoint2D>& hits, const TPose2D& T_map_base,
                      double speed, double d_min, Stamp now) {
  const double brake_way = speed * speed / (2.0 * model_.max_accel);
  const double radius = std::min(0.5 * model_.width + 0.03, d_min - 0.04);
  blocked_ = hits_on_path(follower.path(), follower.progress(), kAhead + brake_way, radius, hits, T_map_base, model_) >=
             kBlockingHits;
  if (!blocked_ || now < creep_until_) return false;
  obstacles_.clear();
  std::copy_if(hits.begin(), hits.end(), std::back_inserter(obstacles_), [&](const TPoint2D& p) {
    return distance(p, {T_map_base.x, T_map_base.y}) < kReach;
  });
  forget_ = now + kMemory;
  return true;
}

const std::vector<TPoint2D>& PathWatch::obstacles(Stamp now) {
  if (now >= forget_) obstacles_.clear();
  return obstacles_;
}

void PathWatch::creep(Stamp now) { creep_until_ = now + kCreepTime; }

void PathWatch::slow_down(Stamp now) { slow_until_ = now + kSlowTime; }

robot::Drive PathWatch::limited(robot::Drive drive, Stamp now) const {
  if ((now < creep_until_ || now < slow_until_) && std::abs(drive.v) > kCreepSpeed) {
    drive.w *= kCreepSpeed / drive.v;
    drive.v = kCreepSpeed;
  }
  return drive;
}

}  // namespace rubble::explore
