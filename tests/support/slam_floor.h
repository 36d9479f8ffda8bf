#pragma once

#include <cstdint>
#include <vector>

#include "base/rng.h"
#include "tests/support/slam_world.h"

namespace rubble::slam_test {

/// A floor of rooms of 3 x 3 m with doors and furniture that a seed places: all floors have the same outer walls. The
/// middle of room (column, row) lies at (3 column, 3 row); on the way from one to the next `door` stands between.
class Floor {
 public:
  Floor(std::uint64_t seed, int columns, int rows) : columns_(columns) {
    Rng rng(seed, "floor");
    add_box(world_, -1.5, -1.5, 3.0 * columns - 1.5, 3.0 * rows - 1.5);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double x = 3.0 * column;
        const double y = 3.0 * row;
        const double to_the_right = rng.uniform(-0.5, 0.5);
        const double up = rng.uniform(-0.5, 0.5);
        doors_.push_back({{x + 1.5, y + to_the_right}, {x + up, y + 1.5}});
        if (column + 1 < columns) {
          world_.push_back({{x + 1.5, y - 1.5}, {x + 1.5, y + to_the_right - 0.45}});
          world_.push_back({{x + 1.5, y + to_the_right + 0.45}, {x + 1.5, y + 1.5}});
        }
        if (row + 1 < rows) {
          world_.push_back({{x - 1.5, y + 1.5}, {x + up - 0.45, y + 1.5}});
          world_.push_back({{x + up + 0.45, y + 1.5}, {x + 1.5, y + 1.5}});
        }
        for (const double side : {-1.0, 1.0})
          for (const double end : {-1.0, 1.0}) {
            const double cx = x + side * rng.uniform(1.05, 1.4);
            const double cy = y + end * rng.uniform(1.05, 1.4);
            const double w = rng.uniform(0.05, 0.2);
            const double h = rng.uniform(0.05, 0.2);
            if (rng.uniform() < 0.7) add_box(world_, cx - w, cy - h, cx + w, cy + h);
          }
      }
  }

  const World& world() const { return world_; }
  static TPoint2D middle(int column, int row) { return {3.0 * column, 3.0 * row}; }

  /// The way through rooms that lie side by side, by their doors.
  std::vector<TPoint2D> way(const std::vector<Cell>& rooms) const {
    std::vector<TPoint2D> points{middle(rooms.front().x, rooms.front().y)};
    for (std::size_t i = 1; i < rooms.size(); ++i) {
      const Cell& a = rooms[i - 1];
      const Cell& b = rooms[i];
      const Doors& doors = doors_[static_cast<std::size_t>(std::min(a.y, b.y) * columns_ + std::min(a.x, b.x))];
      points.push_back(a.y == b.y ? doors.right : doors.up);
      points.push_back(middle(b.x, b.y));
    }
    return points;
  }

 private:
  struct Doors {
    TPoint2D right, up;
  };
  int columns_;
  World world_;
  std::vector<Doors> doors_;
};

/// Ticks as if they had been recorded right behind `before`: a robot that was lifted and set down, whose wheels did not
/// turn meanwhile.
inline std::vector<robot::Inputs> spliced(std::vector<robot::Inputs> before, const std::vector<robot::Inputs>& after) {
  const std::int64_t later = before.back().now.ns + 100000000 - after.front().now.ns;
  const TPose2D T_odom_last = before.back().odometry.back().pose;
  const TPose2D T_odom_first = after.front().odometry.front().pose;
  for (robot::Inputs tick : after) {
    tick.now.ns += later;
    for (robot::Odometry& o : tick.odometry) {
      o.stamp.ns += later;
      o.pose = T_odom_last + (o.pose - T_odom_first);
    }
    for (robot::LaserScan& scan : tick.scans) scan.stamp.ns += later;
    before.push_back(tick);
  }
  return before;
}

}  // namespace rubble::slam_test
