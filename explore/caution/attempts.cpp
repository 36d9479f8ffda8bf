#include "explore/caution/attempts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/planar.h"

namespace rubble::explore {
namespace {

constexpr double kBaseBudget = 20.0;     ///< [s]
constexpr double kSecondsPerMetre = 10;  ///< a quarter of the usual cruise speed

}  // namespace

bool Attempts::overdrawn(const mrpt::math::TPoint2D& target, double cost, double dt, const Anchor& anchor) {
  for (std::size_t i = 0; i < accounts_.size(); ++i) {
    Account& account = accounts_[i];
    if (distance(account.target.p_map(), target) > same_target_) continue;
    // Begun from farther away than before.
    account.budget += kSecondsPerMetre * std::max(0.0, cost - account.cost) - dt;
    account.cost = std::max(account.cost, cost);
    if (account.budget >= 0.0) return false;
    accounts_.erase(accounts_.begin() + static_cast<std::ptrdiff_t>(i));
    return true;
  }
  accounts_.push_back({{anchor, target}, kBaseBudget + kSecondsPerMetre * cost - dt, cost});
  return false;
}

bool Attempts::turned_away(const mrpt::math::TPoint2D& target) {
  for (Account& account : accounts_)
    if (distance(account.target.p_map(), target) <= same_target_) return std::exchange(account.turned_away, true);
  return false;
}

void Attempts::follow(const slam::Mapper& mapper) {
  for (Account& account : accounts_) account.target.follow(mapper);
}

}  // namespace rubble::explore
