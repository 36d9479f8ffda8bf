#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/planar.h"
#include "slam/mapper.h"
#include "tests/support/slam_world.h"

namespace rubble::slam_test {

/// How well a mapper has done on a drive through a world of axis-parallel walls.
struct Outcome {
  double rmse = 0.0;     ///< of the positions, first poses laid on each other [m]
  double heading = 0.0;  ///< worst error [rad]
  double outside = 0.0;  ///< share of the occupied cells that lie more than 0.1 m off the walls
  int occupied = 0;      ///< cells
};

inline double distance_to(const World& world, const TPoint2D& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& s : world) {
    const double dx = std::max({std::min(s.a.x, s.b.x) - p.x, p.x - std::max(s.a.x, s.b.x), 0.0});
    const double dy = std::max({std::min(s.a.y, s.b.y) - p.y, p.y - std::max(s.a.y, s.b.y), 0.0});
    nearest = std::min(nearest, std::hypot(dx, dy));
  }
  return nearest;
}

/// Counts the occupied cells, and those that lie off the walls of a world in which the map lies at `T_world_map`.
inline void judge_map(const slam::CountMap& map, const World& world, const TPose2D& T_world_map, Outcome& out) {
  const OccupancyGrid grid = map.classify();
  const PlanarTransform to_world(T_world_map);
  out.occupied = 0;
  int off = 0;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] != Occupancy::Occupied) continue;
      ++out.occupied;
      off += distance_to(world, to_world(grid.centre({x, y}))) > 0.10 ? 1 : 0;
    }
  out.outside = out.occupied > 0 ? static_cast<double>(off) / out.occupied : 1.0;
}

/// Plays `ticks` to their end.
inline void play(slam::Mapper& mapper, const std::vector<robot::Inputs>& ticks) {
  for (const robot::Inputs& tick : ticks) mapper.update(tick);
  mapper.finish();
}

/// What the mapper says of itself under `key`.
inline double figure(const slam::Mapper& mapper, const std::string& key) {
  for (const slam::MapperFigure& f : mapper.figures())
    if (f.key == key) return f.value;
  ADD_FAILURE() << "no figure " << key;
  return -1.0;
}

/// Plays `ticks` of a drive that begins at the world's origin with heading 0.
inline Outcome play(slam::Mapper& mapper, const std::vector<robot::Inputs>& ticks, const World& world,
                    const Trajectory& truth) {
  play(mapper, ticks);
  Outcome out;
  out.rmse = first_pose_rmse(mapper.trajectory(), truth);
  for (const StampedPose& e : mapper.trajectory()) {
    const auto t = pose_at(truth, e.stamp);
    if (t) out.heading = std::max(out.heading, std::abs(wrap_angle(e.pose.phi - (*t - truth.front().pose).phi)));
  }
  judge_map(mapper.map(), world, {}, out);
  return out;
}

}  // namespace rubble::slam_test
