#include "slam/robust/tracking/repeated_scans.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kMoved = 0.05;               ///< a scan from there differs, however coarse the ranges [m]
constexpr double kTurned = deg_to_rad(1.0);   ///< [rad]
constexpr double kFollows = 0.5;              ///< a match that goes on by so much of the wheels' way is not held back
constexpr double kStill = 1e-4;               ///< wheels that hold move by less [m, rad]
constexpr int kStood = 3;                     ///< repeats on end that are no chance: doubled scans come in pairs
constexpr std::ptrdiff_t kLeastReturns = 15;  ///< few ranges may be the same by chance

/// Bit by bit: beams that could not be measured are the same too.
bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

bool sees(const robot::LaserScan& scan) {
  return std::count_if(scan.ranges.begin(), scan.ranges.end(),
                       [](float range) { return std::isfinite(range) && range > 0.0F; }) >= kLeastReturns;
}

}  // namespace

bool RepeatedScans::is_repeated(const robot::LaserScan& scan, const ExpectedMotion& motion, const TPose2D& found) {
  const TPose2D roll = motion.told ? motion.T_last_now : TPose2D();
  if (!same(scan.ranges, ranges_) || !sees(scan)) {
    exact_ = exact_ || (stood_ >= kStood && !moved_);
    ranges_ = scan.ranges;
    rolled_ = found_ = last_roll_ = {};
    repeats_ = stood_ = 0;
    moved_ = false;
    return false;
  }
  if (repeats_++ > 0) {
    rolled_ = rolled_ + last_roll_;
    found_ = found_ + found;
  }
  last_roll_ = roll;
  const double path = length(rolled_.x, rolled_.y);
  const double turn = std::abs(wrap_angle(rolled_.phi));
  stood_ += path < kStill && turn < kStill ? 1 : 0;
  const bool held_back = (path > kMoved && length(found_.x, found_.y) < kFollows * path) ||
                         (turn > kTurned && std::abs(wrap_angle(found_.phi)) < kFollows * turn);
  moved_ = moved_ || (!exact_ && held_back);
  count_ += moved_ ? 1 : 0;
  return moved_;
}

}  // namespace rubble::slam
