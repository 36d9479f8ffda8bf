#include "slam/robust/graph/graph_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "slam/robust/matching/wall_direction.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kInFull = 1e12;      ///< a scaling that no loop feels
constexpr double kWallScaling = 4.0;  ///< of the directions of walls: what is off by some sigmas counts less
constexpr double kHeld = 1e9;         ///< information that holds node 0
constexpr double kLeast = 1e-6;       ///< information each node has of itself, against singular systems
constexpr double kConverged = 1e-3;   ///< largest change of a step [m; a third of it in rad]
constexpr Work kWorkPerEdge = 100;
constexpr Work kWorkPerNode = 60;
constexpr Work kWorkPerBlock = 12;     ///< of the factor, to solve by it
constexpr Work kWorkOfOrdering = 400;  ///< per edge

/// Share of its information that a loop keeps: (min(1, 2 phi / (phi + chi2)))^2, Agarwal et al. 2013, eq. (15).
double share(const GraphEdge& edge, const Eigen::Vector3d& r, double scaling) {
  if (!edge.loop) return 1.0;
  const double s = std::min(1.0, 2.0 * scaling / (scaling + r.dot(edge.information * r)));
  return s * s;
}

}  // namespace

void GraphSolver::start(const PoseGraph& graph, Plan plan, double scaling) {
  graph_ = graph;
  graph_.edges.erase(std::remove_if(graph_.edges.begin(), graph_.edges.end(), [](const GraphEdge& e) { return !e.on; }),
                     graph_.edges.end());
  // Decided once: of a wing that stands askew each key frame is doubted, but together they would be bent straight.
  graph_.walls.erase(std::remove_if(graph_.walls.begin(), graph_.walls.end(),
                                    [this](const GraphWalls& walls) {
                                      return !graph_.walls_direction || std::abs(off_walls(walls)) > kOtherWalls;
                                    }),
                     graph_.walls.end());
  if (plan == Plan::Refine)
    phases_ = {{scaling, 4}};
  else
    phases_ = {{kInFull, 8}, {std::max(1e4, scaling), 5}, {std::max(100.0, scaling), 5}, {scaling, 5}};
  if (plan == Plan::Final) phases_.back().steps = 20;
  phase_ = 0;
  steps_left_ = phases_.front().steps;
  stage_ = Stage::LayOut;
  laid_out_ = false;
  running_ = graph_.nodes.size() > 1;
}

/// How far the walls that a node sees run from the direction of all.
double GraphSolver::off_walls(const GraphWalls& walls) const {
  return wrap_quarter(graph_.nodes[static_cast<std::size_t>(walls.node)].phi + walls.angle - *graph_.walls_direction);
}

void GraphSolver::lay_out(Work& budget) {
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(graph_.edges.size());
  for (const GraphEdge& edge : graph_.edges) pairs.push_back({edge.from, edge.to});
  between_ = factor_.analyse(static_cast<int>(graph_.nodes.size()), pairs);
  laid_out_ = true;
  budget -= kWorkOfOrdering * static_cast<Work>(graph_.edges.size());
}

bool GraphSolver::advance(Work& budget) {
  while (running_ && budget > 0) {
    switch (stage_) {
      case Stage::LayOut:
        lay_out(budget);
        begin_step(budget);
        break;
      case Stage::Edges:
        for (; next_edge_ < graph_.edges.size() && budget > 0; budget -= kWorkPerEdge) add_edge(next_edge_++);
        if (next_edge_ == graph_.edges.size()) stage_ = Stage::Factorise;
        break;
      case Stage::Factorise:
        if (!factor_.factorise(budget)) break;
        move_nodes(budget);
        if (running_) begin_step(budget);
    }
  }
  return running_;
}

/// With what each node says of itself.
void GraphSolver::begin_step(Work& budget) {
  const int nodes = static_cast<int>(graph_.nodes.size());
  if (stage_ != Stage::LayOut) factor_.clear();
  gradient_ = Eigen::VectorXd::Zero(3 * nodes);
  for (int node = 0; node < nodes; ++node)
    factor_.diagonal(node) = (node == 0 ? kHeld : kLeast) * Eigen::Matrix3d::Identity();
  for (const GraphWalls& walls : graph_.walls) add_walls(walls);
  next_edge_ = 0;
  stage_ = Stage::Edges;
  budget -= kWorkPerNode * static_cast<Work>(nodes);
}

void GraphSolver::add_walls(const GraphWalls& walls) {
  const double off = off_walls(walls);
  const double information = 1.0 / (graph_.walls_variance + walls.variance);
  const double s = std::min(1.0, 2.0 * kWallScaling / (kWallScaling + information * off * off));
  factor_.diagonal(walls.node)(2, 2) += s * s * information;
  gradient_[3 * walls.node + 2] -= s * s * information * off;
}

void GraphSolver::add_edge(std::size_t k) {
  const GraphEdge& edge = graph_.edges[k];
  const Linearised lin = linearise(edge, graph_.nodes[static_cast<std::size_t>(edge.from)],
                                   graph_.nodes[static_cast<std::size_t>(edge.to)]);
  const Eigen::Matrix3d information = share(edge, lin.r, phases_[phase_].scaling) * edge.information;
  const Eigen::Matrix3d from = lin.by_from.transpose() * information;
  const Eigen::Matrix3d to = lin.by_to.transpose() * information;
  factor_.diagonal(edge.from).noalias() += from * lin.by_from;
  factor_.diagonal(edge.to).noalias() += to * lin.by_to;
  if (between_[k].first_is_row)
    factor_.between(between_[k]).noalias() += from * lin.by_to;
  else
    factor_.between(between_[k]).noalias() += to * lin.by_from;
  gradient_.segment<3>(3 * edge.from).noalias() -= from * lin.r;
  gradient_.segment<3>(3 * edge.to).noalias() -= to * lin.r;
}

void GraphSolver::move_nodes(Work& budget) {
  running_ = false;
  if (!factor_.factorised()) return;
  budget -= kWorkPerBlock * factor_.blocks() + kWorkPerNode * factor_.nodes();
  const Eigen::VectorXd d = factor_.solve(gradient_);
  if (!d.allFinite()) return;
  running_ = true;
  double largest = 0.0;
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    TPose2D& pose = graph_.nodes[k];
    const auto i = static_cast<Eigen::Index>(3 * k);
    pose = {pose.x + d[i], pose.y + d[i + 1], wrap_angle(pose.phi + d[i + 2])};
    largest = std::max({largest, std::abs(d[i]), std::abs(d[i + 1]), 3.0 * std::abs(d[i + 2])});
  }
  if (--steps_left_ == 0 || largest < kConverged) next_phase();
}

void GraphSolver::next_phase() {
  if (++phase_ == phases_.size())
    running_ = false;
  else
    steps_left_ = phases_[phase_].steps;
}

Eigen::Matrix3d GraphSolver::covariance_of_last(Work* work) const {
  if (!solved()) return Eigen::Matrix3d::Zero();
  return factor_.covariance({{static_cast<int>(graph_.nodes.size()) - 1, Eigen::Matrix3d::Identity()}}, work);
}

/// With P the covariance that all edges leave to the residual, W what the edge puts in: r_without = (I - P W)^-1 r.
Eigen::Vector3d GraphSolver::disagreement_without(const GraphEdge& edge, Work* work) const {
  constexpr double kAlone = 1e-6;
  const Linearised lin = linearise(edge, graph_.nodes[static_cast<std::size_t>(edge.from)],
                                   graph_.nodes[static_cast<std::size_t>(edge.to)]);
  if (!solved()) return lin.r;
  const Eigen::Matrix3d P = factor_.covariance({{edge.from, lin.by_from}, {edge.to, lin.by_to}}, work);
  const Eigen::Matrix3d W = share(edge, lin.r, phases_.back().scaling) * edge.information;
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - P * W;
  if (std::abs(rest.determinant()) < kAlone) return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return rest.inverse() * lin.r;
}

}  // namespace rubble::slam
