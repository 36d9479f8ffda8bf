#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "slam/robust/graph/block_cholesky.h"
#include "slam/robust/graph/pose_graph.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// Finds the nodes that fit the edges best: Gauss-Newton on a sparse Cholesky factorisation, loops under dynamic
/// covariance scaling (Agarwal et al. 2013), which switches off what disagrees. Works on a copy, bit by bit, so that a
/// large graph is solved in slices; the bits are the same however it is cut.
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
  /// Goes on until the budget is spent; returns whether more is needed.
  bool advance(Work& budget);
  /// Whether the last step could be made: its system was positive definite.
  bool solved() const { return laid_out_ && factor_.factorised(); }
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
  /// Of a Gauss-Newton step.
  enum class Stage { LayOut, Edges, Factorise };
  void lay_out(Work& budget);
  void begin_step(Work& budget);
  void add_edge(std::size_t edge);
  void add_walls(const GraphWalls& walls);
  void move_nodes(Work& budget);
  void next_phase();
  double off_walls(const GraphWalls& walls) const;

  PoseGraph graph_;
  std::vector<Phase> phases_;
  std::size_t phase_ = 0;
  int steps_left_ = 0;
  bool running_ = false;
  Stage stage_ = Stage::LayOut;
  bool laid_out_ = false;
  std::size_t next_edge_ = 0;
  BlockCholesky factor_;                       ///< of the information matrix; its pattern stays from step to step
  std::vector<BlockCholesky::Place> between_;  ///< of each edge
  Eigen::VectorXd gradient_;                   ///< the right side: -J^T W r
};

}  // namespace rubble::slam
