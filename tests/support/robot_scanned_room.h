#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/angle.h"
#include "robot/measurements.h"

namespace rubble::test {

struct Wall {
  double x1, y1, x2, y2;
};

/// A room of 4.4 x 3.2 m with a corner and a box; ranges to 4 m with 8 mm of noise, a beam in fifty lost.
class ScannedRoom {
 public:
  robot::LaserScan scan(const mrpt::math::TPose2D& T_room_laser, std::mt19937& random,
                        const std::vector<Wall>& guests = {}) const {
    std::normal_distribution<double> noise(0.0, 0.008);
    robot::LaserScan scan;
    scan.angle_min = deg_to_rad(-119.5);
    scan.angle_step = 2.0 * kPi / 1024.0;
    scan.range_min = 0.02;
    scan.range_max = 4.0;
    for (int i = 0; i < 682; ++i) {
      const double bearing = T_room_laser.phi + scan.bearing(static_cast<std::size_t>(i));
      double range = std::numeric_limits<double>::infinity();
      for (const auto* all : {&walls_, &guests})
        for (const Wall& wall : *all) range = std::min(range, hit(T_room_laser, bearing, wall));
      if (range > scan.range_max) range = std::numeric_limits<double>::infinity();
      if (random() % 50 == 0) range = std::numeric_limits<double>::quiet_NaN();
      scan.ranges.push_back(static_cast<float>(range + noise(random)));
    }
    return scan;
  }

 private:
  static double hit(const mrpt::math::TPose2D& from, double bearing, const Wall& w) {
    const double dx = std::cos(bearing), dy = std::sin(bearing), ex = w.x2 - w.x1, ey = w.y2 - w.y1;
    const double det = ex * dy - ey * dx, ox = w.x1 - from.x, oy = w.y1 - from.y;
    const double range = (ex * oy - ey * ox) / det, along = (dx * oy - dy * ox) / det;
    return std::abs(det) > 1e-9 && range > 0.0 && along >= 0.0 && along <= 1.0
               ? range
               : std::numeric_limits<double>::infinity();
  }
  std::vector<Wall> walls_{{0.0, 0.0, 4.4, 0.0}, {4.4, 0.0, 4.4, 3.2}, {4.4, 3.2, 1.2, 3.2}, {1.2, 3.2, 1.2, 2.4},
                           {1.2, 2.4, 0.0, 2.4}, {0.0, 2.4, 0.0, 0.0}, {3.0, 1.8, 3.4, 1.9}, {3.4, 1.9, 3.3, 2.3}};
};

}  // namespace rubble::test
