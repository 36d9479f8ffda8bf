#pragma once

#include <vector>

#include "base/planar.h"
#include "slam/robust/graph/key_frames.h"
#include "slam/scan/level_scan.h"
#include "tests/support/slam_world.h"

namespace rubble::slam_test {

/// A level scan of the world without noise, as the matching sees it.
inline slam::Cloud cloud_at(const World& world, const TPose2D& T_world_base, const robot::RobotModel& model) {
  Rng silent(1, "scan");
  slam::LevelScan level(model.T_base_laser, {});
  const slam::ScanPoints points = level.points(scan_at(world, T_world_base, model, Stamp{0}, 0.0, silent));
  slam::Cloud cloud = slam::cloud_of(points, {});
  cloud.sight = slam::sight_of(points);
  return cloud;
}

/// Places about `spacing` apart on the way through the points, each looking ahead.
inline std::vector<TPose2D> places_along(const std::vector<TPoint2D>& points, double spacing) {
  std::vector<TPose2D> places;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const TPoint2D way = points[i + 1] - points[i];
    const int pieces = std::max(1, static_cast<int>(std::lround(length(way) / spacing)));
    for (int k = 0; k < pieces; ++k) {
      const TPoint2D p = points[i] + way * (static_cast<double>(k) / pieces);
      places.push_back({p.x, p.y, std::atan2(way.y, way.x)});
    }
  }
  places.push_back({points.back().x, points.back().y, places.back().phi});
  return places;
}

/// Adds the key frame of the next place to a drive. `bend`: what the estimate turns too far per metre [rad/m].
inline void add_key_frame(slam::KeyFrames& frames, const World& world, const std::vector<TPose2D>& places, double bend,
                          const robot::RobotModel& model) {
  const auto next = static_cast<std::size_t>(frames.size());
  slam::KeyFrame frame;
  frame.stamp = Stamp{frames.size() * 1000000000ll};
  frame.cloud = cloud_at(world, places[next], model);
  if (next == 0) return frames.add(std::move(frame), {}, {});
  const TPose2D step = places[next] - places[next - 1];
  const double path = length(step.x, step.y);
  frame.path = frames[frames.last()].path + path;
  slam::GraphEdge edge;
  edge.from = frames.last();
  edge.to = frames.size();
  edge.T_from_to = {step.x, step.y, step.phi + bend * path};
  edge.information = Eigen::Vector3d(1.0 / 4e-4, 1.0 / 4e-4, 1.0 / 4e-4).asDiagonal();
  frames.add(std::move(frame), frames.pose(frames.last()) + edge.T_from_to, edge);
}

/// Root mean square error of the key frames, the first on the truth [m].
inline double key_frame_rmse(const slam::KeyFrames& frames, const std::vector<TPose2D>& places) {
  double sum = 0.0;
  for (int i = 0; i < frames.size(); ++i) {
    const TPose2D truth = places[static_cast<std::size_t>(i)] - places.front();
    sum += std::pow(frames.pose(i).x - truth.x, 2) + std::pow(frames.pose(i).y - truth.y, 2);
  }
  return std::sqrt(sum / frames.size());
}

/// Loops in force that say something else than the truth by more than `off` [m].
inline int false_loops(const slam::KeyFrames& frames, const std::vector<TPose2D>& places, double off) {
  int count = 0;
  for (const slam::GraphEdge& edge : frames.graph().edges) {
    if (!edge.loop || !edge.on) continue;
    const TPose2D truth = places[static_cast<std::size_t>(edge.to)] - places[static_cast<std::size_t>(edge.from)];
    const TPose2D error = edge.T_from_to - truth;
    count += length(error.x, error.y) > off ? 1 : 0;
  }
  return count;
}

}  // namespace rubble::slam_test
