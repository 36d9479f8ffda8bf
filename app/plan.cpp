#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/image/png.h"
#include "base/planar.h"
#include "explore/plan/exploration_transform.h"
#include "explore/plan/frontier.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "scoring/maps/normalise.h"

namespace rubble::app {
namespace {

using explore::ExplorationTransform;
using explore::Traversable;

constexpr int kDarkest = 40, kLightest = 235;  ///< greys of cells at a frontier and farthest from all

struct PlanArguments {
  std::string map;
  explore::PlannerConfig config;
  std::string discomfort = "per_metre";
  std::optional<double> resolution;
  std::string from;  ///< "X,Y"
  std::string out = "plan.png";
};

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

Cell start_cell(const std::string& from, const Traversable& floor, const ExplorationTransform& transform) {
  double x = 0.0, y = 0.0;
  char rest = 0;
  if (std::sscanf(from.c_str(), "%lf,%lf%c", &x, &y, &rest) != 2)
    throw UsageError("--from " + from + ": needs the form X,Y in metres, for example --from 1.5,-2");
  const Cell c = floor.cells.cell({x, y});
  if (!floor.cells.inside(c) || floor.cells[c] != Occupancy::Free)
    throw InputError("--from " + from + ": no free floor of the map is there");
  if (!transform.passable(c))
    throw InputError("--from " + from +
                     ": nearer to a wall than --d-min allows; choose another place or a smaller --d-min");
  return c;
}

/// Fig. 9: the nearer to a frontier the darker; walls black, frontiers blue, the way red.
RgbImage draw(const Traversable& floor, const ExplorationTransform& transform, const std::vector<Cell>& frontier,
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
  for (const Cell c : frontier) paint(c, 40, 90, 220);
  for (const Cell c : way) paint(c, 220, 30, 30);
  return image;
}

int plan(PlanArguments a) {
  explore::TransformConfig& config = a.config.transform;
  config.discomfort = a.discomfort == "per_cell" ? explore::Discomfort::PerCell : explore::Discomfort::PerMetre;
  if (config.d_opt < config.d_min) throw UsageError("--d-opt must not be smaller than --d-min");
  scoring::LoadOptions options;
  options.resolution = a.resolution;
  const scoring::LoadedMap map = scoring::load_map(a.map, options);
  Traversable floor = explore::traversable(rimmed(map.grid));
  explore::measure_clearance(floor, explore::Planner(a.config).clearance_cap());

  std::vector<explore::Source> sources;
  std::vector<Cell> frontier;
  const auto clusters = explore::frontier_clusters(floor, a.config.min_frontier_cells);
  for (const explore::FrontierCluster& cluster : clusters)
    for (const Cell c : cluster.cells) {
      sources.push_back({c, 0.0});
      frontier.push_back(c);
    }
  if (sources.empty()) throw InputError(a.map + ": has no frontier: no free floor lies beside floor that is unknown");
  ExplorationTransform transform;
  transform.run(floor, sources, config);
  std::vector<Cell> way;
  if (!a.from.empty()) way = transform.descend(start_cell(a.from, floor, transform));
  write_png(a.out, draw(floor, transform, frontier, way));

  print_row("frontiers", std::to_string(clusters.size()));
  if (!a.from.empty() && way.empty()) print_row("way", "none: no frontier can be reached from there");
  if (!way.empty()) {
    double length = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < way.size(); ++i) {
      least = std::min<double>(least, floor.clearance[way[i]]);
      if (i > 0) length += distance(floor.cells.centre(way[i - 1]), floor.cells.centre(way[i]));
    }
    std::array<char, 80> line{};
    std::snprintf(line.data(), line.size(), "%.2f m, cost %.2f m, %.2f m from walls and more", length,
                  transform.cost(way.front()), least);
    print_row("way", line.data());
  }
  print_row("picture", a.out);
  return kOk;
}

}  // namespace

Command plan_command() {
  return {"plan", "Picture of the Exploration Transform over a map, and the way to the nearest frontier",
          "Dark: near to a frontier. White: no frontier can be reached. Blue: frontiers. Red: the way.\n"
          "Examples:\n  rubble plan runs/latest/map.tif --alpha 20 --out safe.png\n"
          "  rubble plan map.yaml --discomfort per_cell --alpha 5 --d-min 0.3 --from 1.5,-2",
          [](Options& o) -> Action {
            auto a = std::make_shared<PlanArguments>();
            explore::TransformConfig& config = a->config.transform;
            o.argument("map", a->map, "Map: GeoTIFF, ROS yaml, or an image with --resolution");
            o.number("--alpha", config.alpha, 0.0, 1000.0, "Weight of the discomfort against length, default 20");
            o.number("--d-min", config.d_min, 0.0, 2.0, "Never nearer to walls, default 0.4 [m]");
            o.number("--d-opt", config.d_opt, 0.0, 5.0, "The distance to walls that is liked best, default 0.6 [m]");
            o.choice("--discomfort", a->discomfort, {"per_metre", "per_cell"},
                     "How it is summed: a metre of way, or a cell as eq. (3) is printed, with no cap");
            o.whole("--min-frontier-cells", a->config.min_frontier_cells, 1, 10000, "Smaller frontiers are no targets");
            o.number("--resolution", a->resolution, 0.001, 1.0, "Metres a pixel, where the map does not say");
            o.text("--from", a->from, "X,Y in the map [m]: draw the way from there");
            o.text("--out", a->out, "Picture to write (default: plan.png)");
            return [a] { return plan(*a); };
          }};
}

}  // namespace rubble::app
