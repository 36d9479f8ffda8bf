#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "slam/robust/graph/pose_graph.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// Finds the nodes that fit the edges best: Gauss-Newton on a sparse Cholesky factorisation, loops under dynamic
/// covariance scaling (Agarwal et al. 2013), which switches off what disagrees. Works on a copy, one step at a time, so
/// that a large graph is solved in slices.
class GraphSolver {
 public:
  enum class Plan {
    Refine,     ///< a few steps: loops agree nearly already
    Gradually,  ///< at first loops count in full, then doubt grows: plain scaling would refuse a true loop of metres
    Final       ///< gradually, and to the end
  };

  /// Takes the graph as it is now.
  void start(const PoseGraph& graph, Plan plan, double scaling);
  bool running() const { return running_; }
  /// One Gauss-Newton step; returns whether more are needed.
  bool step(Work& work);
  /// The nodes so far; those of the start of the solve.
  const std::vector<mrpt::math::TPose2D>& nodes() const { return graph_.nodes; }
  /// Covariance of the last node, in the frame of node 0, as of the last step.
  Eigen::Matrix3d covariance_of_last(Work* work = nullptr) const;
  /// How far the ends of an edge that took part would lie from what it measured, had it not taken part (to first
  /// order): what all others say about it (Baarda's data snooping). x, y along the axes of `from` [m], angle [rad];
  /// infinite when nothing else ties the two ends together.
  Eigen::Vector3d disagreement_without(const GraphEdge& edge, Work* work = nullptr) const;

 private:
  struct Phase {
    double scaling;
    int steps;
  };
  /// Part of the Jacobian: three rows of a node.
  struct Derivative {
    int node;
    Eigen::Matrix3d by_node;  ///< of what is asked for
  };
  void next_phase();
  void lay_out();
  double off_walls(const GraphWalls& walls) const;
  void add_to_diagonal(int node, const Eigen::Matrix3d& block);
  Eigen::Matrix3d covariance_of(const std::vector<Derivative>& derivatives, Work* work) const;

  PoseGraph graph_;
  std::vector<Phase> phases_;
  std::size_t phase_ = 0;
  int steps_left_ = 0;
  bool running_ = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
  Eigen::SparseMatrix<double> H_;      ///< lower triangle; its pattern stays from step to step
  std::vector<Eigen::Index> between_;  ///< of each edge: first of its block's values off the diagonal
  bool analysed_ = false;
};

}  // namespace rubble::slam
