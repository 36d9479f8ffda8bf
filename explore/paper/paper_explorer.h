#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "explore/caution/left_alone.h"
#include "explore/caution/trail.h"
#include "explore/explorer.h"
#include "explore/motion/pilot.h"
#include "explore/paper/agenda.h"
#include "explore/paper/close_looks.h"
#include "explore/paper/home_way.h"
#include "explore/paper/levelling_care.h"
#include "explore/paper/paper_config.h"
#include "explore/plan/traversable.h"
#include "explore/search/victim_watch.h"
#include "explore/stuck/recovery.h"
#include "explore/stuck/straight_on.h"
#include "explore/stuck/stuck_watch.h"
#include "robot/battery_watch.h"
#include "robot/model.h"

namespace rubble::explore {

/// The paper's explorer: Exploration Transform to a close frontier by a safe path, until nothing reachable is left;
/// then to places the victim sensors have not looked at, by the same transform.
///
/// It takes in what arrived and hands the tick on, by its state:
///
/// | state | who has the say | ends |
/// |---|---|---|
/// | Starting | nobody: it waits for the first mapped scan | with a look behind, if there is frontier near |
/// | Driving, Searching, GoingHome | Agenda, what to do next; Pilot, how | when StuckWatch finds it held |
/// | the same, Braking | StuckWatch, to tell whether a pose that stays fell behind | on the way again, or BackingUp |
/// | BackingUp | Recovery | as it was before, or stuck |
/// | Finished | nobody | |
///
/// Among Driving, Searching and GoingHome the Agenda alone changes.
class PaperExplorer : public Explorer {
 public:
  PaperExplorer(const robot::RobotModel& model, const PaperExplorerConfig& config, const Mission& mission = {});

  robot::Commands next(const slam::Mapper& mapper, const robot::Inputs& inputs) override;
  bool finished() const override { return agenda_.finished(); }
  const std::string& reason() const override { return agenda_.reason(); }
  MissionEnd end() const override { return agenda_.end(); }
  ExplorerState state() const override;
  const std::vector<Decision>& decisions() const override { return agenda_.decisions(); }
  const std::vector<mrpt::math::TPoint2D>& path() const override { return shown_path_; }
  const std::vector<VictimReport>& victims() const override { return victims_.reports(); }
  bool searched(const mrpt::math::TPoint2D& place) const override { return victims_.search().saw(place); }
  /// So much of the time limit is kept for the way home, beside the way itself [s].
  double time_for_home() const override { return config_.return_home ? home_way_.spare_time() : 0.0; }

 private:
  enum class Stage { Starting, OnTheWay, StraightOn, Braking, BackingUp };

  void observe(const slam::Mapper& mapper, const robot::Inputs& inputs);
  void follow_map(const slam::Mapper& mapper);
  void tell_victims();
  void heed_levelling();
  void heed_battery(const robot::Inputs& inputs);
  void call_it_a_day(const std::string& why);

  robot::Drive decide(const slam::Mapper& mapper);
  robot::Drive start(const slam::Mapper& mapper);
  robot::Drive go_on(const slam::Mapper& mapper);
  robot::Drive drive_straight_on(const slam::Mapper& mapper);
  robot::Drive brake(const slam::Mapper& mapper);
  robot::Drive back_up();

  bool holds_still();
  bool waits_for_mapper();
  bool asks_its_brake(const slam::Mapper& mapper);
  void look_back(const slam::Mapper& mapper);
  void check_path(const slam::Mapper& mapper);
  void get_free_of(const StuckWatch::Hold& hold, const slam::Mapper& mapper);
  std::optional<WayOut> way_out(const slam::Mapper& mapper);
  void replan(const slam::Mapper& mapper);
  void judge_holes(const slam::CountMap& map);
  void obey(Order order);
  void look_up_ground(PathPoint& point) const;

  /// The floor with `hits` [map frame] as further obstacles.
  Traversable floor_now(const slam::Mapper& mapper, const std::vector<mrpt::math::TPoint2D>& hits) const;
  Agenda::Situation situation();

  const robot::RobotModel model_;
  const PaperExplorerConfig config_;

  Agenda agenda_;
  Pilot pilot_;
  StuckWatch stuck_watch_;
  StuckWatch::Hold doubted_hold_;  ///< while it brakes to find out
  bool asks_blindly_ = false;      ///< it brakes though nothing says that it is held
  bool brake_tells_ = false;       ///< its brake told of a motion once
  double asked_at_ = 0.0;          ///< blind way at which it asked its brake last [m]
  Recovery recovery_;
  StraightOn straight_on_;
  VictimWatch victims_;
  LeftAlone left_alone_;
  CloseLooks close_looks_;
  Trail trail_;
  HomeWay home_way_;
  LevellingCare levelling_;
  std::optional<robot::BatteryWatch> battery_;  ///< once it is told

  Stage stage_ = Stage::Starting;
  Stamp now_ = Stamp::never();
  double dt_ = 0.0;  ///< of commands: a robot that was held meanwhile did not follow them
  Stamp last_scan_ = Stamp::never();
  mrpt::math::TPose2D pose_;
  std::optional<Stamp> waits_since_;  ///< for the mapper, in the doubt under way
  Stamp next_wait_ = Stamp::never();  ///< not before this
  double slope_ = 0.0;                ///< as known last [rad]
  double turned_ = 0.0;               ///< since the last tick [rad]
  std::uint64_t revision_ = 0;
  Traversable floor_;  ///< of the last plan
  robot::Drive commanded_;
  bool brakes_ = false;                 ///< this tick's command is to stop as hard as the base can
  double blind_ = 0.0;                  ///< the mapper's blind way [m] ...
  std::optional<double> look_back_at_;  ///< ... at which it looks back, if not as usual [m]
  std::vector<mrpt::math::TPoint2D> shown_path_;
  std::vector<VictimReport> told_victims_;  ///< as they were told of last, ids ascending
};

}  // namespace rubble::explore
