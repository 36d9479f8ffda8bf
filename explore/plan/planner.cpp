#include "explore/plan/planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kSmoothSpan = 0.20;  ///< half the window of the moving average [m]

}  // namespace

double length_of(const Plan& plan) {
  double way = 0.0;
  for (std::size_t i = 1; i < plan.path.size(); ++i) way += distance(plan.path[i - 1].p_map, plan.path[i].p_map);
  return way;
}

std::vector<Cell> climb_clearance(const Traversable& floor, Cell start, double d_min) {
  std::vector<Cell> way{start};
  while (floor.clearance[way.back()] < d_min - kClearanceRounding) {
    const Cell c = way.back();
    Cell best = c;
    double best_slope = 0.0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if (!floor.cells.inside(n) || floor.cells[n] != Occupancy::Free) continue;
        const double slope = (floor.clearance[n] - floor.clearance[c]) / (dx != 0 && dy != 0 ? std::sqrt(2.0) : 1.0);
        if (slope <= best_slope) continue;
        best = n;
        best_slope = slope;
      }
    if (best == c) break;
    way.push_back(best);
  }
  return way;
}

std::vector<PathPoint> smooth_path(const Traversable& floor, const std::vector<Cell>& cells, double d_min) {
  const int count = static_cast<int>(cells.size());
  const int span = static_cast<int>(std::lround(kSmoothSpan / floor.frame().resolution));
  std::vector<PathPoint> path;
  path.reserve(cells.size());
  for (int i = 0; i < count; ++i) {
    const int reach = std::min({span, i, count - 1 - i});  // shrinks towards both ends, which stay
    TPoint2D mean;
    for (int k = i - reach; k <= i + reach; ++k) mean += floor.cells.centre(cells[static_cast<std::size_t>(k)]);
    mean *= 1.0 / (2 * reach + 1);
    const Cell own = cells[static_cast<std::size_t>(i)];
    const Cell there = floor.cells.cell(mean);
    const double own_clearance = floor.clearance[own];
    const bool safe = floor.cells[there] == Occupancy::Free &&
                      floor.clearance[there] >= std::min(own_clearance, d_min) - kClearanceRounding;
    path.push_back(safe ? PathPoint{mean, floor.clearance[there]} : PathPoint{floor.cells.centre(own), own_clearance});
  }
  return path;
}

Plan Planner::plan(const Traversable& floor, const TPose2D& T_map_base, const std::vector<Source>& sources) {
  const Cell start = floor.cells.cell({T_map_base.x, T_map_base.y});
  if (sources.empty() || !floor.cells.inside(start)) return {};
  for (double d_min = config_.transform.d_min;; d_min = std::max(d_min - config_.d_min_step, least_d_min())) {
    Plan plan = keeping(d_min, floor, start, sources);
    if (plan.found || d_min <= least_d_min() + kClearanceRounding) return plan;
  }
}

Plan Planner::keeping(double d_min, const Traversable& floor, Cell start, const std::vector<Source>& sources) {
  TransformConfig transform = config_.transform;
  transform.d_min = d_min;
  const std::vector<Cell> climb = climb_clearance(floor, start, d_min);
  transform_.run(floor, sources, transform, climb.back());
  if (!transform_.reached(climb.back())) return {};
  std::vector<Cell> cells = climb;
  const std::vector<Cell> way = transform_.descend(climb.back());
  cells.insert(cells.end(), way.begin() + 1, way.end());
  Plan plan;
  plan.found = true;
  plan.path = smooth_path(floor, cells, d_min);
  plan.target = floor.cells.centre(cells.back());
  plan.cost = transform_.cost(climb.back());
  plan.d_min = d_min;
  return plan;
}

Plan Planner::to_cells(const Traversable& floor, const TPose2D& T_map_base, const std::vector<Source>& sources,
                       std::optional<double> detour, const std::optional<TPoint2D>& previous) {
  Plan found = plan(floor, T_map_base, sources);
  if (!detour || !found.found || found.d_min <= least_d_min() + kClearanceRounding) return found;
  const bool leaves = previous && !is_target(previous, found.target);
  if (!leaves && found.cost <= *detour) return found;
  Plan narrow = keeping(least_d_min(), floor, floor.cells.cell({T_map_base.x, T_map_base.y}), sources);
  const double toll = leaves && is_target(previous, narrow.target) ? 0.0 : *detour;
  return narrow.found && narrow.cost + toll < found.cost ? narrow : found;
}

/// Whether a place is the target being driven to, if there is one.
bool Planner::is_target(const std::optional<TPoint2D>& previous, const TPoint2D& other) const {
  return previous && distance(other, *previous) <= config_.same_target;
}

double Planner::head_start(const std::optional<TPoint2D>& previous, const TPoint2D& other) const {
  const bool given = previous && config_.transform.discomfort == Discomfort::PerMetre;
  return given && !is_target(previous, other) ? config_.switch_cost : 0.0;
}

Plan Planner::to_frontier(const Traversable& floor, const TPose2D& T_map_base, const BarredFn& barred,
                          const std::optional<TPoint2D>& previous, const WorthFn& worth) {
  const bool head_starts = previous && config_.transform.discomfort == Discomfort::PerMetre && !worth;
  std::vector<Open> frontiers;
  for (const FrontierCluster& cluster : frontier_clusters(floor, config_.min_frontier_cells)) {
    Open open;
    open.centroid = cluster.centroid;
    for (const Cell c : cluster.cells) {
      const TPoint2D p = floor.cells.centre(c);
      if (barred(p)) continue;
      open.of_previous = open.of_previous || is_target(previous, p);
      open.cells.push_back({c, 0.0});
    }
    if (open.cells.empty()) continue;
    if (head_starts && !open.of_previous)
      for (Source& source : open.cells) source.head_start = config_.switch_cost;
    frontiers.push_back(std::move(open));
  }
  std::vector<Source> sources;
  for (const Open& open : frontiers) sources.insert(sources.end(), open.cells.begin(), open.cells.end());
  Plan found = plan(floor, T_map_base, sources);
  if (found.found && worth)
    if (const Open* best = worth_most(floor, T_map_base, found.d_min, frontiers, worth))
      found = plan(floor, T_map_base, best->cells);
  found.frontier_left = frontiers.size();
  return found;
}

const Planner::Open* Planner::worth_most(const Traversable& floor, const TPose2D& T_map_base, double d_min,
                                         const std::vector<Open>& frontiers, const WorthFn& worth) {
  TransformConfig by_length;
  by_length.alpha = 0.0;
  by_length.d_min = d_min;
  const std::vector<Cell> climb = climb_clearance(floor, floor.cells.cell({T_map_base.x, T_map_base.y}), d_min);
  transform_.run(floor, {{climb.back(), 0.0}}, by_length);
  const Open* best = nullptr;
  double most = 0.0;
  for (const Open& open : frontiers) {
    double way = std::numeric_limits<double>::infinity();
    double off = way;
    Candidate candidate{{}, 0.0, open.of_previous};
    for (const Source& source : open.cells) {
      way = std::min(way, transform_.cost(source.cell));
      const double from_middle = distance(floor.cells.centre(source.cell), open.centroid);
      if (from_middle >= off) continue;
      off = from_middle;
      candidate.middle = source.cell;
    }
    if (!std::isfinite(way)) continue;
    candidate.way = way;
    const double value = worth(candidate);
    if (best != nullptr && value <= most) continue;
    best = &open;
    most = value;
  }
  return best;
}

Plan Planner::to_point(const Traversable& floor, const TPose2D& T_map_base, const TPoint2D& target, double tolerance) {
  std::vector<Source> sources;
  const Cell low = floor.cells.cell({target.x - tolerance, target.y - tolerance});
  const Cell high = floor.cells.cell({target.x + tolerance, target.y + tolerance});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      const Cell c{x, y};
      if (!floor.cells.inside(c)) continue;
      const double off = distance(floor.cells.centre(c), target);
      // Ending beside the target is worth less than the way it saves.
      if (off <= std::max(tolerance, floor.frame().resolution)) sources.push_back({c, 2.0 * off});
    }
  return plan(floor, T_map_base, sources);
}

}  // namespace rubble::explore
