#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "explore/searched_area.h"
#include "explore/victim_search.h"
#include "robot/commands.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// Parameters of autonomous exploration (paper section III.D, eqs. 3 and 4).
struct ExplorerConfig {
  double alpha = 20.0;                      ///< weight of discomfort against length, per metre travelled
  double d_min = 0.35;                      ///< never closer to an obstacle [m]
  double d_opt = 0.60;                      ///< distance to obstacles the robot likes best [m]
  double occupied_threshold = 0.5;          ///< p_occ from which a cell is an obstacle
  int min_frontier_cells = 5;               ///< smaller frontier clusters are not worth a drive
  double replan_period = 0.5;               ///< [s]
  double cruise_speed = 0.4;                ///< [m/s]
  double turn_speed = deg_to_rad(60.0);     ///< [rad/s]
  double turn_in_place = deg_to_rad(35.0);  ///< heading error above which the robot turns on the spot [rad]
  double look_ahead = 0.35;                 ///< distance of the point on the path the robot steers to [m]
  bool return_home = false;                 ///< drive back to the start when nothing is left to explore
  double d_min_floor = 0.27;                ///< d_min may fall to this when nothing can be reached otherwise [m]
  double switch_cost = 0.6;                 ///< a new target must be this much cheaper than the old one [m]
  double scan_timeout = 0.3;                ///< without a scan for this long the robot stops [s]
  double first_turn = deg_to_rad(130.0);    ///< turn at the start that shows the scanner what is behind [rad]
  VictimSearchConfig victims;
  SearchConfig search;
};

enum class ExplorerState { Starting, Driving, Searching, BackingUp, GoingHome, Finished };

/// Decides where to drive: Exploration Transform to a close frontier by a safe path, until nothing reachable is left;
/// then to places the victim sensors have not looked at, by the same transform.
class Explorer {
 public:
  Explorer(const robot::RobotModel& model, const ExplorerConfig& config);
  ~Explorer();

  /// The drive command for this tick (the laser aim is left at zero: levelling owns it).
  robot::Commands next(const slam::Mapper& mapper, const robot::Inputs& inputs);

  bool finished() const;
  /// Why it finished, for people; empty while it runs.
  const std::string& reason() const;
  ExplorerState state() const;
  /// The path being followed, map frame, robot first.
  const std::vector<mrpt::math::TPoint2D>& path() const;
  const std::vector<VictimReport>& victims() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::explore
