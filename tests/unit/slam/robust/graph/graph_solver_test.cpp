#include "slam/robust/graph/graph_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rng.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

Eigen::Matrix3d random_information(Rng& rng) {
  Eigen::Matrix3d A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) A(i, j) = rng.gaussian();
  return A * A.transpose() * 400.0 + 100.0 * Eigen::Matrix3d::Identity();
}

TPose2D noisy(const TPose2D& T, Rng& rng, double size) {
  const double dx = rng.gaussian(size);
  const double dy = rng.gaussian(size);
  const double turn = rng.gaussian(size);
  return {T.x + dx, T.y + dy, wrap_angle(T.phi + turn)};
}

/// A ring of `count` nodes twice round, its steps measured with noise, with edges between the two rounds.
struct Ring {
  std::vector<TPose2D> truth;
  PoseGraph graph;
};

Ring ring(int count, double noise, bool loops, std::uint64_t seed) {
  Rng rng(seed, "ring");
  Ring out;
  for (int k = 0; k < 2 * count; ++k) {
    const double bearing = 2.0 * kPi * k / count;
    out.truth.push_back({3.0 * std::sin(bearing), 3.0 - 3.0 * std::cos(bearing), wrap_angle(bearing)});
  }
  out.graph.nodes.push_back(out.truth.front());
  const auto measure = [&](int from, int to, bool loop) {
    GraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.T_from_to =
        noisy(out.truth[static_cast<std::size_t>(to)] - out.truth[static_cast<std::size_t>(from)], rng, noise);
    edge.information = random_information(rng);
    edge.loop = loop;
    out.graph.edges.push_back(edge);
  };
  for (int k = 1; k < 2 * count; ++k) {
    measure(k - 1, k, false);
    out.graph.nodes.push_back(out.graph.nodes.back() + out.graph.edges.back().T_from_to);
  }
  for (int k = count; k < 2 * count; k += 2) measure(k - count, k, loops);
  return out;
}

std::vector<TPose2D> solved(const PoseGraph& graph, GraphSolver::Plan plan, double scaling = 8.0) {
  GraphSolver solver;
  solver.start(graph, plan, scaling);
  Work budget = std::numeric_limits<Work>::max();
  solver.advance(budget);
  return solver.nodes();
}

Eigen::VectorXd as_vector(const std::vector<TPose2D>& nodes) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(3 * nodes.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    x.segment<3>(static_cast<Eigen::Index>(3 * k)) << nodes[k].x, nodes[k].y, nodes[k].phi;
  return x;
}

std::vector<TPose2D> as_nodes(const Eigen::VectorXd& x) {
  std::vector<TPose2D> nodes;
  for (Eigen::Index k = 0; k < x.size(); k += 3) nodes.push_back({x[k], x[k + 1], wrap_angle(x[k + 2])});
  return nodes;
}

/// Residuals of all edges under their square-rooted information, one below the other.
Eigen::VectorXd residuals(const PoseGraph& graph, const Eigen::VectorXd& x) {
  PoseGraph at = graph;
  at.nodes = as_nodes(x);
  Eigen::VectorXd r(static_cast<Eigen::Index>(3 * graph.edges.size()));
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const GraphEdge& edge = graph.edges[k];
    const TPose2D T = at.nodes[static_cast<std::size_t>(edge.to)] - at.nodes[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector3d e(T.x - edge.T_from_to.x, T.y - edge.T_from_to.y, wrap_angle(T.phi - edge.T_from_to.phi));
    const Eigen::Matrix3d root = edge.information.llt().matrixL().transpose();
    r.segment<3>(static_cast<Eigen::Index>(3 * k)) = root * e;
  }
  return r;
}

Eigen::MatrixXd numerical_jacobian(const PoseGraph& graph, const Eigen::VectorXd& x) {
  Eigen::MatrixXd J(static_cast<Eigen::Index>(3 * graph.edges.size()), x.size());
  const double h = 1e-6;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Eigen::VectorXd up = x, down = x;
    up[k] += h;
    down[k] -= h;
    J.col(k) = (residuals(graph, up) - residuals(graph, down)) / (2.0 * h);
  }
  return J;
}

/// Gauss-Newton with dense matrices and numerical derivatives, node 0 held.
std::vector<TPose2D> solved_densely(const PoseGraph& graph) {
  Eigen::VectorXd x = as_vector(graph.nodes);
  for (int step = 0; step < 30; ++step) {
    const Eigen::MatrixXd J = numerical_jacobian(graph, x).rightCols(x.size() - 3);
    const Eigen::VectorXd d = (J.transpose() * J).ldlt().solve(-J.transpose() * residuals(graph, x));
    x.tail(x.size() - 3) += d;
    if (d.norm() < 1e-10) break;
  }
  return as_nodes(x);
}

double farthest(const std::vector<TPose2D>& a, const std::vector<TPose2D>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    most = std::max(most, length(a[k].x - b[k].x, a[k].y - b[k].y) + std::abs(wrap_angle(a[k].phi - b[k].phi)));
  return most;
}

TEST(GraphSolver, FindsWhatADenseSolverFinds) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Ring r = ring(12, 0.02, false, seed);
    const auto sparse = solved(r.graph, GraphSolver::Plan::Final);
    EXPECT_LT(farthest(sparse, solved_densely(r.graph)), 2e-4);
    EXPECT_GT(farthest(sparse, r.graph.nodes), 0.02) << "nothing was to be solved";
  }
}

TEST(GraphSolver, ExactMeasurementsGiveTheTruth) {
  Ring r = ring(20, 0.0, true, 1);
  Rng rng(1, "start");
  for (std::size_t k = 1; k < r.graph.nodes.size(); ++k) r.graph.nodes[k] = noisy(r.graph.nodes[k], rng, 0.05);
  EXPECT_LT(farthest(solved(r.graph, GraphSolver::Plan::Final), r.truth), 1e-4);
}

TEST(GraphSolver, SlicesGiveTheSameBitsAndKeepToTheirBudget) {
  const Ring r = ring(300, 0.02, true, 7);
  const auto at_once = solved(r.graph, GraphSolver::Plan::Gradually);
  EXPECT_GT(farthest(at_once, r.graph.nodes), 0.02) << "nothing was to be solved";
  for (const Work slice : {Work{1}, Work{5'000}, Work{100'000}}) {
    SCOPED_TRACE("slices of " + std::to_string(slice));
    GraphSolver solver;
    solver.start(r.graph, GraphSolver::Plan::Gradually, 8.0);
    Work budget = slice;
    ASSERT_TRUE(solver.advance(budget)) << "the layout goes first, in one";
    int slices = 1;
    for (bool more = true; more; ++slices) {
      budget = slice;
      more = solver.advance(budget);
      EXPECT_GT(budget, -130'000) << "solving by the factor and the next step's beginning are the largest pieces";
    }
    EXPECT_GT(slices, 10);
    const auto in_slices = solver.nodes();
    for (std::size_t k = 0; k < at_once.size(); ++k) {
      EXPECT_EQ(in_slices[k].x, at_once[k].x);
      EXPECT_EQ(in_slices[k].y, at_once[k].y);
      EXPECT_EQ(in_slices[k].phi, at_once[k].phi);
    }
  }
}

TEST(GraphSolver, CovarianceIsTheInverseOfTheDenseHessian) {
  const Ring r = ring(8, 0.01, false, 3);
  GraphSolver solver;
  solver.start(r.graph, GraphSolver::Plan::Final, 8.0);
  Work budget = std::numeric_limits<Work>::max();
  solver.advance(budget);
  const Eigen::VectorXd x = as_vector(solver.nodes());
  const Eigen::MatrixXd J = numerical_jacobian(r.graph, x).rightCols(x.size() - 3);
  const Eigen::MatrixXd covariance = (J.transpose() * J).inverse();
  const Eigen::Matrix3d expected = covariance.bottomRightCorner<3, 3>();
  EXPECT_LT((solver.covariance_of_last() - expected).norm(), 1e-3 * expected.norm());
}

TEST(GraphSolver, OrderOfIndependentEdgesDoesNotMatter) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Ring r = ring(15, 0.02, true, seed);
    PoseGraph shuffled = r.graph;
    Rng rng(seed, "shuffle");
    for (std::size_t k = shuffled.edges.size(); k > 1; --k)
      std::swap(shuffled.edges[k - 1], shuffled.edges[rng.below(static_cast<std::uint32_t>(k))]);
    for (const auto plan : {GraphSolver::Plan::Refine, GraphSolver::Plan::Gradually, GraphSolver::Plan::Final})
      EXPECT_LT(farthest(solved(r.graph, plan), solved(shuffled, plan)), 1e-9);
  }
}

/// Steps that bend ever further left, as a drive without loops does: the ring does not close by metres.
PoseGraph bent_ring() {
  Ring r = ring(40, 0.0, true, 1);
  for (GraphEdge& edge : r.graph.edges)
    if (!edge.loop) {
      edge.T_from_to.phi += 0.012;
      edge.information = Eigen::Vector3d(2500.0, 2500.0, 2000.0).asDiagonal();
    } else {
      edge.information = Eigen::Vector3d(1000.0, 1000.0, 10000.0).asDiagonal();
    }
  for (std::size_t k = 1; k < r.graph.nodes.size(); ++k)
    r.graph.nodes[k] = r.graph.nodes[k - 1] + r.graph.edges[k - 1].T_from_to;
  return r.graph;
}

TEST(GraphSolver, LoopsOfMetresAreLetInByDegrees) {
  const PoseGraph graph = bent_ring();
  double open = 0.0;
  for (const GraphEdge& edge : graph.edges)
    open = std::max(open, length(disagreement(graph, edge).x, disagreement(graph, edge).y));
  ASSERT_GT(open, 1.0);
  PoseGraph closed = graph;
  closed.nodes = solved(graph, GraphSolver::Plan::Gradually);
  for (const GraphEdge& edge : closed.edges) {
    const TPose2D off = disagreement(closed, edge);
    EXPECT_LT(length(off.x, off.y), 0.15);
  }
}

TEST(GraphSolver, AFalseLoopAmongTrueOnesIsToldByTheOthers) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Ring r = ring(20, 0.005, true, seed);
    GraphEdge wrong;
    wrong.from = 3;
    wrong.to = 33;
    wrong.T_from_to = r.truth[33] - r.truth[3];
    wrong.T_from_to.x += 1.2;
    wrong.information = Eigen::Vector3d(1000.0, 1000.0, 10000.0).asDiagonal();
    wrong.loop = true;
    r.graph.edges.push_back(wrong);
    GraphSolver solver;
    solver.start(r.graph, GraphSolver::Plan::Final, 8.0);
    Work budget = std::numeric_limits<Work>::max();
    solver.advance(budget);
    EXPECT_GT(solver.disagreement_without(wrong).head<2>().norm(), 0.8);
    for (const GraphEdge& edge : r.graph.edges)
      if (edge.loop && edge.to != wrong.to) {
        EXPECT_LT(solver.disagreement_without(edge).head<2>().norm(), 0.8) << edge.from << " to " << edge.to;
      }
  }
}

TEST(GraphSolver, DisagreementWithoutAnEdgeIsThatOfTheGraphWithoutIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Ring r = ring(10, 0.01, false, seed);
    GraphEdge& wrong = r.graph.edges.back();
    wrong.T_from_to.x += 0.3;
    GraphSolver solver;
    solver.start(r.graph, GraphSolver::Plan::Final, 8.0);
    Work budget = std::numeric_limits<Work>::max();
    solver.advance(budget);
    const Eigen::Vector3d told = solver.disagreement_without(wrong);
    PoseGraph rest = r.graph;
    rest.edges.pop_back();
    rest.nodes = solved(rest, GraphSolver::Plan::Final);
    const TPose2D off =
        rest.nodes[static_cast<std::size_t>(wrong.to)] - rest.nodes[static_cast<std::size_t>(wrong.from)];
    EXPECT_NEAR(told[0], off.x - wrong.T_from_to.x, 0.02);
    EXPECT_NEAR(told[1], off.y - wrong.T_from_to.y, 0.02);
    EXPECT_NEAR(told[2], wrap_angle(off.phi - wrong.T_from_to.phi), 0.01);
    EXPECT_GT(std::abs(told[0]), 0.2);
  }
}

TEST(GraphSolver, AnEdgeThatAloneTiesItsEndsHasNothingToDisagreeWith) {
  PoseGraph graph;
  graph.nodes = {{}, {1.0, 0.0, 0.0}};
  GraphEdge edge;
  edge.to = 1;
  edge.T_from_to = {1.1, 0.0, 0.0};
  graph.edges.push_back(edge);
  GraphSolver solver;
  solver.start(graph, GraphSolver::Plan::Final, 8.0);
  Work budget = std::numeric_limits<Work>::max();
  solver.advance(budget);
  EXPECT_FALSE(std::isfinite(solver.disagreement_without(edge)[0]) &&
               std::abs(solver.disagreement_without(edge)[0]) < 1e3);
}

TEST(GraphSolver, EdgesThatAreOffDoNotCount) {
  Ring r = ring(10, 0.01, true, 2);
  const auto without = solved(r.graph, GraphSolver::Plan::Final);
  GraphEdge off = r.graph.edges.front();
  off.from = 2;
  off.to = 15;
  off.on = false;
  r.graph.edges.push_back(off);
  EXPECT_EQ(farthest(solved(r.graph, GraphSolver::Plan::Final), without), 0.0);
}

TEST(GraphSolver, ASingleNodeIsSolved) {
  PoseGraph graph;
  graph.nodes.push_back({1.0, 2.0, 0.5});
  GraphSolver solver;
  solver.start(graph, GraphSolver::Plan::Final, 8.0);
  EXPECT_FALSE(solver.running());
  Work budget = 1;
  EXPECT_FALSE(solver.advance(budget));
  EXPECT_EQ(solver.covariance_of_last(), Eigen::Matrix3d::Zero());
}

TEST(GraphSolver, WorkGrowsWithTheGraph) {
  const auto work_of = [](int count) {
    GraphSolver solver;
    solver.start(ring(count, 0.01, true, 1).graph, GraphSolver::Plan::Refine, 8.0);
    constexpr Work kPlenty = 1'000'000'000;
    Work budget = kPlenty;
    solver.advance(budget);
    return kPlenty - budget;
  };
  EXPECT_GT(work_of(40), 3 * work_of(10));
}

}  // namespace
}  // namespace rubble::slam
