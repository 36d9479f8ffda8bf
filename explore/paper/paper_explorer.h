#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/planar.h"
#include "explore/anchor.h"
#include "explore/caution/attempts.h"
#include "explore/caution/blacklist.h"
#include "explore/caution/felt_obstacles.h"
#include "explore/caution/passed_floor.h"
#include "explore/explorer.h"
#include "explore/motion/look_around.h"
#include "explore/motion/path_watch.h"
#include "explore/motion/pivot.h"
#include "explore/paper/home_way.h"
#include "explore/paper/paper_config.h"
#include "explore/plan/path_follower.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "explore/search/floor_search.h"
#include "explore/search/pose_doubt.h"
#include "explore/search/victim_search.h"
#include "explore/stuck/escape.h"
#include "explore/stuck/jolt_watch.h"
#include "explore/stuck/motion_watch.h"
#include "explore/stuck/tilt_watch.h"
#include "explore/stuck/way_back.h"
#include "robot/model.h"

namespace rubble::explore {

/// The paper's explorer: Exploration Transform to a close frontier by a safe path, until nothing reachable is left;
/// then to places the victim sensors have not looked at, by the same transform. paper_explorer.cpp decides where to go,
/// recovery.cpp what to do when the way is not as planned.
class PaperExplorer : public Explorer {
 public:
  PaperExplorer(const robot::RobotModel& model, const PaperExplorerConfig& config, const Mission& mission = {});

  robot::Commands next(const slam::Mapper& mapper, const robot::Inputs& inputs) override;
  bool finished() const override { return state_ == ExplorerState::Finished; }
  const std::string& reason() const override { return reason_; }
  MissionEnd end() const override { return end_; }
  ExplorerState state() const override { return state_; }
  const std::vector<Decision>& decisions() const override { return decisions_; }
  const std::vector<mrpt::math::TPoint2D>& path() const override { return shown_path_; }
  const std::vector<VictimReport>& victims() const override { return search_.reports(); }
  /// So much of the time limit is kept for the way home, beside the way itself [s].
  double time_for_home() const override { return config_.return_home ? HomeWay::kSpareTime : 0.0; }

 private:
  using TPoint2D = mrpt::math::TPoint2D;
  using TPose2D = mrpt::math::TPose2D;
  using Drive = robot::Drive;

  static constexpr double kBarRadius = 0.60;  ///< about targets that cannot be had [m]

  void observe(const slam::Mapper& mapper, const robot::Inputs& inputs);
  void follow_map(const slam::Mapper& mapper);
  void hear(const slam::Mapper& mapper, const robot::VictimCue& cue);
  void note(const std::string& why);
  Drive decide(const slam::Mapper& mapper);
  Drive start(const slam::Mapper& mapper);
  Drive drive(const slam::Mapper& mapper);
  Drive escape();

  /// The floor with `hits` [map frame] as further obstacles.
  Traversable floor_now(const slam::Mapper& mapper, const std::vector<TPoint2D>& hits) const;
  void replan(const slam::Mapper& mapper);
  Plan plan_on(const Traversable& floor);
  Plan plan_home(const Traversable& floor);
  bool keeps_away(const TPoint2D& target);
  void accept(Plan plan);
  void visited_in_vain(const TPoint2D& target);
  void nothing_left();
  void finish_exploring();
  void finish_searching();
  bool may_push() const;
  void start_pushing();
  double ground_gained_since(std::size_t known_then) const;
  bool another_round();
  bool forget_what_was_felt();
  bool pardon();
  void explore_again();
  void finish(MissionEnd end, const std::string& why);
  void go_home(const std::string& why);
  bool must_turn_back();

  void check_path(const slam::Mapper& mapper);
  std::vector<TPoint2D> without_loose_things(const std::vector<TPoint2D>& hits);
  void got_stuck(const std::string& how);
  void bar_target(const TPoint2D& target);
  void look_around(double angle, bool to_the_end);
  void show_path();

  void mark_searched();
  bool holding_still();
  Plan plan_search(const Traversable& floor, Subjects subjects);
  void face_subject();

  const robot::RobotModel model_;
  const PaperExplorerConfig config_;
  Planner planner_;
  PathFollower follower_;
  VictimSearch search_;
  FloorSearch floor_search_;
  Blacklist blacklist_;
  Attempts attempts_;
  MotionWatch watch_;
  PathWatch path_watch_;
  LookAround looking_;
  Pivot pivot_;
  TiltWatch tilt_;
  JoltWatch jolt_;
  PoseDoubt doubt_;
  FeltObstacles felt_;
  Escape escape_;
  HomeWay home_way_;

  ExplorerState state_ = ExplorerState::Starting;
  MissionEnd end_ = MissionEnd::UnderWay;
  std::string reason_;
  std::vector<Decision> decisions_;
  std::vector<TPoint2D> shown_path_;

  Stamp now_ = Stamp::never();
  double dt_ = 0.0;                       ///< of commands: a robot that was held meanwhile did not follow them
  Stamp patient_until_ = Stamp::never();  ///< the base may not obey yet
  TPose2D pose_;
  double turned_ = 0.0;  ///< since the last tick [rad]
  bool stalled_ = false;
  bool brakes_ = false;               ///< this tick's command is to stop as hard as the base can
  std::optional<Stamp> odometry_at_;  ///< when the wheels were heard of last
  Stamp last_scan_ = Stamp::never();
  Drive commanded_;
  std::uint64_t revision_ = 0;
  std::vector<Anchor> trail_anchors_;
  std::vector<TPoint2D> trail_;  ///< the anchors' places
  PassedFloor passed_;           ///< these again
  WayBack way_back_;
  Anchor home_;

  Traversable last_floor_;
  std::uint64_t planned_version_ = 0;
  Stamp next_plan_ = Stamp::never();
  Stamp last_plan_ = Stamp::never();
  bool plan_forced_ = true;
  std::optional<TPoint2D> target_;
  double target_cost_ = 0.0;
  double path_d_min_ = 0.0;
  std::size_t frontier_left_ = 0;

  std::optional<TPoint2D> looked_from_;
  bool facing_ = false;  ///< the turn under way is towards a place to search
  int failed_plans_ = 0;
  int looks_in_vain_ = 0;
  int pardons_ = 0;
  double pushed_aside_ = 0.0;           ///< things that stand alone and are not wider are driven at; 0: none [m]
  std::vector<TPoint2D> rolling_;       ///< hits on what is being pushed, of the last check [m, map frame]
  std::size_t known_when_pushing_ = 0;  ///< cells, when that began last in this round; 0: not yet
  int home_tries_ = 0;
  bool tried_before_search_ = false;  ///< what could not be reached was tried again in this round
  bool frontiers_done_ = false;       ///< this round's; what comes into reach later is a detour of the search
  int rounds_ = 1;                    ///< of exploring and searching, this one included
  int barren_rounds_ = 0;             ///< that gained nothing, in a row
  int forgets_ = 0;                   ///< times that all that was felt was forgotten for that
  std::size_t known_then_ = 0;        ///< cells, at the end of the last round
  std::size_t victims_then_ = 0;      ///< likewise

  ExplorerState after_escape_ = ExplorerState::Driving;
  std::optional<TPoint2D> stuck_place_;
  int stuck_there_ = 0;
  int times_stuck_ = 0;
  int failed_escapes_ = 0;
};

}  // namespace rubble::explore
