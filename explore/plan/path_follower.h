#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/model.h"

namespace rubble::explore {

/// What is known of the floor: nothing; the robot was there, and nothing lies on it that it would have felt; or it felt
/// so much in this arena that the next step is to be expected anywhere.
enum class Ground { New, Passed, Rough };

/// A point of a planned way and how far the nearest obstacle is from it.
struct PathPoint {
  mrpt::math::TPoint2D p_map;  ///< [m]
  double clearance = 0.0;      ///< [m]
  Ground ground = Ground::New;
  double slope = 0.0;  ///< of the floor, where the robot met it [rad]
};

constexpr double kLeastTurn = 0.20;  ///< skid steering does not turn more slowly than this [rad/s]

struct FollowerConfig {
  double cruise_speed = 0.4;                ///< [m/s]
  double passed_speed = 0.6;                ///< likewise, where the robot was before [m/s]
  double rough_speed = 0.4;                 ///< on rough ground at most [m/s]
  double slope_speed = 0.5;                 ///< on steep slopes at most [m/s]
  double turn_speed = deg_to_rad(60.0);     ///< [rad/s]
  double slope_turn = deg_to_rad(60.0);     ///< of turns on the spot on steep slopes at most [rad/s]
  double turn_in_place = deg_to_rad(35.0);  ///< heading error above which the robot turns on the spot [rad]
  double look_ahead = 0.35;                 ///< distance of the point steered to [m]
  double turn_done = deg_to_rad(8.0);       ///< heading error at which a turn on the spot ends [rad]
  double slow_clearance = 0.27;             ///< at this clearance and below: slow_speed [m]
  double full_clearance = 0.42;             ///< at this clearance and above: cruise or passed speed [m]
  double slow_speed = 0.15;                 ///< [m/s]
};

/// Turns a path into drive commands: pure pursuit (Coulter 1992), turning on the spot while the heading is far off,
/// at a speed that clearance, curvature and the braking distance to what comes next allow.
class PathFollower {
 public:
  PathFollower(const robot::RobotModel& model, const FollowerConfig& config);

  /// Replaces the path; it starts near the robot.
  void set_path(std::vector<PathPoint> path);
  void clear() { set_path({}); }

  /// The command for a robot at T_map_base that leans by `slope` [rad]; zero when there is no path or its end is
  /// reached.
  robot::Drive drive(const mrpt::math::TPose2D& T_map_base, double slope = 0.0);

  /// The robot is within 0.1 m of the end, or there is no path.
  bool arrived() const { return progress_ >= path_.size() || left() < kArrival; }
  /// How fast it turns on the spot on a slope [rad], [rad/s].
  double turn_speed_on(double slope) const;
  /// Way left along the path from the point nearest to the robot [m].
  double left() const;
  const std::vector<PathPoint>& path() const { return path_; }
  std::size_t progress() const { return progress_; }
  /// Of the turn on the spot under way [rad], signed; 0: none.
  double turn_left() const { return turn_left_; }

  static constexpr double kArrival = 0.10;  ///< [m]

 private:
  void plan_speeds();
  double speed_on(double slope) const;
  void advance(const mrpt::math::TPoint2D& p_map);
  mrpt::math::TPoint2D aim_point(const mrpt::math::TPoint2D& p_map) const;

  FollowerConfig config_;
  double brake_;       ///< deceleration the speed profile counts on [m/s^2]
  double turn_brake_;  ///< [rad/s^2]
  std::vector<PathPoint> path_;
  std::vector<double> way_;    ///< along the path from its start [m]
  std::vector<double> speed_;  ///< allowed at each point [m/s]
  std::size_t progress_ = 0;
  bool turning_ = false;
  double turn_left_ = 0.0;  ///< [rad]
};

/// The drive that turns the robot on the spot by `angle` and slows down in time.
robot::Drive turn_on_the_spot(double angle, double turn_speed, double turn_brake);

/// Counts the hits that lie within `radius` of the path's next `ahead` metres, those inside the robot's body left out.
int hits_on_path(const std::vector<PathPoint>& path, std::size_t from, double ahead, double radius,
                 const std::vector<mrpt::math::TPoint2D>& hits, const mrpt::math::TPose2D& T_map_base,
                 const robot::RobotModel& model);

}  // namespace rubble::explore
