#include "explore/stuck/straight_on.h"

#include <cmath>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

constexpr double kTurning = 0.5;     ///< wheels slower than this share of their command are held [-]
constexpr double kCurve = 0.4;       ///< the inner wheels are this much slower than the middle: share of its speed [-]
constexpr double kStraightSpeed = 0.3;       ///< with way on, it slides over what would stop it [m/s]
constexpr double kWay = 0.30;        ///< then all wheels stand elsewhere [m]
constexpr double kTime = 1.5;        ///< [s]
constexpr double kSameSpot = 0.5;   ///< [m]
constexpr double kNotAgain = 60.0;   ///< [s]
constexpr double kAhead = 0.10;      ///< looked at before the front [m]
constexpr double kClearance = 0.02;  ///< beside the body [m]

}  // namespace

bool StraightOn::explains(const Drive& commanded, const std::optional<Drive>& wheels) const {
  if (!wheels || commanded.v <= 0.0) return false;
  const double inner = 0.5 * model_.effective_track * std::abs(commanded.w);
  return inner > kCurve * commanded.v && wheels->v > kTurning * commanded.v &&
         std::abs(wheels->w) > kTurning * std::abs(commanded.w);
}

bool StraightOn::room(const TPose2D& T_map_base, const Traversable& floor) const {
  for (double ahead = 0.0; ahead <= 0.5 * model_.length + kAhead; ahead += floor.frame().resolution) {
    const TPoint2D p{T_map_base.x + ahead * std::cos(T_map_base.phi), T_map_base.y + ahead * std::sin(T_map_base.phi)};
    const Cell c = floor.clearance.cell(p);
    if (!floor.clearance.inside(c) || floor.cells[c] != Occupancy::Free) return false;
    const bool below = ahead < 0.5 * model_.length;
    if (static_cast<double>(floor.clearance[c]) < (below ? 0.5 * model_.width + kClearance : kClearance)) return false;
  }
  return true;
}

bool StraightOn::worth(const TPose2D& T_map_base, const Traversable& floor, Stamp now) const {
  const bool again = began_ != Stamp::never() && now - began_ < kNotAgain &&
                     distance(position(from_), position(T_map_base)) < kSameSpot;
  return !again && room(T_map_base, floor);
}

void StraightOn::begin(const TPose2D& T_map_base, Stamp now) {
  from_ = T_map_base;
  began_ = now;
}

std::optional<Drive> StraightOn::drive(const TPose2D& T_map_base, const Traversable& floor, Stamp now) const {
  const bool through = distance(position(from_), position(T_map_base)) > kWay;
  if (through || now - began_ > kTime || !room(T_map_base, floor)) return std::nullopt;
  return Drive{kStraightSpeed, 0.0};
}

}  // namespace rubble::explore
