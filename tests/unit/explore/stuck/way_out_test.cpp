#include "explore/stuck/way_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "robot/body.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kHalf = 0.6;  ///< of the pallet [m]
const robot::RobotModel kBody;

/// Points along a wall.
std::vector<TPoint2D> wall(const TPoint2D& from, const TPoint2D& to) {
  std::vector<TPoint2D> points;
  const int steps = static_cast<int>(std::ceil(distance(from, to) / 0.02));
  for (int i = 0; i <= steps; ++i) points.push_back(from + (to - from) * (static_cast<double>(i) / steps));
  return points;
}

std::vector<TPoint2D> operator+(std::vector<TPoint2D> a, const std::vector<TPoint2D>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The high corners of crossing ramps about the origin: ends of risers at the middles of its sides.
std::vector<TPoint2D> high_corners() {
  return wall({kHalf, 0.0}, {kHalf - 0.03, 0.0}) + wall({-kHalf, 0.0}, {0.03 - kHalf, 0.0}) +
         wall({0.0, kHalf}, {0.0, kHalf - 0.03}) + wall({0.0, -kHalf}, {0.0, 0.03 - kHalf});
}

bool touches(const TPose2D& pose, const std::vector<TPoint2D>& things) {
  const auto outline = robot::body_outline<TPoint2D, double>(kBody);
  return std::any_of(things.begin(), things.end(), [&](const TPoint2D& p_map) {
    const TPoint2D p = pose.inverseComposePoint(p_map);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const TPoint2D a = outline[i], b = outline[(i + 1) % outline.size()];
      if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0.0) return false;
    }
    return true;
  });
}

struct Way {
  bool out = false;
  bool touched = false;
  TPose2D end;
};

/// A robot that does what it is told, and is turned about a point beside its middle, as skid steering does.
Way leave(const std::vector<TPoint2D>& things, const std::vector<TPoint2D>& known, TPose2D pose,
          double off_pivot = 0.0) {
  constexpr double kStep = 0.02;  // [s]
  Trap trap;
  trap.size = 2.0 * kHalf;
  WayOut way_out(kBody, trap, things, known);
  Way way;
  for (double t = 0.0; t < 60.0; t += kStep) {
    if (way_out.out(position(pose))) {
      way.out = true;
      break;
    }
    const auto drive = way_out.drive(pose);
    if (!drive) break;
    pose = pose + TPose2D{drive->v * kStep, off_pivot * drive->w * kStep, drive->w * kStep};
    way.touched = way.touched || touches(pose, things);
  }
  way.end = pose;
  return way;
}

TEST(WayOut, EndsWhereTheRobotWasBefore) {
  const auto known = wall({2.0, 0.3}, {0.7, 0.3});
  EXPECT_GT(leave(high_corners(), known, {-0.1, 0.0, kPi}).end.x, kHalf);
  EXPECT_LT(leave(high_corners(), wall({-2.0, 0.3}, {-0.7, 0.3}), {-0.1, 0.0, kPi}).end.x, -kHalf);
  const auto shut = wall({kHalf + 0.1, -2.0}, {kHalf + 0.1, 2.0});
  EXPECT_LT(leave(high_corners() + shut, known, {-0.1, 0.0, kPi}).end.x, kHalf) << "elsewhere where that cannot be";
}

/// What it touches as it stands is no reason to stay.
TEST(WayOut, GetsAwayFromWhatItTouches) {
  const auto things = high_corners() + wall({-2.0, -kHalf}, {0.4, -kHalf});
  const TPose2D start{0.25, 0.02 - kHalf + 0.5 * kBody.width - 0.025, 0.0};
  ASSERT_TRUE(touches(start, things));
  const Way way = leave(things, {}, start);
  EXPECT_TRUE(way.out);
  EXPECT_FALSE(touches(way.end, things));
}

TEST(WayOut, SaysSoWhereThereIsNone) {
  std::vector<TPoint2D> ring;
  for (double a = 0.0; a < 2.0 * kPi; a += 0.05) ring.push_back({0.45 * std::cos(a), 0.45 * std::sin(a)});
  Trap trap;
  trap.size = 2.0 * kHalf;
  EXPECT_FALSE(WayOut(kBody, trap, ring, {}).drive({0.0, 0.0, 0.3}));
}

TEST(WayOut, MovesWithTheMap) {
  test::PlantedMapper mapper;
  mapper.plant(Stamp::from_seconds(1.0), {});
  Trap trap;
  trap.anchor = {Stamp::from_seconds(1.0), {}};
  trap.size = 2.0 * kHalf;
  WayOut way_out(kBody, trap, {}, {});
  EXPECT_FALSE(way_out.out({0.8, 0.0}));
  mapper.correct(Stamp::from_seconds(2.0), {-1.0, 0.0, 0.0});
  way_out.follow(mapper);
  EXPECT_TRUE(way_out.out({0.8, 0.0}));
  EXPECT_FALSE(way_out.out({-1.0, 0.0}));
}

}  // namespace
}  // namespace rubble::explore
