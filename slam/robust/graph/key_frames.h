#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <utility>
#include <vector>

#include "base/stamp.h"
#include "slam/robust/graph/pose_graph.h"
#include "slam/robust/matching/cloud.h"
#include "slam/robust/matching/surfel_grid.h"
#include "slam/robust/matching/wall_direction.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

constexpr double kLoopLength = 0.3;  ///< what a loop adds to paths through the graph [m]

/// A scan that is kept for matching.
struct KeyFrame {
  Stamp stamp;
  Cloud cloud;
  double path = 0.0;  ///< length of the robot's path up to here [m]
  std::optional<WallDirection> walls;
};

/// The key frames of a drive with the graph of their poses.
class KeyFrames {
 public:
  KeyFrames() = default;
  /// As they were kept. before: of each the one that the robot came by, -1: none.
  KeyFrames(std::vector<KeyFrame> frames, std::vector<int> before, PoseGraph graph);

  int size() const { return static_cast<int>(frames_.size()); }
  int last() const { return size() - 1; }
  bool empty() const { return frames_.empty(); }
  const KeyFrame& operator[](int i) const { return frames_[static_cast<std::size_t>(i)]; }
  const mrpt::math::TPose2D& pose(int i) const { return graph_.nodes[static_cast<std::size_t>(i)]; }
  /// The one that the robot came by, -1: none.
  int before(int i) const { return before_[static_cast<std::size_t>(i)]; }
  const PoseGraph& graph() const { return graph_; }

  /// Adds a key frame; `edge`, to it from the one that the robot came by, is taken from the second on.
  void add(KeyFrame frame, const mrpt::math::TPose2D& pose, const GraphEdge& edge);
  /// Adds a key frame with which another drive begins; `edge`, from any other, holds it.
  void add_start(KeyFrame frame, const mrpt::math::TPose2D& pose, const GraphEdge& edge);
  /// Adds a loop of length `path` for the paths through the graph.
  void add_loop(const GraphEdge& edge, double path = kLoopLength);
  /// Takes poses for the first nodes; those behind follow the last of them.
  void move(const std::vector<mrpt::math::TPose2D>& poses);
  /// Takes the direction of the walls in the map for the graph, and how far those that one key frame sees run from it.
  void set_walls(double direction, double variance);
  /// Takes a loop out of the graph for good.
  void switch_off(std::size_t edge);

  /// Up to `most` key frames that end at i, in the order in which the robot came by, no more than `path` behind it.
  std::vector<int> ending_at(int i, int most, double path) const;
  /// Up to `most` key frames around i, the closest by path first, all below `limit`.
  std::vector<int> around(int i, int most, double path, int limit) const;
  /// Up to `most` key frames below `end` that lie within `distance` [m] of a pose, the closest first.
  std::vector<int> closest(const mrpt::math::TPose2D& pose, double distance, std::size_t most, int end) const;
  /// Surfels of key frames, seen from `origin`.
  void draw(const std::vector<int>& frames, const mrpt::math::TPose2D& origin, double cell, SurfelGrid& grid) const;
  /// Lengths of the shortest paths through the graph from i to `wanted` key frames, up to `most` [m]; infinite for
  /// those farther away. Stops once all are known.
  std::vector<double> paths_from(int i, const std::vector<int>& wanted, double most, Work* work = nullptr) const;

  /// How points, seen from `origin` (a pose of the graph) at `T_origin_points`, agree with what key frames saw.
  struct Agreement {
    int contradicted = 0;  ///< points in front of what was seen there
    int supported = 0;
    double contradiction() const {
      const int judged = contradicted + supported;
      return judged > 0 ? static_cast<double>(contradicted) / judged : 1.0;
    }
  };
  Agreement agreement(const std::vector<OrientedPoint>& points, const mrpt::math::TPose2D& T_origin_points,
                      const mrpt::math::TPose2D& origin, const std::vector<int>& frames,
                      SightFan::Slack slack = SightFan::Slack::AlongBeam) const;

 private:
  /// One end of an edge that is on, in the list of its node. All lists lie in one array, in the order in which edges
  /// came: a search along the drive reads it from front to back, and lists of their own would miss the caches.
  struct Link {
    double length;
    int to;
    int edge;
    int next;  ///< of the same node, -1: none
  };
  void link(std::size_t edge, double length);
  void take_walls(int i);

  std::vector<KeyFrame> frames_;
  std::vector<int> before_;  ///< the one that the robot came by, -1: none
  PoseGraph graph_;
  std::vector<Link> links_;
  std::vector<int> newest_link_;                      ///< of each key frame, -1: none
  mutable std::vector<double> paths_;                 ///< work space of paths_from()
  mutable std::vector<char> asked_;                   ///< work space of paths_from()
  mutable std::vector<std::pair<double, int>> open_;  ///< work space of paths_from()
};

}  // namespace rubble::slam
