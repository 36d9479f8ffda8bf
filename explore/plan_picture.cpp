#include "explore/plan_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/planar.h"
#include "explore/plan/exploration_transform.h"
#include "explore/plan/frontier.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

constexpr int kDarkest = 40, kLightest = 235;  ///< greys of cells at a frontier and farthest from all

/// The map with a rim of unknown cells.
OccupancyGrid rimmed(const OccupancyGrid& map) {
  GridFrame frame = map.frame();
  frame.width += 2;
  frame.height += 2;
  frame.x0 -= frame.resolution;
  frame.y0 -= frame.resolution;
  OccupancyGrid wider(frame, Occupancy::Unknown);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) wider[{x + 1, y + 1}] = map[{x, y}];
  return wider;
}

/// option: it was named by.
Cell free_cell(const char* option, const TPoint2D& place, const Traversable& floor, double d_min) {
  const Cell c = floor.cells.cell(place);
  if (!floor.cells.inside(c) || floor.cells[c] != Occupancy::Free)
    throw InputError(std::string(option) + ": no free floor of the map is there; choose another place");
  if (static_cast<double>(floor.clearance[c]) < d_min)
    throw InputError(std::string(option) +
                     ": nearer to a wall than d_min allows; choose another place or a smaller d_min");
  return c;
}

/// Fig. 9: the nearer to a goal the darker; walls black, goals blue, the way red.
RgbImage draw(const Traversable& floor, const ExplorationTransform& transform, const std::vector<Source>& goals,
              const std::vector<Cell>& way) {
  const int width = floor.cells.width(), height = floor.cells.height();
  double most = 0.0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (transform.reached({x, y})) most = std::max(most, transform.cost({x, y}));
  RgbImage image(width, height);
  const auto paint = [&](Cell c, int r, int g, int b) {
    std::uint8_t* pixel = image.pixel(c.x, height - 1 - c.y);
    pixel[0] = static_cast<std::uint8_t>(r);
    pixel[1] = static_cast<std::uint8_t>(g);
    pixel[2] = static_cast<std::uint8_t>(b);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Cell c{x, y};
      if (floor.cells[c] == Occupancy::Occupied) {
        paint(c, 0, 0, 0);
      } else if (floor.cells[c] == Occupancy::Unknown) {
        paint(c, 200, 200, 215);
      } else if (!transform.reached(c)) {
        paint(c, 255, 255, 255);
      } else {
        const double share = most > 0.0 ? transform.cost(c) / most : 0.0;
        const int grey = kDarkest + static_cast<int>(std::lround((kLightest - kDarkest) * share));
        paint(c, grey, grey, grey);
      }
    }
  for (const Source& s : goals) paint(s.cell, 40, 90, 220);
  for (const Cell c : way) paint(c, 220, 30, 30);
  return image;
}

PlannedWay measured(const std::vector<Cell>& way, const Traversable& floor, const ExplorationTransform& transform) {
  PlannedWay out;
  out.cost = transform.cost(way.front());
  out.least_clearance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < way.size(); ++i) {
    out.least_clearance = std::min<double>(out.least_clearance, floor.clearance[way[i]]);
    if (i > 0) out.length += distance(floor.cells.centre(way[i - 1]), floor.cells.centre(way[i]));
  }
  return out;
}

}  // namespace

PlanPicture plan_picture(const OccupancyGrid& map, const PlannerConfig& config, const PlanEnds& ends) {
  Traversable floor = traversable(rimmed(map));
  measure_clearance(floor, Planner(config).clearance_cap());
  PlanPicture out;
  std::vector<Source> goals;
  if (ends.to) {
    goals.push_back({free_cell("--to", *ends.to, floor, config.transform.d_min), 0.0});
  } else {
    for (const FrontierCluster& cluster : frontier_clusters(floor, config.min_frontier_cells)) {
      for (const Cell c : cluster.cells) goals.push_back({c, 0.0});
      ++out.frontiers;
    }
    if (goals.empty())
      throw InputError("has no frontier: no free floor lies beside floor that is unknown; give a target with --to X,Y");
  }
  ExplorationTransform transform;
  transform.run(floor, goals, config.transform);
  std::vector<Cell> way;
  if (ends.from) way = transform.descend(free_cell("--from", *ends.from, floor, config.transform.d_min));
  if (!way.empty()) out.way = measured(way, floor, transform);
  floor.clearance = {};  // the largest pictures take the memory for what is drawn
  out.image = draw(floor, transform, goals, way);
  return out;
}

}  // namespace rubble::explore
