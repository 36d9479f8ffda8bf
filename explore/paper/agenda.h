#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/caution/left_alone.h"
#include "explore/explorer.h"
#include "explore/motion/pilot.h"
#include "explore/paper/close_looks.h"
#include "explore/paper/known_ground.h"
#include "explore/paper/paper_config.h"
#include "explore/paper/plan_clock.h"
#include "explore/paper/pushing.h"
#include "explore/paper/rounds.h"
#include "explore/paper/target_choice.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "explore/search/floor_search.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// What the robot is to do next.
struct Order {
  enum class Kind { Follow, Stay, Turn, Stop };
  Kind kind = Kind::Stay;  ///< Stay: without a path; Stop: without a turn either
  Plan plan;               ///< to follow
  double angle = 0.0;      ///< to turn by [rad]
  TurnFor purpose = TurnFor::View;
};

/// For decisions: "(1.2, -3.4)".
std::string place_text(const mrpt::math::TPoint2D& p);

/// What there is to do, in order: frontiers, with the niches beside the way; what failed before; all places that were
/// not looked at; another round; home. Of each plan it makes the next order, and tells in words why.
///
/// It drives nothing and watches nothing: it is asked when a plan is due (`due`), first for the plan (`choose`), then
/// for what follows from it (`decide`).
class Agenda {
 public:
  /// What a decision is made on, and what it may change.
  struct Situation {
    Stamp now;
    mrpt::math::TPose2D T_map_base;
    const Traversable& floor;
    bool turning;         ///< a turn is under way
    std::size_t victims;  ///< sure ones so far
    LeftAlone& left_alone;
    FloorSearch& search;
    double speed = 0.2;                 ///< of the robot so far, turns and stops included [m/s]
    const Trail* trail = nullptr;       ///< where the floor carried the robot, if it did not everywhere
    CloseLooks* close_looks = nullptr;  ///< right before walls that may be none

    Anchor robot() const { return {now, T_map_base}; }
  };

  explicit Agenda(const PaperExplorerConfig& config);

  Goal goal() const { return choice_.goal(); }
  bool finished() const { return end_ != MissionEnd::UnderWay; }
  MissionEnd end() const { return end_; }
  const std::string& reason() const { return reason_; }
  const std::vector<Decision>& decisions() const { return decisions_; }
  void note(Stamp now, const std::string& why);
  /// Ends the mission.
  Order finish(MissionEnd end, const std::string& why, Stamp now);
  /// From now on the robot drives home.
  void go_home(const std::string& why, Stamp now);

  /// Where the robot started.
  void set_home(const Anchor& home) { choice_.set_home(home); }
  /// The way home from here; where none is known the crow's way and a detour, but no more than the way it came [m].
  double way_home(const Situation& situation, double way_come);
  /// The mapper corrected its past, and the robot's place by `shift` [m].
  void follow(const slam::Mapper& mapper, double shift);

  void plan_soon() { clock_.force(); }
  /// Nothing is left of the path: another plan is due, soon.
  void arrived(Stamp now);
  bool due(const slam::CountMap& map, Stamp now) const { return clock_.due(map.version(), now); }
  /// A plan is made now. Says whether it is the first one on this map.
  bool begin_plan(const slam::CountMap& map, Stamp now);
  /// The way to the next target; the goal may change with it.
  Plan choose(const Situation& situation);
  /// Something new stands in the way, of which `left` [m] were left: bars a target that it keeps the robot from, that
  /// it shows right before, or that such things made it turn away from before. The robot would turn round again once
  /// the new thing is forgotten, and again when it is seen anew. Says whether the way that is left leads round it, by a
  /// detour.
  bool turn_away(const Plan& plan, double left, const Situation& situation);
  /// What follows from a plan.
  Order decide(Plan plan, bool new_map, const Situation& situation);

  const std::optional<mrpt::math::TPoint2D>& target() const { return choice_.target(); }
  /// Where it looks at a wall from that may be none, if that is its target.
  std::optional<mrpt::math::TPoint2D> doubted_wall() const { return choice_.doubtful() ? target() : std::nullopt; }
  /// Spends `dt` [s] on the way to the target; one that costs more time than it deserves is left alone.
  void spend(double dt, const Situation& situation);
  /// The target cannot be had: it is left alone for a while.
  void leave_target(LeftAlone& left_alone, const Anchor& robot);
  /// The place to search was seen from the way.
  void look_made(const Situation& situation);

  /// From this plan on the robot drives at what has just shut its way: that is no new obstacle.
  bool begins_to_insist() const { return insists_ && push_begun_; }

  Pushing& pushing() { return pushing_; }
  const Pushing& pushing() const { return pushing_; }
  double clearance_cap() const { return choice_.clearance_cap(); }

 private:
  void insist(bool wanted, const Plan& plan, const Situation& situation);
  Order face_subject(const Situation& situation);
  Order visited_in_vain(const Plan& plan, const Situation& situation);
  Order nothing_left(const Situation& situation);
  bool may_push(const Situation& situation) const;
  Order start_pushing(const Situation& situation, const std::string& why);
  bool push_for_niche(const Situation& situation);
  void end_pushing();
  Order finish_exploring(const Situation& situation);
  Order finish_searching(const Situation& situation);
  void begin_round(const std::string& news, Stamp now);
  Order stay_and_plan();
  bool faces_go_first(const Situation& situation) const;
  Rounds::Standing standing(const Situation& situation) const;
  std::size_t prospects_of(const Situation& situation, bool pushed) const;

  PaperExplorerConfig config_;
  TargetChoice choice_;
  Rounds rounds_;
  Pushing pushing_;
  mutable KnownGrids grids_pushed_;  ///< of the pallets, with all pushed aside that may be
  KnownGround known_off_grid_;       ///< when things off the grid were driven at last for the sake of new ground
  KnownGround known_at_niche_;       ///< when things were pushed aside last on the way to a niche
  bool pushes_for_niche_ = false;    ///< what is pushed aside now is for the sake of one
  double cost_left_ = 0.0;           ///< of the last plan, but for those of pushing for its sake [m]
  bool insists_ = false;             ///< what stands off the grid is driven at, for the place that it was driving to
  std::vector<AnchoredPoint> insisted_on_;  ///< such places
  bool push_begun_ = false;                 ///< by the plan under way, which is to be made anew
  PlanClock clock_;
  std::size_t frontier_left_ = 0;  ///< of the last plan
  KnownGround gained_;             ///< when new ground was seen last ...
  Stamp gained_at_ = Stamp::never();
  double in_vain_ = 0.0;      ///< spent on the way to frontiers since then [s]
  int rounds_cut_short_ = 0;  ///< that ended while faces were left to be looked at squarely
  std::optional<AnchoredPoint> looked_from_;
  MissionEnd end_ = MissionEnd::UnderWay;
  std::string reason_;
  std::vector<Decision> decisions_;
};

}  // namespace rubble::explore
