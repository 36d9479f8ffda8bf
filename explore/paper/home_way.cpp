#include "explore/paper/home_way.h"

#include <algorithm>
#include <limits>

namespace rubble::explore {
namespace {

constexpr double kMeasured = 4.0;             ///< the way home is measured this often [s]
constexpr double kUsualSpeed = 0.22;          ///< turns and stops included, until the robot's own is known [m/s]
constexpr double kSlowest = 0.08;             ///< [m/s]
constexpr double kUsualTime = 60.0;           ///< the usual speed counts as if driven for so long [s]
constexpr double kSpare = 1.4;                ///< the way may take so much longer than the mean speed says
constexpr double kHurry = 1.2, kLook = 10.0;  ///< the same where it hurries, and what looking around takes [s]
constexpr double kSpareShare = 0.125, kLeastSpare = 12.0, kMostSpare = 25.0;  ///< share of the limit, and within [s]

}  // namespace

double HomeWay::spare_time() const { return std::clamp(kSpareShare * time_limit_, kLeastSpare, kMostSpare); }

void HomeWay::moved(double way, double dt, bool driving) {
  if (!driving) return;
  way_ += way;
  time_ += dt;
}

bool HomeWay::due(Stamp now) {
  if (time_limit_ <= 0.0 || now < next_) return false;
  next_ = now + kMeasured;
  return true;
}

double HomeWay::left(Stamp now) const {
  if (time_limit_ <= 0.0 || start_ == Stamp::never()) return std::numeric_limits<double>::infinity();
  return time_limit_ - (now - start_);
}

double HomeWay::speed() const { return std::max(kSlowest, (way_ + kUsualSpeed * kUsualTime) / (time_ + kUsualTime)); }

bool HomeWay::must_turn_back(double way_home, Stamp now) const {
  return left(now) < kSpare * way_home / speed() + spare_time();
}

bool HomeWay::hurries(double way_left, Stamp now) const { return left(now) < kHurry * way_left / speed() + kLook; }

}  // namespace rubble::explore
