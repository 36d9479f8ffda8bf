#include "slam/robust/graph/key_frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "tests/support/slam_key_frames.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;
using robot::RobotModel;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Key frames without clouds, a metre apart.
KeyFrames line_of(int count) {
  KeyFrames frames;
  for (int i = 0; i < count; ++i) {
    KeyFrame frame;
    frame.stamp = Stamp{i * 1000000000ll};
    frame.path = i;
    GraphEdge edge;
    edge.from = i - 1;
    edge.to = i;
    edge.T_from_to = {1.0, 0.0, 0.0};
    frames.add(std::move(frame), {static_cast<double>(i), 0.0, 0.0}, edge);
  }
  return frames;
}

GraphEdge loop_between(int from, int to) {
  GraphEdge edge;
  edge.from = from;
  edge.to = to;
  edge.loop = true;
  return edge;
}

TEST(KeyFrames, TheClosestComeFirst) {
  const KeyFrames frames = line_of(10);
  EXPECT_EQ(frames.closest({4.2, 0.0, 1.0}, 1.5, 8, 10), (std::vector<int>{4, 5, 3}));
  EXPECT_EQ(frames.closest({4.2, 0.0, 1.0}, 1.5, 2, 10), (std::vector<int>{4, 5}));
  EXPECT_EQ(frames.closest({4.2, 0.0, 1.0}, 1.5, 8, 5), (std::vector<int>{4, 3})) << "only those below the end";
  EXPECT_TRUE(frames.closest({4.2, 2.0, 1.0}, 1.5, 8, 10).empty());
}

TEST(KeyFrames, PathsAreTheShortestOfAll) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "graph");
    constexpr int kNodes = 30;
    KeyFrames frames = line_of(kNodes);
    std::vector<std::vector<double>> between(kNodes, std::vector<double>(kNodes, kInfinite));  // Floyd, Warshall
    const auto join = [&](int a, int b, double path) {
      auto& forth = between[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
      auto& back = between[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)];
      forth = back = std::min(forth, path);
    };
    for (int i = 0; i < kNodes; ++i) join(i, i, 0.0);
    for (int i = 1; i < kNodes; ++i) join(i - 1, i, 1.0);
    for (int k = 0; k < 12; ++k) {
      const int a = static_cast<int>(rng.below(kNodes));
      const int b = static_cast<int>(rng.below(kNodes));
      const double path = rng.uniform(0.1, 3.0);
      frames.add_loop(loop_between(a, b), path);
      const std::size_t edge = frames.graph().edges.size() - 1;
      if (k % 3 == 0)
        frames.switch_off(edge);
      else
        join(a, b, path);
    }
    for (std::size_t k = 0; k < kNodes; ++k)
      for (std::size_t i = 0; i < kNodes; ++i)
        for (std::size_t j = 0; j < kNodes; ++j) between[i][j] = std::min(between[i][j], between[i][k] + between[k][j]);
    const double most = seed % 2 == 0 ? 5.0 : 1e9;
    std::vector<int> all(kNodes);
    std::iota(all.begin(), all.end(), 0);
    for (int i = 0; i < kNodes; ++i) {
      const std::vector<double> paths = frames.paths_from(i, all, most);
      const std::vector<int> some{static_cast<int>(rng.below(kNodes)), static_cast<int>(rng.below(kNodes)), i};
      const std::vector<double> to_some = frames.paths_from(i, some, most);
      for (std::size_t k = 0; k < some.size(); ++k) EXPECT_EQ(to_some[k], paths[static_cast<std::size_t>(some[k])]);
      for (std::size_t j = 0; j < kNodes; ++j) {
        const double expected = between[static_cast<std::size_t>(i)][j];
        if (expected > most)
          EXPECT_EQ(paths[j], kInfinite);
        else
          EXPECT_NEAR(paths[j], expected, 1e-12);
      }
    }
  }
}

TEST(KeyFrames, WhatCameAfterASolutionFollowsIt) {
  KeyFrames frames = line_of(6);
  std::vector<TPose2D> poses;
  for (int i = 0; i < 4; ++i) poses.push_back({0.0, static_cast<double>(i), 0.5 * kPi});
  frames.move(poses);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(frames.pose(i).x, 0.0, 1e-12);
    EXPECT_NEAR(frames.pose(i).y, i, 1e-12);
    EXPECT_NEAR(frames.pose(i).phi, 0.5 * kPi, 1e-12);
  }
}

TEST(KeyFrames, NeighboursKeepWithinTheirLimits) {
  const KeyFrames frames = line_of(20);
  EXPECT_EQ(frames.ending_at(10, 4, 100.0), (std::vector<int>{10, 9, 8, 7}));
  EXPECT_EQ(frames.ending_at(10, 100, 2.5), (std::vector<int>{10, 9, 8}));
  EXPECT_EQ(frames.ending_at(1, 100, 100.0), (std::vector<int>{1, 0}));
  EXPECT_EQ(frames.around(10, 5, 100.0, 20), (std::vector<int>{10, 9, 11, 8, 12}));
  EXPECT_EQ(frames.around(10, 100, 4.0, 11), (std::vector<int>{10, 9, 8}));
}

TEST(KeyFrames, DrawnSurfelsLieOnTheWorldsWalls) {
  const RobotModel model;
  const slam_test::World world = slam_test::furnished_room();
  const auto places = slam_test::places_along({{0.0, 0.0}, {2.0, 0.2}}, 0.3);
  KeyFrames frames;
  for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, world, places, 0.0, model);
  SurfelGrid grid;
  frames.draw(frames.ending_at(frames.last(), 100, 100.0), frames.pose(0), 0.1, grid);
  ASSERT_GT(grid.surfels().size(), 150u);
  int on_walls = 0;
  const PlanarTransform to_world(places.front());
  for (const Surfel& q : grid.surfels()) {
    const auto p = to_world({static_cast<double>(q.x), static_cast<double>(q.y)});
    double nearest = 1e9;
    for (const slam_test::Segment& s : world) {
      const auto along = s.b - s.a;
      const double t = ((p.x - s.a.x) * along.x + (p.y - s.a.y) * along.y) / (along.x * along.x + along.y * along.y);
      nearest = std::min(nearest, distance(p, s.a + along * std::min(1.0, std::max(0.0, t))));
    }
    on_walls += nearest < 0.02 ? 1 : 0;
  }
  EXPECT_GE(on_walls, static_cast<int>(grid.surfels().size()) * 97 / 100);
}

TEST(KeyFrames, PointsInsideTheRoomContradictAndThoseOnWallsAgree) {
  const RobotModel model;
  const slam_test::World world = slam_test::furnished_room();
  const auto places = slam_test::places_along({{0.0, 0.0}, {0.6, 0.0}}, 0.3);
  KeyFrames frames;
  for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(frames, world, places, 0.0, model);
  const std::vector<int> all = frames.ending_at(frames.last(), 100, 100.0);
  const auto own = frames.agreement(frames[0].cloud.points, {}, frames.pose(0), all);
  EXPECT_GT(own.supported, 100);
  EXPECT_LT(own.contradiction(), 0.02);
  // The same walls, a metre closer on all sides: beams would have gone through them.
  std::vector<OrientedPoint> closer = frames[0].cloud.points;
  for (OrientedPoint& p : closer) {
    p.x *= 0.5F;
    p.y *= 0.5F;
  }
  EXPECT_GT(frames.agreement(closer, {}, frames.pose(0), all).contradiction(), 0.8);
  EXPECT_EQ(frames.agreement({}, {}, frames.pose(0), all).contradiction(), 1.0) << "who shows nothing does not agree";
}

}  // namespace
}  // namespace rubble::slam
