#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/robust/graph/pose_graph.h"
#include "slam/robust/matching/wall_direction.h"

namespace rubble::slam {

/// Keeps the heading by the walls. Those of one building mostly run one way or across it (Coughlan and Yuille 1999),
/// which tells the heading without drift, but for quarter turns. A Kalman filter over the pose of the newest key frame,
/// whose covariance belongs to the caller, and the direction of the walls in the map. How far it trusts the walls
/// follows from how well they have agreed so far: where they stand askew, they say next to nothing.
class WallCompass {
 public:
  /// The robot goes on to another key frame, whose pose changes by `by_pose` with that of the one before.
  void go_on(const Eigen::Matrix3d& by_pose) { with_pose_ = by_pose * with_pose_; }
  /// What is to be added to the pose of the key frame (x, y, heading in the map) for the walls that it sees; takes what
  /// that tells out of the covariance of the pose.
  Eigen::Vector3d look(double heading, const std::optional<WallDirection>& walls, Eigen::Matrix3d& covariance);
  /// Takes the direction in which most walls of a graph run: its poses were corrected, or it is another's.
  void set_right(const PoseGraph& graph);

  /// Of the walls in the map; nothing while none were seen.
  std::optional<double> direction() const { return direction_; }
  /// Of the walls that one key frame sees, about that direction [rad^2].
  double variance() const;
  /// Whether the last key frames saw walls that run another way: the first ones may have been askew.
  bool doubted() const;

 private:
  void learn(double off);

  std::optional<double> direction_;
  double direction_variance_ = 0.0;
  Eigen::Vector3d with_pose_ = Eigen::Vector3d::Zero();  ///< covariance of the direction with the pose
  double squares_ = 0.0;                                 ///< of how far walls were off [rad^2]
  int seen_ = 0;                                         ///< so many times
  int strangers_ = 0;                                    ///< key frames on end whose walls run another way
};

}  // namespace rubble::slam
