#include "slam/robust/tracking/repeated_scans.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

namespace {

constexpr double kMoved = 0.05;               ///< a scan from there differs, however coarse the ranges [m]
constexpr double kTurned = deg_to_rad(1.0);   ///< [rad]
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

bool RepeatedScans::is_repeated(const robot::LaserScan& scan, const ExpectedMotion& motion) {
  if (!same(scan.ranges, ranges_) || !sees(scan)) {
    exact_ = exact_ || (stood_ >= kStood && !moved_);
    ranges_ = scan.ranges;
    T_first_last_ = {};
    moved_ = false;
    stood_ = 0;
    return false;
  }
  if (motion.told) T_first_last_ = T_first_last_ + motion.T_last_now;
  const double path = length(T_first_last_.x, T_first_last_.y);
  const double turn = std::abs(wrap_angle(T_first_last_.phi));
  stood_ += path < kStill && turn < kStill ? 1 : 0;
  moved_ = moved_ || (!exact_ && (path > kMoved || turn > kTurned));
  count_ += moved_ ? 1 : 0;
  return moved_;
}

}  // namespace rubble::slam
