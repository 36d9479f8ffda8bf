#pragma once

#include <string>
#include <vector>

#include "base/angle.h"
#include "base/yaml/binder.h"
#include "explore/caution/felt_obstacles.h"
#include "explore/explorer.h"
#include "explore/paper/frontier_worth.h"
#include "explore/paper/target_choice.h"
#include "explore/plan/path_follower.h"
#include "explore/plan/planner.h"
#include "explore/search/searched_area.h"
#include "explore/search/victim_search.h"
#include "explore/stuck/tilt_watch.h"
#include "robot/model.h"

namespace rubble::explore {

/// Parameters of autonomous exploration (paper section III.D, eqs. 3 and 4): of each part its own, and what the parts
/// share.
struct PaperExplorerConfig {
  PlannerConfig planner;
  FrontierChoiceConfig choice;
  Priorities priorities;
  FollowerConfig follower;
  VictimSearchConfig victims;
  SearchConfig search;
  FeltConfig felt;
  TiltWatchConfig tilt;
  double occupied_threshold = 0.5;        ///< p_occ from which a cell is an obstacle
  double replan_period = 0.5;             ///< [s]
  double scan_timeout = 0.3;              ///< without a scan for this long the robot stops [s]
  double first_turn = deg_to_rad(130.0);  ///< turn at the start that shows the scanner what is behind [rad]
  bool bar_targets = true;                ///< what could not be had is left alone; false: as in the paper, for ever
  bool return_home = true;                ///< drive back to the start in the end, in time
};

/// The keys of `explorer` with `kind: paper`.
void bind(Binder& binder, PaperExplorerConfig& config);

/// What is wrong with the parameters taken together, for people; empty: nothing.
std::string mistake(const PaperExplorerConfig& config);

/// What of them has no effect with that robot and mission, one line each: speeds above its limits, a search by senses
/// that it has not. Defaults are not told of: a robot may be slower than them.
std::vector<std::string> notes(const PaperExplorerConfig& config, const robot::RobotModel& model,
                               const Mission& mission);

}  // namespace rubble::explore
