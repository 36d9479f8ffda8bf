#include "explore/plan_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/image/legend.h"
#include "base/image/png.h"
#include "base/planar.h"
#include "explore/plan/exploration_transform.h"
#include "explore/plan/frontier.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using Colour = cv::Vec3b;

/// Three digits, and all of those before the point.
std::string cost_text(double metres) { return cv::format(metres < 999.5 ? "%.3g m" : "%.0f m", metres); }

const Colour kWall(0, 0, 0), kUnseen(215, 200, 200), kCutOff(255, 255, 255), kGoal(220, 90, 40), kWay(30, 30, 220),
    kStart(60, 170, 40);
constexpr double kDarkest = 40.0, kLightest = 235.0;  ///< greys of cells at a goal and farthest from all

Colour grey(double share) {
  return Colour::all(static_cast<std::uint8_t>(std::lround(kDarkest + (kLightest - kDarkest) * share)));
}

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

/// Of the way that was asked for; either may be missing.
struct Marked {
  std::optional<Cell> start, end;
};

struct Drawing {
  std::string png;
  double pixels_per_metre = 0.0;
  bool reached = false;
};

/// Large enough to be seen in a picture whose cells are single pixels.
void put_disc(cv::Mat& image, const cv::Point& middle, int scale, const Colour& colour) {
  const int radius = std::max(5, 2 * scale);
  cv::circle(image, middle, radius, cv::Scalar(colour), cv::FILLED);
  cv::circle(image, middle, radius, cv::Scalar(kWall), 1);
}

/// Fig. 9: the nearer to a goal the darker.
Drawing draw(const Traversable& floor, const ExplorationTransform& transform, const std::vector<Source>& goals,
             const std::vector<Cell>& way, const Marked& marked, const std::string& what) {
  const int width = floor.cells.width(), height = floor.cells.height();
  double most = 0.0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (transform.reached({x, y})) most = std::max(most, transform.cost({x, y}));
  const bool reached = most > 0.0;  // a frontier costs nothing, and whatever has a way to one something
  const GridFrame& frame = floor.cells.frame();
  const int scale = pixels_per_cell(frame);
  cv::Mat image(height * scale, std::max(width * scale, kLeastWidth), CV_8UC3, cv::Scalar(kUnseen));
  const auto paint = [&](Cell c, const Colour& colour) {
    const cv::Rect pixels(c.x * scale, (height - 1 - c.y) * scale, scale, scale);
    image(pixels).setTo(cv::Scalar(colour));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Cell c{x, y};
      if (floor.cells[c] == Occupancy::Occupied) {
        paint(c, kWall);
      } else if (floor.cells[c] == Occupancy::Unknown) {
        paint(c, kUnseen);
      } else if (!transform.reached(c)) {
        paint(c, kCutOff);
      } else {
        paint(c, grey(most > 0.0 ? transform.cost(c) / most : 0.0));
      }
    }
  for (const Source& s : goals) paint(s.cell, kGoal);
  for (const Cell c : way) paint(c, kWay);
  const auto middle = [&](Cell c) {
    return cv::Point(c.x * scale + scale / 2, (height - 1 - c.y) * scale + scale / 2);
  };
  if (marked.end) put_disc(image, middle(*marked.end), scale, kGoal);
  if (marked.start) put_disc(image, middle(*marked.start), scale, kStart);
  put_axes(image, frame, scale);
  std::vector<StripItem> items{bar_item(image, "cost to the " + what + ": 0", cost_text(most),
                                        [](double share) { return bgr_of(grey(share)); })};
  std::vector<LegendEntry> entries{{kGoal, what}};
  if (marked.start) entries.push_back({kStart, "start"});
  if (!way.empty()) entries.push_back({kWay, "way"});
  for (const LegendEntry& ground :
       {LegendEntry{kCutOff, "no way from here"}, LegendEntry{kWall, "wall"}, LegendEntry{kUnseen, "unknown"}})
    entries.push_back(ground);
  for (StripItem& item : legend_items(image, entries)) items.push_back(std::move(item));
  put_strip(image, items, frame, scale);
  return {png_bytes(image), scale / frame.resolution, reached};
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
  Marked marked;
  if (ends.from) {
    marked.start = free_cell("--from", *ends.from, floor, config.transform.d_min);
    way = transform.descend(*marked.start);
  }
  if (ends.to) {
    marked.end = goals.front().cell;
  } else if (!way.empty()) {
    marked.end = way.back();
  }
  if (!way.empty()) out.way = measured(way, floor, transform);
  floor.clearance = {};  // the largest pictures take the memory for what is drawn
  Drawing drawn = draw(floor, transform, goals, way, marked, ends.to ? "target" : "frontier");
  out.png = std::move(drawn.png);
  out.pixels_per_metre = drawn.pixels_per_metre;
  out.reached = drawn.reached;
  return out;
}

}  // namespace rubble::explore
