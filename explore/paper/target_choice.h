#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/caution/left_alone.h"
#include "explore/caution/local_grids.h"
#include "explore/caution/trail.h"
#include "explore/paper/frontier_worth.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "explore/search/floor_search.h"
#include "slam/mapper.h"

namespace rubble::explore {

constexpr double kLongerWay = 2.0;  ///< a way that is so much longer is a detour [m]

/// What the robot drives to.
enum class Goal { Frontier, Place, Home };

/// What comes before what, by the way it costs.
struct Priorities {
  double niches = 1.0;     ///< one that costs no more, nor more than the next frontier, is looked into before that [m]
  double faces = 0.0;      ///< the same for all other places to search [m]
  double frontiers = 2.0;  ///< one may cost so much more than the next place to search and goes before it [m]
};

/// The choice of the next target: a close frontier by the Exploration Transform (or as `FrontierChoiceConfig` asks);
/// where none is in reach, a wall that may hide one and be none; the back of a niche where that lies beside the way;
/// places to search from once no frontier is left; the start in the end. The target being driven to has a head start,
/// so that the robot does not turn round for a trifle.
class TargetChoice {
 public:
  /// What a choice is made on.
  struct View {
    const Traversable& floor;
    mrpt::math::TPose2D T_map_base;
    Stamp now;
    const LeftAlone& left_alone;
    bool places_only = false;  ///< in a search frontiers do not come first
    bool faces_first = false;  ///< walls that may hide new ground come after the faces
    double speed = 0.2;        ///< of the robot so far, turns and stops included [m/s]
  };
  struct Choice {
    Plan plan;
    bool no_niche = false;    ///< frontiers are done and so are the niches: `plan` is to a frontier, if one is in reach
    bool into_reach = false;  ///< a frontier is driven to although all that were in reach had been seen
  };

  /// `bar_targets`: frontiers that could not be had are left alone. `pallet`: size of the arena's elements [m]; 0:
  /// none.
  TargetChoice(const PlannerConfig& config, bool bar_targets, double pallet = 0.0, const FrontierChoiceConfig& by = {},
               const Priorities& priorities = {})
      : config_(config),
        bar_targets_(bar_targets),
        pallet_(pallet),
        by_(by),
        priorities_(priorities),
        planner_(config) {}

  Goal goal() const { return goal_; }
  /// No frontier could be reached in this round: what comes into reach later is a detour of the search.
  bool frontiers_done() const { return frontiers_done_; }
  /// A round begins.
  void explore();
  void set_frontiers_done() { frontiers_done_ = true; }
  void search() { goal_ = Goal::Place; }
  /// Whether pockets of unknown ground are left out of the targets.
  void leave_pockets(bool leave) { leaves_pockets_ = leave; }
  /// From now on walls are looked at even where they may hide no more than a pocket.
  void be_thorough() { thorough_ = true; }
  bool thorough() const { return thorough_; }
  void go_home();

  /// Where the robot started, which is home.
  void set_home(const Anchor& home) { home_ = home; }
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper) { home_.follow(mapper); }

  /// The next way, and with it the goal, unless that is home: then it is way_home(). Where the choice says `no_niche`
  /// it is not made: `choose_of_all_places` or, after another round has begun, `choose_frontier` makes it.
  Choice choose(const View& view, FloorSearch& search);
  Choice choose_of_all_places(const View& view, FloorSearch& search, Plan frontier);
  Plan choose_frontier(const View& view, const FloorSearch& search) { return to_frontier(view, search, std::nullopt); }
  /// A way to the start, or as near to it as can be reached. `trail`: over floor that has carried the robot, if there
  /// is one. What it has not driven on may stop it, when no time is left for another way.
  Plan way_home(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, const Trail* trail);
  /// Distance to the start as the crow flies [m].
  double distance_home(const mrpt::math::TPose2D& T_map_base) const;

  /// Whether the target lies before a wall that may be none.
  bool doubtful() const { return doubtful_; }
  const std::optional<mrpt::math::TPoint2D>& target() const { return target_; }
  /// Of the way to it when it was first chosen, eq. (3) [m].
  double cost() const { return cost_; }
  /// Makes the end of a plan the target; says whether it is another one.
  bool take(const Plan& plan);
  void drop_target() { target_.reset(); }
  /// Whether the way of a plan ends elsewhere than at the target.
  bool turns_away(const Plan& plan) const;
  /// Whether the floor makes the way to the target longer than a detour, of which `left` [m] were left, or impossible.
  bool kept_away(const View& view, double left);

  double clearance_cap() const { return planner_.clearance_cap(); }

 private:
  Plan straight_home(const Traversable& floor, const mrpt::math::TPose2D& T_map_base);
  Plan to_frontier(const View& view, const FloorSearch& search, const std::optional<mrpt::math::TPoint2D>& previous);
  Plan beside_the_way(const View& view, FloorSearch& search, const Plan& frontier);
  bool goes_first(const Plan& place, const Plan& frontier, double most) const;
  Plan to_place(const View& view, FloorSearch& search, Subjects subjects);
  Choice weigh(Plan frontier, Plan place);

  PlannerConfig config_;
  bool bar_targets_;
  double pallet_;
  KnownGrids grids_;        ///< of the pallets, on the newest maps ...
  KnownGrids grids_shown_;  ///< ... and on these with what is pushed aside still there
  FrontierChoiceConfig by_;
  Priorities priorities_;
  Planner planner_;
  Anchor home_;
  Goal goal_ = Goal::Frontier;
  bool frontiers_done_ = false;
  bool leaves_pockets_ = false;
  bool thorough_ = false;  ///< all faces were searched once: what is left to be seen counts, however small
  std::optional<mrpt::math::TPoint2D> target_;
  bool doubtful_ = false;  ///< it is before a wall that may be none
  double cost_ = 0.0;
};

}  // namespace rubble::explore
