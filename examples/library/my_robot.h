// A robot of one's own: a point that drives as it is told in an empty room of 7 x 5 m, with a perfect scanner.
#pragma once

#include <rubble/robot/robot.h>

#include <algorithm>
#include <cmath>
#include <limits>

class MyRobot : public rubble::robot::Robot {
 public:
  const rubble::robot::RobotModel& model() const override { return model_; }

  std::optional<rubble::robot::Inputs> read() override {
    if (++tick_ > 6000) return std::nullopt;  // two minutes of its battery
    pose_ = pose_ + mrpt::math::TPose2D(drive_.v * model_.tick, 0.0, drive_.w * model_.tick);
    rubble::robot::Inputs inputs;
    inputs.now = rubble::Stamp::from_seconds(tick_ * model_.tick);
    inputs.odometry.push_back({inputs.now, pose_, drive_.v, drive_.w, false});
    if (tick_ % 5 == 0) inputs.scans.push_back(scan(inputs.now));
    return inputs;
  }
  void command(const rubble::robot::Commands& commands) override { drive_ = commands.drive; }

 private:
  rubble::robot::LaserScan scan(rubble::Stamp now) const {
    rubble::robot::LaserScan scan;
    scan.stamp = now;
    scan.angle_min = model_.laser.angle_min;
    scan.angle_step = model_.laser.angle_step;
    scan.range_min = model_.laser.range_min;
    scan.range_max = model_.laser.range_max;
    const auto p = pose_.composePoint({model_.T_base_laser.x, model_.T_base_laser.y});
    for (int beam = 0; beam < model_.laser.beams; ++beam) {
      const double bearing = pose_.phi + scan.bearing(static_cast<std::size_t>(beam));
      const double dx = std::cos(bearing), dy = std::sin(bearing);
      const double to_side = dx > 0 ? (5.0 - p.x) / dx : (-2.0 - p.x) / dx;  // walls x = -2 and 5
      const double to_end = dy > 0 ? (3.0 - p.y) / dy : (-2.0 - p.y) / dy;   // walls y = -2 and 3
      const double range = std::min(to_side, to_end);
      scan.ranges.push_back(range < scan.range_max ? static_cast<float>(range)
                                                   : std::numeric_limits<float>::infinity());
    }
    return scan;
  }

  rubble::robot::RobotModel model_;
  mrpt::math::TPose2D pose_;
  rubble::robot::Drive drive_;
  int tick_ = 0;
};
