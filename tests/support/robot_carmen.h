#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "base/trajectory.h"

namespace rubble::robot::testing {

/// Writes CARMEN text line by line.
class CarmenWriter {
 public:
  std::string text;

  void odom(const mrpt::math::TPose2D& p, double time, double v = 0.0, double w = 0.0) {
    char line[256];
    std::snprintf(line, sizeof line, "ODOM %.9f %.9f %.9f %g %g 0 %.6f host %.6f\n", p.x, p.y, p.phi, v, w, time, time);
    text += line;
  }
  void flaser(const std::vector<double>& ranges, const mrpt::math::TPose2D& laser, const mrpt::math::TPose2D& robot,
              double time) {
    text += "FLASER " + std::to_string(ranges.size());
    char field[64];
    for (const double range : ranges) {
      std::snprintf(field, sizeof field, " %.3f", range);
      text += field;
    }
    for (const auto& p : {laser, robot}) {
      char pose[128];
      std::snprintf(pose, sizeof pose, " %.9f %.9f %.9f", p.x, p.y, p.phi);
      text += pose;
    }
    std::snprintf(field, sizeof field, " %.6f host %.6f\n", time, time);
    text += field;
  }
};

/// A robot that drives along an arc, 0.02 m and 0.01 rad a step.
inline std::vector<mrpt::math::TPose2D> arc(int steps) {
  std::vector<mrpt::math::TPose2D> poses{{0, 0, 0}};
  for (int i = 1; i < steps; ++i) {
    mrpt::math::TPose2D next = poses.back() + mrpt::math::TPose2D(0.02, 0.0, 0.01);
    next.phi = wrap_angle(next.phi);
    poses.push_back(next);
  }
  return poses;
}

}  // namespace rubble::robot::testing
