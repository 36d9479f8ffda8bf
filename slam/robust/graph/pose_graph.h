#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace rubble::slam {

/// What was measured between two nodes.
struct GraphEdge {
  int from = 0;
  int to = 0;
  mrpt::math::TPose2D T_from_to;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< along the axes of `from`
  bool loop = false;  ///< may be wrong: scaled down where it disagrees with the rest
  bool on = true;     ///< off: found wrong
};

/// Walls that a node saw.
struct GraphWalls {
  int node = 0;
  double angle = 0.0;     ///< of the walls in the frame of the node, within a quarter turn [rad]
  double variance = 0.0;  ///< of that [rad^2]
};

/// Poses and what was measured between them. Node 0 is the origin.
struct PoseGraph {
  std::vector<mrpt::math::TPose2D> nodes;
  std::vector<GraphEdge> edges;
  std::vector<GraphWalls> walls;
  std::optional<double>
      walls_direction;          ///< of all walls in the map, within a quarter turn [rad]; none: walls say nothing
  double walls_variance = 1.0;  ///< of those that one node sees, about it [rad^2]
};

/// Residual of an edge and its derivatives by the two poses.
struct Linearised {
  Eigen::Vector3d r;
  Eigen::Matrix3d by_from;
  Eigen::Matrix3d by_to;
};

Linearised linearise(const GraphEdge& edge, const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to);

/// How far the two ends of an edge lie from what it measured.
mrpt::math::TPose2D disagreement(const PoseGraph& graph, const GraphEdge& edge);
/// The same in squared sigmas of the edge.
double squared_sigmas(const PoseGraph& graph, const GraphEdge& edge);

}  // namespace rubble::slam
