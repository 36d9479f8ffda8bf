#include "slam/robust/graph/wall_compass.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"
#include "slam/robust/graph/graph_solver.h"
#include "slam/robust/graph/key_frames.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kStep = 0.3;  ///< between key frames [m]

/// Of a pose by the one before, for a step in the map frame.
Eigen::Matrix3d lever(double dx, double dy) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -dy;
  J(1, 2) = dx;
  return J;
}

/// A drive along a corridor of which the estimate turns `bend` too far a metre, with the compass or without.
struct Corridor {
  TPose2D end;
  WallCompass compass;
};

Corridor drive(double bend, double wall_sigma, int frames, std::uint64_t seed, bool look) {
  Rng rng(seed, "walls");
  Corridor out;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double truth = 0.0;  // the corridor runs along x
  for (int k = 0; k < frames; ++k) {
    if (k > 0) {
      const double dx = kStep * std::cos(out.end.phi);
      const double dy = kStep * std::sin(out.end.phi);
      out.end = {out.end.x + dx, out.end.y + dy, out.end.phi + bend * kStep};
      const Eigen::Matrix3d J = lever(dx, dy);
      covariance = J * covariance * J.transpose();
      covariance.diagonal() += Eigen::Vector3d(1e-4, 1e-4, 9e-6);
      out.compass.go_on(J);
    }
    if (!look) continue;
    const WallDirection walls{wrap_quarter(truth + rng.gaussian(wall_sigma)), deg_to_rad(0.3)};
    const Eigen::Vector3d off = out.compass.look(out.end.phi, walls, covariance);
    out.end = {out.end.x + off[0], out.end.y + off[1], out.end.phi + off[2]};
  }
  return out;
}

TEST(WallCompass, HoldsAHeadingThatDriftsAndThePlaceWithIt) {
  const double bend = deg_to_rad(0.03);  // of the Intel log's first round
  const Corridor without = drive(bend, 0.0, 300, 1, false);
  EXPECT_NEAR(rad_to_deg(without.end.phi), 0.03 * 299 * kStep, 1e-6);
  EXPECT_GT(std::abs(without.end.y), 2.0);
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Corridor with = drive(bend, deg_to_rad(0.5), 300, seed, true);
    EXPECT_LT(std::abs(rad_to_deg(with.end.phi)), 0.4) << "seed " << seed;
    EXPECT_LT(std::abs(with.end.y), 0.4) << "seed " << seed;
  }
}

TEST(WallCompass, TrustsWallsAsFarAsTheyAgree) {
  const double straight = drive(0.0, deg_to_rad(0.1), 200, 1, true).compass.variance();
  const double usual = drive(0.0, deg_to_rad(0.5), 200, 1, true).compass.variance();
  const double askew = drive(0.0, deg_to_rad(1.6), 200, 1, true).compass.variance();
  EXPECT_LT(straight, usual);
  EXPECT_GT(std::sqrt(usual), deg_to_rad(0.7));
  EXPECT_GT(std::sqrt(askew), deg_to_rad(2.0));
}

/// The filter against all measurements at once, weighted alike: unknown are every pose and the walls' direction.
TEST(WallCompass, EndsWhereTheLeastSquaresOfAllLooksEnd) {
  constexpr int kFrames = 8;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "looks");
    WallCompass compass;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    const Eigen::Vector3d step_variance(1e-4, 2e-4, 4e-5);
    // Linear in small headings, with the steps of the levers held: s_k = J_k s_(k-1) + noise, z_k = phi - s_k[2] - a_k.
    const int unknowns = 3 * kFrames + 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    A.topLeftCorner<3, 3>() = 1e12 * Eigen::Matrix3d::Identity();
    for (int k = 0; k < kFrames; ++k) {
      if (k > 0) {
        const Eigen::Matrix3d J = lever(1.0, 0.2 * k);
        pose = J * pose;
        covariance = J * covariance * J.transpose();
        covariance.diagonal() += step_variance;
        compass.go_on(J);
        Eigen::MatrixXd row = Eigen::MatrixXd::Zero(3, unknowns);
        row.block<3, 3>(0, 3 * k).setIdentity();
        row.block<3, 3>(0, 3 * (k - 1)) = -J;
        A += row.transpose() * step_variance.cwiseInverse().asDiagonal() * row;
      }
      const WallDirection walls{rng.gaussian(deg_to_rad(0.8)), deg_to_rad(0.2 + 0.1 * k)};
      const double variance = compass.variance() + walls.sigma * walls.sigma;
      pose += compass.look(pose[2], walls, covariance);
      Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns);
      row[3 * k + 2] = -1.0;
      row[unknowns - 1] = 1.0;
      A += row * row.transpose() / variance;
      b += row * walls.angle / variance;
    }
    const Eigen::VectorXd best = A.ldlt().solve(b);
    const Eigen::Matrix3d rest = A.inverse().block<3, 3>(3 * (kFrames - 1), 3 * (kFrames - 1));
    EXPECT_LT((pose - best.segment<3>(3 * (kFrames - 1))).norm(), 1e-8);
    EXPECT_NEAR(*compass.direction(), best[unknowns - 1], 1e-8);
    EXPECT_LT((covariance - rest).norm(), 1e-8);
  }
}

PoseGraph corridor_graph(int frames, const std::vector<double>& walls) {
  PoseGraph graph;
  for (int k = 0; k < frames; ++k) {
    graph.nodes.push_back({kStep * k, 0.0, 0.0});
    graph.walls.push_back({k, walls[static_cast<std::size_t>(k)], 1e-5});
  }
  return graph;
}

TEST(WallCompass, FirstWallsThatStandAskewAreOutvoted) {
  WallCompass compass;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<double> seen;
  int looks = 0;
  for (; !compass.doubted() && looks < 100; ++looks) {
    seen.push_back(looks < 3 ? deg_to_rad(30.0) : deg_to_rad(2.0));
    EXPECT_TRUE(compass.look(0.0, WallDirection{seen.back(), 0.005}, covariance).isZero(0.0));
  }
  EXPECT_LT(looks, 25);
  compass.set_right(corridor_graph(looks, seen));
  EXPECT_NEAR(*compass.direction(), deg_to_rad(2.0), 1e-6);
  EXPECT_FALSE(compass.doubted());
}

TEST(WallCompass, KnowsFromAMapThatWasKeptHowWellItsWallsAgree) {
  Rng rng(3, "kept");
  std::vector<double> seen;
  for (int k = 0; k < 200; ++k) seen.push_back(wrap_quarter(0.25 * kPi + rng.gaussian(deg_to_rad(0.5))));
  WallCompass compass;
  compass.set_right(corridor_graph(200, seen));
  EXPECT_LT(std::abs(wrap_quarter(*compass.direction() - 0.25 * kPi)), deg_to_rad(0.15));
  EXPECT_NEAR(std::sqrt(compass.variance()), 2.0 * deg_to_rad(0.5), deg_to_rad(0.2));
  WallCompass of_nothing;
  of_nothing.set_right(PoseGraph());
  EXPECT_FALSE(of_nothing.direction());
}

/// The solver's end is a least of the cost that the walls and the edges make, and straight.
TEST(GraphSolver, WallsStraightenAChainThatBends) {
  constexpr int kNodes = 60;
  PoseGraph graph;
  graph.walls_variance = std::pow(deg_to_rad(1.0), 2.0);
  graph.walls_direction = 0.0;
  for (int k = 0; k < kNodes; ++k) {
    if (k > 0) {
      GraphEdge edge;
      edge.from = k - 1;
      edge.to = k;
      edge.T_from_to = {kStep, 0.0, deg_to_rad(0.1)};
      edge.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
      graph.edges.push_back(edge);
    }
    graph.nodes.push_back(k == 0 ? TPose2D() : graph.nodes.back() + graph.edges.back().T_from_to);
    // The last ten stand in another building, whose walls run another way.
    graph.walls.push_back({k, k < kNodes - 10 ? 0.0 : deg_to_rad(30.0), 1e-5});
  }
  GraphSolver solver;
  solver.start(graph, GraphSolver::Plan::Final, 8.0);
  Work budget = std::numeric_limits<Work>::max();
  solver.advance(budget);
  EXPECT_GT(rad_to_deg(graph.nodes[kNodes - 11].phi), 4.5);
  EXPECT_LT(std::abs(rad_to_deg(solver.nodes()[kNodes - 11].phi)), 0.7);
  const auto cost = [&](const std::vector<TPose2D>& nodes) {
    PoseGraph at = graph;
    at.nodes = nodes;
    double sum = 0.0;
    for (const GraphEdge& edge : at.edges) sum += squared_sigmas(at, edge);
    for (const GraphWalls& walls : at.walls) {
      const double off = wrap_quarter(nodes[static_cast<std::size_t>(walls.node)].phi + walls.angle);
      const double chi2 = off * off / (graph.walls_variance + walls.variance);
      // What dynamic covariance scaling minimises (Agarwal et al. 2013, eq. 14), scaling 4.
      const double s = std::min(1.0, 8.0 / (4.0 + chi2));
      sum += s * s * chi2 + 4.0 * (1.0 - s) * (1.0 - s);
    }
    return sum;
  };
  const double least = cost(solver.nodes());
  EXPECT_LT(least, cost(graph.nodes));
  for (int k = 1; k < kNodes; ++k)
    for (const double turn : {-2e-3, 2e-3}) {
      std::vector<TPose2D> moved = solver.nodes();
      moved[static_cast<std::size_t>(k)].phi += turn;
      EXPECT_GT(cost(moved), least) << "node " << k;
    }
}

/// A chain of steps that are measured right, of `nodes` in one building and as many in a wing askew to it.
PoseGraph two_buildings(int nodes, double skew) {
  PoseGraph graph;
  graph.walls_variance = std::pow(deg_to_rad(1.0), 2.0);
  graph.walls_direction = 0.0;
  for (int k = 0; k < 2 * nodes; ++k) {
    if (k > 0) {
      GraphEdge edge;
      edge.from = k - 1;
      edge.to = k;
      edge.T_from_to = {kStep, 0.0, 0.0};
      edge.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
      graph.edges.push_back(edge);
    }
    graph.nodes.push_back({kStep * k, 0.0, 0.0});
    graph.walls.push_back({k, k < nodes ? 0.0 : skew, 1e-5});
  }
  return graph;
}

double last_heading(const PoseGraph& graph) {
  GraphSolver solver;
  solver.start(graph, GraphSolver::Plan::Final, 8.0);
  Work budget = std::numeric_limits<Work>::max();
  solver.advance(budget);
  return solver.nodes().back().phi;
}

TEST(GraphSolver, AWingThatStandsAskewIsNotBentStraight) {
  for (const double skew : {8.0, -8.0, 12.0, 30.0, 44.0})
    EXPECT_LT(std::abs(rad_to_deg(last_heading(two_buildings(100, deg_to_rad(skew))))), 0.01) << skew;
  EXPECT_GT(std::abs(rad_to_deg(last_heading(two_buildings(100, deg_to_rad(3.0))))), 1.0) << "walls do bend a chain";
}

TEST(GraphSolver, WallsWithoutADirectionSayNothing) {
  PoseGraph graph = two_buildings(100, deg_to_rad(3.0));
  graph.walls_direction.reset();
  EXPECT_EQ(last_heading(graph), 0.0);
}

TEST(WallCompass, GoesWithMostWallsOfTwoBuildings) {
  const auto direction_after = [](int of_wing) {
    std::vector<double> seen(100, 0.0);
    seen.insert(seen.end(), static_cast<std::size_t>(of_wing), deg_to_rad(12.0));
    WallCompass compass;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    compass.look(0.0, WallDirection{0.0, 0.005}, covariance);
    compass.set_right(corridor_graph(100 + of_wing, seen));
    return rad_to_deg(*compass.direction());
  };
  EXPECT_NEAR(direction_after(0), 0.0, 0.01);
  EXPECT_NEAR(direction_after(90), 0.0, 0.01);
  EXPECT_NEAR(direction_after(110), 12.0, 0.01);
}

TEST(KeyFrames, TakeTheWallsOfTheirFramesOnce) {
  std::vector<KeyFrame> frames(2);
  frames[1].walls = WallDirection{0.1, 0.01};
  PoseGraph graph;
  graph.nodes.resize(2);
  graph.walls.push_back({0, 0.5, 1.0});
  const KeyFrames kept(frames, {-1, 0}, graph);
  ASSERT_EQ(kept.graph().walls.size(), 1U);
  EXPECT_EQ(kept.graph().walls[0].node, 1);
  EXPECT_EQ(kept.graph().walls[0].angle, 0.1);
  EXPECT_FALSE(kept.graph().walls_direction);
}

}  // namespace
}  // namespace rubble::slam
