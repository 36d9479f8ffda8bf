#include "explore/stuck/straight_on.h"

#include <algorithm>
#include <cmath>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kTurning = 0.5;  ///< wheels slower than this share of their command are held [-]
constexpr double kCurve = 0.4;    ///< the inner wheels are this much slower than the middle: share of its speed [-]
constexpr double kStraightSpeed = 0.3;  ///< with way on, it slides over what would stop it [m/s]
constexpr double kWay = 0.30;           ///< then all wheels stand elsewhere [m]
constexpr double kTime = 1.5;           ///< [s]
constexpr double kSameSpot = 0.5;       ///< [m]
constexpr double kNotAgain = 60.0;      ///< [s]
constexpr double kClearance = 0.02;     ///< beside the body and before it, where it stops [m]
constexpr double kLag = 0.1;            ///< from a scan to the brake [s]

}  // namespace

bool StraightOn::explains(const StuckWatch::Hold& hold, const Drive& commanded,
                          const std::optional<Drive>& wheels) const {
  if (!hold.stands && !hold.steers_in_vain) return false;
  if (!wheels || commanded.v <= 0.0) return false;
  const double inner = 0.5 * model_.effective_track * std::abs(commanded.w);
  return inner > kCurve * commanded.v && wheels->v > kTurning * commanded.v &&
         std::abs(wheels->w) > kTurning * std::abs(commanded.w);
}

double StraightOn::speed() const { return std::min(kStraightSpeed, model_.max_v); }

bool StraightOn::room(const TPose2D& T_map_base, const Traversable& floor, const std::vector<TPoint2D>& hits) const {
  const double v = speed();
  const double reach = 0.5 * model_.length + 0.5 * v * v / model_.max_accel + v * kLag + kClearance;
  const double aside = 0.5 * model_.width + kClearance;
  const double c = std::cos(T_map_base.phi), s = std::sin(T_map_base.phi);
  for (const TPoint2D& hit : hits) {
    const double x = hit.x - T_map_base.x, y = hit.y - T_map_base.y;
    if (c * x + s * y > 0.0 && c * x + s * y < reach && std::abs(c * y - s * x) < aside) return false;
  }
  const double step = 0.5 * floor.frame().resolution;
  for (double ahead = 0.0; ahead <= reach; ahead += step)
    for (double left = -aside; left <= aside; left += step) {
      const Cell cell =
          floor.cells.cell(TPoint2D{T_map_base.x + ahead * c - left * s, T_map_base.y + ahead * s + left * c});
      if (!floor.cells.inside(cell) || floor.cells[cell] != Occupancy::Free || floor.obstacle[cell] != 0) return false;
    }
  return true;
}

bool StraightOn::worth(const TPose2D& T_map_base, const Traversable& floor, const std::vector<TPoint2D>& hits,
                       Stamp now) const {
  const bool again = std::any_of(tries_.begin(), tries_.end(), [&](const Try& one) {
    return now - one.at < kNotAgain && distance(one.place.p_map(), position(T_map_base)) < kSameSpot;
  });
  return !again && room(T_map_base, floor, hits);
}

void StraightOn::begin(const TPose2D& T_map_base, Stamp now) {
  tries_.erase(std::remove_if(tries_.begin(), tries_.end(), [&](const Try& one) { return now - one.at >= kNotAgain; }),
               tries_.end());
  tries_.push_back({now, AnchoredPoint({now, T_map_base}, position(T_map_base))});
}

void StraightOn::follow(const slam::Mapper& mapper) {
  for (Try& one : tries_) one.place.follow(mapper);
}

std::optional<Drive> StraightOn::drive(const TPose2D& T_map_base, Stamp now) const {
  const Try& this_one = tries_.back();
  if (distance(this_one.place.p_map(), position(T_map_base)) > kWay || now - this_one.at > kTime) return std::nullopt;
  return Drive{speed(), 0.0};
}

}  // namespace rubble::explore
