#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "sim/body/world.h"
#include "tests/support/sim_arena.h"
#include "tests/support/sim_random_scene.h"

// Where a robot can touch nothing it moves without Box2D. That must change nothing but the rounding.

namespace rubble::sim::test {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kStep = 0.01;
constexpr double kSlop = 0.006;  ///< Box2D lets bodies overlap by 5 mm [m]

TPoint2D in_arena(const TPose2D& pose, const TPoint2D& p) {
  const double c = std::cos(pose.phi), s = std::sin(pose.phi);
  return {pose.x + c * p.x - s * p.y, pose.y + s * p.x + c * p.y};
}

TPoint2D in_body(const TPose2D& pose, const TPoint2D& p) {
  const double c = std::cos(pose.phi), s = std::sin(pose.phi);
  return {c * (p.x - pose.x) + s * (p.y - pose.y), -s * (p.x - pose.x) + c * (p.y - pose.y)};
}

/// How deep a point lies inside a convex outline that turns counter-clockwise; negative outside.
double depth(const arenas::Outline& outline, const TPoint2D& p) {
  double least = 1e9;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D& a = outline[i];
    const TPoint2D& b = outline[(i + 1) % outline.size()];
    const double along = std::hypot(b.x - a.x, b.y - a.y);
    least = std::min(least, ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / along);
  }
  return least;
}

/// The body from above: corners cut by a tenth of the length.
arenas::Outline body(const robot::RobotModel& model) {
  const double x = 0.5 * model.length, y = 0.5 * model.width, cut = 0.1 * model.length;
  return {{x, y - cut},  {x - cut, y},  {cut - x, y},  {-x, y - cut},
          {-x, cut - y}, {cut - x, -y}, {x - cut, -y}, {x, cut - y}};
}

/// Of a body's corners in walls and of walls' corners in the body [m].
double deepest(const arenas::Arena& arena, const robot::RobotModel& model, const TPose2D& pose) {
  const arenas::Outline outline = body(model);
  double most = -1e9;
  for (const arenas::Solid& solid : arena.solids) {
    for (const TPoint2D& corner : outline) most = std::max(most, depth(solid.outline, in_arena(pose, corner)));
    for (const TPoint2D& corner : solid.outline) most = std::max(most, depth(outline, in_body(pose, corner)));
  }
  return most;
}

/// Along walls as near as a hand's breadth, past posts and through a gate, without touching: the same world with
/// another robot that leans on a wall far away is moved by Box2D all the time.
TEST(FreeMotion, IsWhatBox2dMakesOfItToATenthOfAMillimetre) {
  const robot::RobotModel model;
  double worst = 0.0;
  for (const double gap : {0.02, 0.05, 0.1, 0.2}) {
    SCOPED_TRACE("gap " + std::to_string(gap));
    arenas::Arena arena = room(-10, -10, 10, 10);
    add_wall(arena, -1.0, 0.5 * model.width + gap, 4.0, 0.5 * model.width + gap + 0.02);
    add_wall(arena, 2.0, -0.5 * model.width - gap - 0.02, 3.0, -0.5 * model.width - gap);
    const ServoParameters servos;
    World alone(arena, {Entrant{model, servos, {0, 0, 0}}}, kStep);
    World together(arena, {Entrant{model, servos, {0, 0, 0}}, Entrant{model, servos, {9.72, 8.0, 0}}}, kStep);
    for (int i = 0; i < 2500; ++i) {
      const double t = kStep * i;
      const robot::Drive command = t < 20.0 ? robot::Drive{0.4 * std::sin(0.5 * t), 0.0} : robot::Drive{-0.1, 0.0};
      alone.firmware(0).command(command);
      together.firmware(0).command(command);
      together.firmware(1).command({0.3, 0.0});
      alone.step();
      together.step();
      const TPose2D& a = alone.state(0).pose;
      const TPose2D& b = together.state(0).pose;
      worst = std::max({worst, std::hypot(a.x - b.x, a.y - b.y), std::abs(a.phi - b.phi)});
      ASSERT_LT(worst, 1e-4) << "after " << t << " s at " << a.x << ", " << a.y;
    }
    EXPECT_GT(std::abs(alone.state(0).pose.x), 0.1);
  }
  std::cout << "free and by Box2D part by " << worst * 1e6 << " um\n";
}

TEST(FreeMotion, NeverEndsInsideAWall) {
  const robot::RobotModel model;
  double most = -1e9;
  int touching = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    World world(arena, model, {}, kStep);
    Rng rng(seed, "bumping about");
    for (int leg = 0; leg < 25; ++leg) {
      const robot::Drive command{rng.uniform(-model.max_v, model.max_v), rng.uniform(-model.max_w, model.max_w)};
      for (int i = 0; i < 150; ++i) {
        world.firmware().command(command);
        world.step();
        const double now = deepest(arena, model, world.state().pose);
        most = std::max(most, now);
        touching += now > -0.005;
        ASSERT_LT(now, kSlop) << "leg " << leg << " step " << i;
      }
    }
  }
  std::cout << "deepest " << most * 1e3 << " mm, " << touching << " steps in touch\n";
  EXPECT_GT(touching, 1000);
}

}  // namespace
}  // namespace rubble::sim::test
