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
  found_ = {{}, now + kMemory};
  for (const TPoint2D& p : hits)
    if (distance(p, position(T_map_base)) < kReach) found_.points.emplace_back(Anchor{now, T_map_base}, p);
  return true;
}

std::vector<TPoint2D> PathWatch::obstacles(Stamp now) {
  if (now >= found_.forget) found_ = {};
  kept_.erase(std::remove_if(kept_.begin(), kept_.end(), [&](const Found& f) { return now >= f.forget; }), kept_.end());
  std::vector<TPoint2D> points;
  const auto add = [&](const Found& found) {
    for (const AnchoredPoint& p : found.points) points.push_back(p.p_map());
  };
  add(found_);
  std::for_each(kept_.begin(), kept_.end(), add);
  return points;
}

void PathWatch::remember(double seconds, Stamp now) {
  if (!found_.points.empty()) kept_.push_back({found_.points, now + seconds});
}

void PathWatch::follow(const slam::Mapper& mapper) {
  for (AnchoredPoint& p : found_.points) p.follow(mapper);
  for (Found& found : kept_)
    for (AnchoredPoint& p : found.points) p.follow(mapper);
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
