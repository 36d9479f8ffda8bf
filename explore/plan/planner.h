#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <functional>
#include <optional>
#include <vector>

#include "explore/plan/exploration_transform.h"
#include "explore/plan/frontier.h"
#include "explore/plan/path_follower.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

struct PlannerConfig {
  TransformConfig transform;
  double d_min_floor = 0.27;   ///< d_min falls to this step by step when nothing can be reached otherwise [m]
  double d_min_step = 0.04;    ///< [m]
  int min_frontier_cells = 5;  ///< smaller clusters are no targets
  double switch_cost = 0.6;    ///< a new target must be this much cheaper than the one being driven to [m]
  double same_target = 0.5;    ///< targets this close together are one [m]
};

/// A way to a target, or the news that there is none.
struct Plan {
  bool found = false;
  std::vector<PathPoint> path;    ///< from the robot to the target
  mrpt::math::TPoint2D target;    ///< last cell of the path [m]
  double cost = 0.0;              ///< of eq. (3), head starts included [m]
  double d_min = 0.0;             ///< the one the way keeps [m]
  bool doubtful = false;          ///< the target is a place to look from at a wall that may be none
  std::size_t frontier_left = 0;  ///< frontier clusters that are big enough and hold a cell that is not barred
};

/// Of a plan's path [m].
double length_of(const Plan& plan);

/// What the planner asks about a place: whether it is barred as a target.
using BarredFn = std::function<bool(const mrpt::math::TPoint2D&)>;

/// A frontier that can be reached.
struct Candidate {
  Cell middle;     ///< of the frontier, the cell next to its centroid
  double way;      ///< to its nearest cell, by length alone [m]
  bool driven_to;  ///< it is the target already
};
/// What a frontier is worth: of those that can be reached the one worth most is driven to, of equals the first one.
using WorthFn = std::function<double(const Candidate&)>;

/// Finds ways on a Traversable by Exploration Transform (to a close frontier) and path transform (to a point).
class Planner {
 public:
  explicit Planner(const PlannerConfig& config) : config_(config) {}

  /// Distances to obstacles need not be told apart beyond [m]. Eq. (4) as printed has no such end.
  double clearance_cap() const {
    return config_.transform.discomfort == Discomfort::PerCell ? kNoCap : config_.transform.d_opt + kBeyondOptimum;
  }

  /// The cheapest way to a frontier; `previous` is the target being driven to, which is given a head start. With
  /// Discomfort::PerCell there is no head start, as printed.
  /// `worth`: the cheapest way to the frontier that is worth most, of those that can be reached at the same distance
  /// from obstacles as the cheapest; head starts are then for `worth` to give.
  Plan to_frontier(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, const BarredFn& barred,
                   const std::optional<mrpt::math::TPoint2D>& previous, const WorthFn& worth = {});

  /// The cheapest way to within `tolerance` of a point.
  Plan to_point(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, const mrpt::math::TPoint2D& target,
                double tolerance);

  /// The cheapest way to one of several cells. `detour`: a way nearer to walls is taken where it is so much cheaper,
  /// too [m]; without it only where there is no other. `previous`: the target being driven to; such a way to it need
  /// only be cheaper than one to another.
  Plan to_cells(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, const std::vector<Source>& sources,
                std::optional<double> detour = std::nullopt,
                const std::optional<mrpt::math::TPoint2D>& previous = std::nullopt);

  /// How much dearer in ways another target is than the one being driven to, if that is known. With
  /// Discomfort::PerCell not at all, as printed [m].
  double head_start(const std::optional<mrpt::math::TPoint2D>& previous, const mrpt::math::TPoint2D& other) const;

  /// The transform of the last plan.
  const ExplorationTransform& transform() const { return transform_; }

 private:
  /// A frontier with cells that are not barred.
  struct Open {
    std::vector<Source> cells;
    mrpt::math::TPoint2D centroid;
    bool of_previous = false;
  };

  Plan plan(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, const std::vector<Source>& sources);
  /// The cheapest way from `start` to a source that keeps `d_min` [m], where there is one; nearer to something, the
  /// robot climbs away from it first.
  Plan keeping(double d_min, const Traversable& floor, Cell start, const std::vector<Source>& sources);
  bool is_target(const std::optional<mrpt::math::TPoint2D>& previous, const mrpt::math::TPoint2D& other) const;
  double least_d_min() const { return std::min(config_.d_min_floor, config_.transform.d_min); }
  const Open* worth_most(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, double d_min,
                         const std::vector<Open>& frontiers, const WorthFn& worth);

  static constexpr double kBeyondOptimum = 0.6;  ///< [m]
  static constexpr double kNoCap = 1000.0;       ///< farther than any map is wide [m]

  PlannerConfig config_;
  ExplorationTransform transform_;
};

/// Climbs the clearance from `start` through free cells until it is at least `d_min`: the cells on the way, `start`
/// first. Ends early on a local maximum.
std::vector<Cell> climb_clearance(const Traversable& floor, Cell start, double d_min);

/// Takes the stairs out of a path of cells (moving average over 0.4 m) where that keeps the clearance.
std::vector<PathPoint> smooth_path(const Traversable& floor, const std::vector<Cell>& cells, double d_min);

}  // namespace rubble::explore
