#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/planar.h"
#include "explore/attempts.h"
#include "explore/blacklist.h"
#include "explore/explorer.h"
#include "explore/floor_search.h"
#include "explore/motion_watch.h"
#include "explore/path_follower.h"
#include "explore/planner.h"
#include "explore/traversable.h"

// What the parts of Explorer share: explorer.cpp decides where to go, explorer_recovery.cpp what to do when the way is
// not as planned.

namespace rubble::explore {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Drive;

inline constexpr double kBarRadius = 0.60;  ///< about targets that cannot be had [m]

inline TPoint2D position(const TPose2D& pose) { return {pose.x, pose.y}; }

/// A turn on the spot to let the scanner see all around.
struct LookAround {
  double left = 0.0;  ///< [rad], signed; 0: none under way
  Stamp until = Stamp::never();
  bool to_the_end = false;  ///< not ended early by a new target
  bool active() const { return left != 0.0; }
};

struct Explorer::Impl {
  Impl(const robot::RobotModel& robot_model, const ExplorerConfig& explorer_config);

  void observe(const slam::Mapper& mapper, const robot::Inputs& inputs);
  Drive decide(const slam::Mapper& mapper);
  Drive start(const slam::Mapper& mapper);
  Drive drive(const slam::Mapper& mapper);
  Drive back_up();

  Traversable floor_now(const slam::Mapper& mapper, bool with_hits) const;
  void replan(const slam::Mapper& mapper);
  Plan plan_on(const Traversable& floor);
  void accept(Plan plan);
  void visited_in_vain(const TPoint2D& target);
  void nothing_left();
  void finish_exploring();
  void finish_searching();
  void finish(const std::string& why);

  void check_path(const slam::Mapper& mapper);
  void got_stuck();
  void bar_target(const TPoint2D& target);
  void look_around(double angle, bool to_the_end);
  Drive look();
  void show_path();

  void mark_searched();
  bool holding_still();
  Plan plan_search(const Traversable& floor);
  void face_subject();

  const robot::RobotModel model;
  const ExplorerConfig config;
  Planner planner;
  PathFollower follower;
  VictimSearch search;
  FloorSearch floor_search;
  Blacklist blacklist;
  Attempts attempts;
  MotionWatch watch;

  ExplorerState state = ExplorerState::Starting;
  std::string reason;
  std::vector<TPoint2D> shown_path;

  Stamp now = Stamp::never();
  double dt = 0.0;
  TPose2D pose;
  double turned = 0.0;
  bool stalled = false;
  Stamp last_scan = Stamp::never();
  Drive commanded;
  std::vector<TPoint2D> trail;
  TPoint2D home;

  std::uint64_t planned_version = 0;
  Stamp next_plan = Stamp::never();
  Stamp last_plan = Stamp::never();
  bool plan_forced = true;
  std::optional<TPoint2D> target;
  double target_cost = 0.0;
  double path_d_min = 0.0;
  std::size_t frontier_left = 0;

  LookAround looking;
  std::optional<TPoint2D> looked_from;
  int failed_plans = 0;
  int looks_in_vain = 0;
  int pardons = 0;

  Stamp next_check = Stamp::never();
  std::vector<TPoint2D> remembered_hits;
  Stamp forget_hits = Stamp::never();
  bool blocked = false;
  Stamp creep_until = Stamp::never();

  Traversable last_floor;
  ExplorerState after_back_up = ExplorerState::Driving;
  Stamp back_up_until = Stamp::never();
  bool back_up_turns = false;
  std::optional<TPoint2D> stuck_place;
  int stuck_there = 0;
};

}  // namespace rubble::explore
