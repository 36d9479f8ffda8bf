#include "scoring/measures/sight_words.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rubble::scoring {
namespace {

constexpr double kPlaceOfWall = 0.1;    // to either side of a wall's middle: what must be known to miss it [m]
constexpr double kFarOff = 0.5;         // distance from which a wall is another one [m]
constexpr double kRaster = 0.5;         // of a cell: what drawing on a raster moves a wall by
constexpr double kLeastRaster = 0.025;  // finer pixels of the same walls are no finer a map [m]
constexpr double kMostRaster = 0.05;    // [m]
constexpr double kThickness = 0.04;     // what a metre of wrong thickness counts as a metre of wrong place

}  // namespace

DrawnOnBlocked::DrawnOnBlocked(const SightLines::Line& line, const Sight& sight, double raster) {
  for (std::size_t i = 0; i < sight.walls.size(); ++i) {
    const Crossing& wall = sight.walls[i];
    const double off = std::max(0.0, std::abs(wall.middle() - line.middle) - raster) +
                       kThickness * std::abs(wall.thickness() - line.thickness);
    const double strength = std::min(1.0, wall.strength / line.strength);
    all += strength;
    const double near = strength * std::clamp(1.0 - off / kFarOff, 0.0, 1.0);
    if (near <= best) continue;
    best = near;
    nearest = i;
  }
}

double DrawnOnBlocked::right() const { return 2.0 * best / std::max(1.0, all) - 1.0; }

double drawn_on_open(const Sight& sight) {
  double all = 0.0;
  for (const Crossing& wall : sight.walls) all += wall.strength;
  return std::min(1.0, all);
}

SightWord word_on_blocked(const SightLines::Line& line, const Sight& sight, double raster) {
  const DrawnOnBlocked drawn(line, sight, raster);
  constexpr double kAsked[] = {-1.0, -0.5, 0.0, 0.5, 1.0};
  double seen = 0.0;
  for (const double side : kAsked) seen += sight.sees(line.middle + side * kPlaceOfWall) ? 1.0 : 0.0;
  const double known = std::max(seen / static_cast<double>(std::size(kAsked)), std::min(1.0, drawn.all));
  return {known, known * drawn.right()};
}

SightWord word_on_open(const SightLines::Line& line, const Sight& sight) {
  const double drawn = drawn_on_open(sight);
  const auto seen = std::count_if(line.doubts.begin(), line.doubts.end(),
                                  [&](float at) { return sight.sees(static_cast<double>(at)); });
  const double open = static_cast<double>(seen) / std::max(1.0, static_cast<double>(line.doubts.size()));
  return {std::max(open, drawn), std::max(-1.0, open - 2.0 * drawn)};
}

double raster_of(const OccupancyGrid& map, SightLines::Credit credit) {
  const double least = credit == SightLines::Credit::Located ? kLeastRaster : 0.0;
  return std::clamp(kRaster * map.resolution(), least, kMostRaster);
}

}  // namespace rubble::scoring
