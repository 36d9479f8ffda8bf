#include "slam/robust/pose_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kInFull = 1e12;     ///< a scaling that no loop feels
constexpr double kHeld = 1e9;        ///< information that holds node 0
constexpr double kLeast = 1e-6;      ///< information each node has of itself, against singular systems
constexpr double kConverged = 1e-3;  ///< largest change of a step [m; a third of it in rad]
constexpr Work kWorkPerEdge = 2500;
constexpr Work kWorkPerNode = 4000;

/// Residual of an edge and its derivatives by the two poses.
struct Linearised {
  Eigen::Vector3d r;
  Eigen::Matrix3d by_from;
  Eigen::Matrix3d by_to;
};

Linearised linearise(const GraphEdge& edge, const TPose2D& from, const TPose2D& to) {
  const double c = std::cos(from.phi);
  const double s = std::sin(from.phi);
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double ahead = c * dx + s * dy;
  const double aside = -s * dx + c * dy;
  Linearised lin;
  lin.r << ahead - edge.T_from_to.x, aside - edge.T_from_to.y, wrap_angle(to.phi - from.phi - edge.T_from_to.phi);
  lin.by_from << -c, -s, aside, s, -c, -ahead, 0, 0, -1;
  lin.by_to << c, s, 0, -s, c, 0, 0, 0, 1;
  return lin;
}

/// Share of its information that a loop keeps: (min(1, 2 phi / (phi + chi2)))^2, Agarwal et al. 2013, eq. (15).
double share(const GraphEdge& edge, const Eigen::Vector3d& r, double scaling) {
  if (!edge.loop) return 1.0;
  const double s = std::min(1.0, 2.0 * scaling / (scaling + r.dot(edge.information * r)));
  return s * s;
}

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds a block to the lower triangle.
void add_block(int row, int column, const Eigen::Matrix3d& block, Triplets& out) {
  for (int u = 0; u < 3; ++u)
    for (int v = 0; v < 3; ++v) {
      const int i = 3 * row + u;
      const int j = 3 * column + v;
      if (i >= j) out.emplace_back(i, j, block(u, v));
    }
}

}  // namespace

TPose2D disagreement(const PoseGraph& graph, const GraphEdge& edge) {
  const TPose2D T_from_to =
      graph.nodes[static_cast<std::size_t>(edge.to)] - graph.nodes[static_cast<std::size_t>(edge.from)];
  return T_from_to - edge.T_from_to;
}

double squared_sigmas(const PoseGraph& graph, const GraphEdge& edge) {
  const Linearised lin =
      linearise(edge, graph.nodes[static_cast<std::size_t>(edge.from)], graph.nodes[static_cast<std::size_t>(edge.to)]);
  return lin.r.dot(edge.information * lin.r);
}

void GraphSolver::start(const PoseGraph& graph, Plan plan, double scaling) {
  graph_ = graph;
  graph_.edges.erase(std::remove_if(graph_.edges.begin(), graph_.edges.end(), [](const GraphEdge& e) { return !e.on; }),
                     graph_.edges.end());
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

bool GraphSolver::step(Work& work) {
  if (!running_) return false;
  const int size = 3 * static_cast<int>(graph_.nodes.size());
  Triplets triplets;
  triplets.reserve(graph_.edges.size() * 24 + static_cast<std::size_t>(size) + 3);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (const GraphEdge& edge : graph_.edges) {
    const Linearised lin = linearise(edge, graph_.nodes[static_cast<std::size_t>(edge.from)],
                                     graph_.nodes[static_cast<std::size_t>(edge.to)]);
    const Eigen::Matrix3d information = share(edge, lin.r, phases_[phase_].scaling) * edge.information;
    const Eigen::Matrix3d from = lin.by_from.transpose() * information;
    const Eigen::Matrix3d to = lin.by_to.transpose() * information;
    add_block(edge.from, edge.from, from * lin.by_from, triplets);
    add_block(edge.to, edge.to, to * lin.by_to, triplets);
    if (edge.to > edge.from)
      add_block(edge.to, edge.from, to * lin.by_from, triplets);
    else
      add_block(edge.from, edge.to, from * lin.by_to, triplets);
    b.segment<3>(3 * edge.from) -= from * lin.r;
    b.segment<3>(3 * edge.to) -= to * lin.r;
  }
  for (int i = 0; i < size; ++i) triplets.emplace_back(i, i, i < 3 ? kHeld : kLeast);
  Eigen::SparseMatrix<double> H(size, size);
  H.setFromTriplets(triplets.begin(), triplets.end());
  if (!analysed_) factor_.analyzePattern(H);
  analysed_ = true;
  factor_.factorize(H);
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

Eigen::Matrix3d GraphSolver::covariance_of_last() const {
  const auto size = static_cast<Eigen::Index>(3 * graph_.nodes.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  if (!analysed_ || factor_.info() != Eigen::Success || size < 6) return covariance;
  for (Eigen::Index column = 0; column < 3; ++column) {
    const Eigen::VectorXd solved = factor_.solve(Eigen::VectorXd::Unit(size, size - 3 + column));
    covariance.col(column) = solved.tail<3>();
  }
  return 0.5 * (covariance + covariance.transpose());
}

/// With P the covariance that all edges leave to the residual, W what the edge puts in: r_without = (I - P W)^-1 r.
Eigen::Vector3d GraphSolver::disagreement_without(const GraphEdge& edge) const {
  constexpr double kAlone = 1e-6;
  const Linearised lin = linearise(edge, graph_.nodes[static_cast<std::size_t>(edge.from)],
                                   graph_.nodes[static_cast<std::size_t>(edge.to)]);
  if (!analysed_ || factor_.info() != Eigen::Success) return lin.r;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * graph_.nodes.size()), 3);
  J.middleRows<3>(3 * edge.from) = lin.by_from.transpose();
  J.middleRows<3>(3 * edge.to) = lin.by_to.transpose();
  const Eigen::MatrixXd solved = factor_.solve(J);
  const Eigen::Matrix3d P = J.transpose() * solved;
  const Eigen::Matrix3d W = share(edge, lin.r, phases_.back().scaling) * edge.information;
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - P * W;
  if (std::abs(rest.determinant()) < kAlone) return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return rest.inverse() * lin.r;
}

}  // namespace rubble::slam
