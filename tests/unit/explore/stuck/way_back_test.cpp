#include "explore/stuck/way_back.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPose2D;

struct Retraced {
  TPose2D end;
  double seconds = 0.0;
  double most_turned = 0.0;  ///< away from the heading at the start, whichever way [rad]
};

/// A robot that does what it is told, for a minute at most.
Retraced retrace(WayBack way, TPose2D pose) {
  constexpr double kStep = 0.02;  // [s]
  Retraced run;
  const double heading = pose.phi;
  for (; run.seconds < 60.0; run.seconds += kStep) {
    way.add(Stamp::from_seconds(100.0 + run.seconds), pose);
    const auto drive = way.drive(pose);
    if (!drive) break;
    pose = pose + TPose2D{drive->v * kStep, 0.0, drive->w * kStep};
    run.most_turned = std::max(run.most_turned, std::abs(wrap_angle(pose.phi - heading)));
  }
  run.end = pose;
  return run;
}

TEST(WayBack, ForgetsLoopsAndKeepsTheWay) {
  WayBack way;
  const Stamp now = Stamp::from_seconds(1.0);
  for (double x = 0.0; x < 1.0; x += 0.01) way.add(now, {x, 0.0, 0.0});
  const Retraced straight = retrace(way, {0.99, 0.0, 0.0});
  EXPECT_NEAR(straight.end.x, 0.0, 0.05);
  EXPECT_LT(straight.seconds, 30.0);
  EXPECT_EQ(straight.most_turned, 0.0);
  for (double a = 0.0; a < 2.0 * kPi; a += 0.02) way.add(now, {0.99, 0.0, a});
  const auto drive = way.drive({0.99, 0.0, 0.0});
  ASSERT_TRUE(drive.has_value());
  EXPECT_LT(drive->v, 0.0);
  EXPECT_EQ(drive->w, 0.0);
  const Retraced after_loop = retrace(way, {0.99, 0.0, 0.0});
  EXPECT_NEAR(after_loop.end.x, 0.0, 0.05);
  EXPECT_LT(after_loop.most_turned, deg_to_rad(7.0)) << "a turn on the spot ends as it began";
}

TEST(WayBack, LeadsOutOfAnArcByTheArc) {
  WayBack way;
  TPose2D pose;
  for (double a = 0.0; a <= 1.2; a += 0.01) {
    pose = {0.8 * std::sin(a), 0.8 - 0.8 * std::cos(a), a};
    way.add(Stamp::from_seconds(a), pose);
  }
  const Retraced out = retrace(way, pose);
  EXPECT_NEAR(distance(position(out.end), {0.0, 0.0}), 0.0, 0.06);
  EXPECT_NEAR(out.end.phi, 0.0, deg_to_rad(8.0));
}

TEST(WayBack, HasNoWayOutOfThePlaceWhereItBegan) {
  WayBack way;
  EXPECT_FALSE(way.drive({}).has_value());
  way.add(Stamp::from_seconds(1.0), {1.0, 2.0, 0.5});
  EXPECT_FALSE(way.drive({1.0, 2.0, 0.5}).has_value());
}

TEST(WayBack, MovesWithTheMap) {
  test::PlantedMapper mapper;
  WayBack way;
  for (int i = 0; i <= 50; ++i) {
    const Stamp now = Stamp::from_seconds(i);
    mapper.plant(now, {0.02 * i, 0.0, 0.0});
    way.add(now, {0.02 * i, 0.0, 0.0});
  }
  const TPose2D shift{0.0, 3.0, deg_to_rad(90.0)};
  mapper.correct(Stamp::from_seconds(100.0), shift);
  way.follow(mapper);
  const Retraced run = retrace(way, shift + TPose2D{1.0, 0.0, 0.0});
  EXPECT_NEAR(distance(position(run.end), position(shift)), 0.0, 0.06);
}

}  // namespace
}  // namespace rubble::explore
