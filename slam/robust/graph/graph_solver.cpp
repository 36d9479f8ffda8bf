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
constexpr Work kWorkPerEdge = 300;
constexpr Work kWorkPerNode = 600;
constexpr Work kWorkOfOrdering = 400;  ///< per edge
constexpr Work kWorkPerReached = 5;    ///< of an entry of the factor

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
  analysed_ = false;
  running_ = graph_.nodes.size() > 1;
}

/// How far the walls that a node sees run from the direction of all.
double GraphSolver::off_walls(const GraphWalls& walls) const {
  return wrap_quarter(graph_.nodes[static_cast<std::size_t>(walls.node)].phi + walls.angle - *graph_.walls_direction);
}

/// The pattern of the information matrix: of each column the rest of its node's own block, then a block for each later
/// node that an edge ties to it.
void GraphSolver::lay_out() {
  const std::size_t nodes = graph_.nodes.size();
  std::vector<std::vector<int>> later(nodes);
  for (const GraphEdge& edge : graph_.edges)
    later[static_cast<std::size_t>(std::min(edge.from, edge.to))].push_back(std::max(edge.from, edge.to));
  std::size_t blocks = 0;
  for (std::vector<int>& rows : later) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    blocks += rows.size();
  }
  const int size = 3 * static_cast<int>(nodes);
  H_ = Eigen::SparseMatrix<double>(size, size);
  H_.resizeNonZeros(static_cast<Eigen::Index>(6 * nodes + 9 * blocks));
  int next = 0;
  for (int node = 0; node < static_cast<int>(nodes); ++node)
    for (int v = 0; v < 3; ++v) {
      H_.outerIndexPtr()[3 * node + v] = next;
      for (int u = v; u < 3; ++u) H_.innerIndexPtr()[next++] = 3 * node + u;
      for (const int row : later[static_cast<std::size_t>(node)])
        for (int u = 0; u < 3; ++u) H_.innerIndexPtr()[next++] = 3 * row + u;
    }
  H_.outerIndexPtr()[size] = next;
  between_.clear();
  between_.reserve(graph_.edges.size());
  for (const GraphEdge& edge : graph_.edges) {
    const int node = std::min(edge.from, edge.to);
    const std::vector<int>& rows = later[static_cast<std::size_t>(node)];
    between_.push_back(3 * (std::lower_bound(rows.begin(), rows.end(), std::max(edge.from, edge.to)) - rows.begin()));
  }
}

void GraphSolver::add_to_diagonal(int node, const Eigen::Matrix3d& block) {
  for (int v = 0; v < 3; ++v)
    for (int u = v; u < 3; ++u) H_.valuePtr()[H_.outerIndexPtr()[3 * node + v] + u - v] += block(u, v);
}

bool GraphSolver::step(Work& work) {
  if (!running_) return false;
  const int size = 3 * static_cast<int>(graph_.nodes.size());
  if (!analysed_) lay_out();
  std::fill(H_.valuePtr(), H_.valuePtr() + H_.nonZeros(), 0.0);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
    const GraphEdge& edge = graph_.edges[k];
    const Linearised lin = linearise(edge, graph_.nodes[static_cast<std::size_t>(edge.from)],
                                     graph_.nodes[static_cast<std::size_t>(edge.to)]);
    const Eigen::Matrix3d information = share(edge, lin.r, phases_[phase_].scaling) * edge.information;
    const Eigen::Matrix3d from = lin.by_from.transpose() * information;
    const Eigen::Matrix3d to = lin.by_to.transpose() * information;
    add_to_diagonal(edge.from, from * lin.by_from);
    add_to_diagonal(edge.to, to * lin.by_to);
    const Eigen::Matrix3d between = edge.to > edge.from ? Eigen::Matrix3d(to * lin.by_from) : from * lin.by_to;
    for (int v = 0; v < 3; ++v) {
      double* column = H_.valuePtr() + H_.outerIndexPtr()[3 * std::min(edge.from, edge.to) + v] + 3 - v + between_[k];
      for (int u = 0; u < 3; ++u) column[u] += between(u, v);
    }
    b.segment<3>(3 * edge.from) -= from * lin.r;
    b.segment<3>(3 * edge.to) -= to * lin.r;
  }
  for (const GraphWalls& walls : graph_.walls) {
    const double off = off_walls(walls);
    const double information = 1.0 / (graph_.walls_variance + walls.variance);
    const double s = std::min(1.0, 2.0 * kWallScaling / (kWallScaling + information * off * off));
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    block(2, 2) = s * s * information;
    add_to_diagonal(walls.node, block);
    b[3 * walls.node + 2] -= block(2, 2) * off;
  }
  for (int node = 0; node < static_cast<int>(graph_.nodes.size()); ++node)
    add_to_diagonal(node, (node == 0 ? kHeld : kLeast) * Eigen::Matrix3d::Identity());
  if (!analysed_) {
    factor_.analyzePattern(H_);
    work += kWorkOfOrdering * static_cast<Work>(graph_.edges.size());
  }
  analysed_ = true;
  factor_.factorize(H_);
  work += kWorkPerEdge * static_cast<Work>(graph_.edges.size()) + kWorkPerNode * static_cast<Work>(graph_.nodes.size());
  if (factor_.info() != Eigen::Success) return running_ = false;
  const Eigen::VectorXd d = factor_.solve(b);
  if (!d.allFinite()) return running_ = false;

  double largest = 0.0;
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    TPose2D& pose = graph_.nodes[k];
    const auto i = static_cast<Eigen::Index>(3 * k);
    pose = {pose.x + d[i], pose.y + d[i + 1], wrap_angle(pose.phi + d[i + 2])};
    largest = std::max({largest, std::abs(d[i]), std::abs(d[i + 1]), 3.0 * std::abs(d[i + 2])});
  }
  if (--steps_left_ == 0 || largest < kConverged) next_phase();
  return running_;
}

void GraphSolver::next_phase() {
  if (++phase_ == phases_.size())
    running_ = false;
  else
    steps_left_ = phases_[phase_].steps;
}

/// J A^-1 J^T for few nonzero columns of J: with A = L D L^T only the columns of L that these reach are looked at.
Eigen::Matrix3d GraphSolver::covariance_of(const std::vector<Derivative>& derivatives, Work* work) const {
  const auto size = static_cast<Eigen::Index>(3 * graph_.nodes.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> y(size, 3);
  y.setZero();
  Eigen::Index first = size;
  for (const Derivative& d : derivatives)
    for (int u = 0; u < 3; ++u) {
      const Eigen::Index row = factor_.permutationP().indices()[3 * d.node + u];
      y.row(row) += d.by_node.col(u).transpose();
      first = std::min(first, row);
    }
  const auto& L = factor_.matrixL().nestedExpression();
  const auto& D = factor_.vectorD();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Work reached = 0;
  for (Eigen::Index column = first; column < size; ++column) {
    const Eigen::RowVector3d here = y.row(column);
    if (here.isZero(0.0)) continue;
    covariance += here.transpose() * (here / D[column]);
    for (Eigen::SparseMatrix<double>::InnerIterator it(L, column); it; ++it) {
      if (it.row() != column) y.row(it.row()) -= it.value() * here;
      ++reached;
    }
  }
  if (work != nullptr) *work += kWorkPerReached * reached + static_cast<Work>(size) * 2;
  return covariance;
}

Eigen::Matrix3d GraphSolver::covariance_of_last(Work* work) const {
  if (!analysed_ || factor_.info() != Eigen::Success || graph_.nodes.size() < 2) return Eigen::Matrix3d::Zero();
  return covariance_of({{static_cast<int>(graph_.nodes.size()) - 1, Eigen::Matrix3d::Identity()}}, work);
}

/// With P the covariance that all edges leave to the residual, W what the edge puts in: r_without = (I - P W)^-1 r.
Eigen::Vector3d GraphSolver::disagreement_without(const GraphEdge& edge, Work* work) const {
  constexpr double kAlone = 1e-6;
  const Linearised lin = linearise(edge, graph_.nodes[static_cast<std::size_t>(edge.from)],
                                   graph_.nodes[static_cast<std::size_t>(edge.to)]);
  if (!analysed_ || factor_.info() != Eigen::Success) return lin.r;
  const Eigen::Matrix3d P = covariance_of({{edge.from, lin.by_from}, {edge.to, lin.by_to}}, work);
  const Eigen::Matrix3d W = share(edge, lin.r, phases_.back().scaling) * edge.information;
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - P * W;
  if (std::abs(rest.determinant()) < kAlone) return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return rest.inverse() * lin.r;
}

}  // namespace rubble::slam
