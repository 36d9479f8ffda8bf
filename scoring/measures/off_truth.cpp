#include "scoring/measures/off_truth.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "base/distance_transform.h"

namespace rubble::scoring {
namespace {

Grid<std::uint8_t> known_with_rim(const OccupancyGrid& truth, double reach) {
  GridFrame frame = truth.frame();
  const int rim = static_cast<int>(std::ceil(reach / frame.resolution)) + 1;
  frame.x0 -= rim * frame.resolution;
  frame.y0 -= rim * frame.resolution;
  frame.width += 2 * rim;
  frame.height += 2 * rim;
  Grid<std::uint8_t> known(frame);
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x) known[{x + rim, y + rim}] = truth[{x, y}] != Occupancy::Unknown ? 1 : 0;
  return known;
}

}  // namespace

OffTruth::OffTruth(const OccupancyGrid& truth, double reach)
    : reach_(reach), away_(distance_transform(known_with_rim(truth, reach), 2.0 * reach)) {}

double OffTruth::operator()(const mrpt::math::TPoint2D& p) const {
  const Cell c = away_.cell(p);
  const double distance = away_.inside(c) ? static_cast<double>(away_[c]) : std::numeric_limits<double>::infinity();
  return distance <= reach_ ? distance : std::numeric_limits<double>::infinity();
}

}  // namespace rubble::scoring
