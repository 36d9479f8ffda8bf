#include "explore/caution/left_alone.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/planar.h"

namespace rubble::explore {
namespace {

constexpr double kBarRadius = 0.60;  ///< [m]
constexpr double kBarTime = 60.0;    ///< for the first failure [s]
constexpr double kBarPerMetre = 10;  ///< of the way there, where that is longer [s/m]
constexpr int kMostDoublings = 6;

}  // namespace

void LeftAlone::bar(const mrpt::math::TPoint2D& target, const Anchor& anchor, double cost) {
  const int times = std::min(blacklist_.times_barred(target), kMostDoublings);
  blacklist_.bar({anchor, target}, kBarRadius,
                 anchor.stamp + std::max(kBarTime, kBarPerMetre * cost) * std::ldexp(1.0, times));
}

void LeftAlone::bar_for_good(const mrpt::math::TPoint2D& target, const Anchor& anchor) {
  blacklist_.bar_for_good({anchor, target}, kBarRadius);
}

bool LeftAlone::feel(const Anchor& anchor, bool behind, const robot::RobotModel& model, const OccupancyGrid& known,
                     const Trail& trail, bool sure) {
  return felt_.feel(anchor, behind, model, pallets(anchor, known), trail.points(), &known, sure);
}

std::optional<PalletGrid> LeftAlone::pallets(const Anchor& anchor, const OccupancyGrid& known) const {
  if (config_.pallet <= 0.0) return std::nullopt;
  return find_pallets(known, config_.pallet, position(anchor.T_map_base));
}

void LeftAlone::not_got_free(const Anchor& anchor, const OccupancyGrid& known) {
  if (const auto grid = pallets(anchor, known)) felt_.not_got_free(anchor, *grid);
}

bool LeftAlone::pardon(Stamp now) {
  const bool targets = blacklist_.pardon(now);
  const bool things = felt_.pardon(now);
  return targets || things;
}

bool LeftAlone::pardon_all(Stamp now) {
  const bool targets = blacklist_.pardon_all(now);
  const bool things = felt_.pardon(now);
  return targets || things;
}

}  // namespace rubble::explore
