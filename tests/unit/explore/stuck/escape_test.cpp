#include "explore/stuck/escape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kEscapeTick = 0.02;

/// A point robot that does what it is told where `may` lets it.
struct Puppet {
  TPose2D pose;
  std::function<bool(const TPose2D&)> may = [](const TPose2D&) { return true; };
  void obey(const robot::Drive& drive) {
    const TPose2D next = pose + TPose2D{drive.v * kEscapeTick, 0.0, drive.w * kEscapeTick};
    if (may(next)) pose = next;
  }
};

struct Outcome {
  Escape::Result result = Escape::Result::UnderWay;
  double seconds = 0.0;
};

Outcome run(Puppet& puppet, Escape::Met met, const std::vector<TPoint2D>& trail, const Escape::Around& around,
            int failures = 0, const WayBack& came = {}, std::optional<WayOut> way_out = std::nullopt) {
  Escape escape(deg_to_rad(60.0));
  WayBack way_back = came;
  Stamp now = Stamp::from_seconds(1.0);
  escape.begin(met, puppet.pose, now, failures, std::move(way_out));
  Outcome outcome;
  while (outcome.result == Escape::Result::UnderWay && outcome.seconds < 300.0) {
    way_back.add(now, puppet.pose);
    outcome.result =
        escape.step(puppet.pose, escape.drive(), false, {}, false, kEscapeTick, now, trail, way_back, around);
    puppet.obey(escape.drive());
    now = now + kEscapeTick;
    outcome.seconds += kEscapeTick;
  }
  return outcome;
}

const Escape::Around kRoom{[](const TPose2D&) { return true; }, [](const TPose2D&) { return 1.0; }};

TEST(Escape, GoesBackHalfAMetreTheWayItCame) {
  Puppet puppet;
  const Outcome outcome = run(puppet, Escape::Met::Forwards, {}, kRoom);
  EXPECT_EQ(outcome.result, Escape::Result::Free);
  EXPECT_NEAR(puppet.pose.x, -0.5, 0.02);
  EXPECT_NEAR(puppet.pose.y, 0.0, 0.02);
}

TEST(Escape, FollowsATrailThatBends) {
  std::vector<TPoint2D> trail;
  for (double a = 60.0; a > 0.0; a -= 5.0) trail.push_back({-std::sin(deg_to_rad(a)), 1.0 - std::cos(deg_to_rad(a))});
  Puppet puppet;
  run(puppet, Escape::Met::Forwards, trail, kRoom);
  EXPECT_GT(puppet.pose.y, 0.04);
}

/// Between two edges, on paper: the inner wheels of a bend hold it.
TEST(Escape, BacksOffStraightWhereABendIsHeld) {
  std::vector<TPoint2D> trail;
  for (double a = 60.0; a > 0.0; a -= 5.0) trail.push_back({-std::sin(deg_to_rad(a)), 1.0 - std::cos(deg_to_rad(a))});
  Puppet puppet;
  puppet.may = [](const TPose2D& pose) { return pose.phi == 0.0 && pose.x < 0.02; };
  const Outcome outcome = run(puppet, Escape::Met::Forwards, trail, kRoom);
  EXPECT_EQ(outcome.result, Escape::Result::Free);
  EXPECT_LT(outcome.seconds, 8.0);
  EXPECT_NEAR(puppet.pose.x, -0.5, 0.02);
}

TEST(Escape, TriesOtherWaysWhereTheWayBackIsHeldToo) {
  Puppet puppet;
  puppet.may = [](const TPose2D& pose) { return pose.x > -0.1; };  // a half plane behind it
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, kRoom).result, Escape::Result::Free);
  EXPECT_GT(puppet.pose.x, -0.11);
}

TEST(Escape, DoesNotBackIntoAWallItKnows) {
  Puppet puppet;
  const Escape::Around around{[](const TPose2D& pose) { return pose.x > -0.3; }, kRoom.gap};
  double least = 0.0;
  puppet.may = [&](const TPose2D& pose) {
    least = std::min(least, pose.x);
    return true;
  };
  run(puppet, Escape::Met::Forwards, {}, around);
  EXPECT_GT(least, -0.3);
}

/// A wall stands to its left, so near that its corners do not pass; nothing but a turn to the right leads out.
TEST(Escape, TurnsNoCornerIntoAWallItKnows) {
  Puppet puppet;
  double most_left = 0.0;
  puppet.may = [&](const TPose2D& next) {
    most_left = std::max(most_left, next.phi);
    const bool turns = next.x == puppet.pose.x && next.y == puppet.pose.y;
    return turns || puppet.pose.phi < deg_to_rad(-50.0);
  };
  const Escape::Around around{kRoom.room, [](const TPose2D& pose) { return 0.05 - 0.25 * std::max(0.0, pose.phi); }};
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, around).result, Escape::Result::Free);
  EXPECT_LT(most_left, 0.05 / 0.25);
}

TEST(Escape, TurnsAwayFromAWallItTouches) {
  Puppet puppet;
  puppet.may = [&](const TPose2D& next) {
    const bool turns = next.x == puppet.pose.x && next.y == puppet.pose.y;
    return turns || puppet.pose.phi > deg_to_rad(50.0);
  };
  const Escape::Around touching{kRoom.room, [](const TPose2D& pose) { return 0.2 * pose.phi - 0.01; }};
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, touching).result, Escape::Result::Free);
}

/// Flush with a wall every turn brings a corner to it, and nothing but a turn leads off: its corner scrapes along.
TEST(Escape, TurnsAlongAWallThatItIsFlushWithAfterAnEscapeThatFailed) {
  const auto flush = [](const TPose2D& pose) { return -0.25 * std::abs(std::sin(2.0 * pose.phi)); };
  const auto try_after = [&](int failures) {
    Puppet puppet;
    puppet.may = [&](const TPose2D& next) {
      const bool turns = next.x == puppet.pose.x && next.y == puppet.pose.y;
      return turns || std::abs(puppet.pose.phi) > deg_to_rad(50.0);
    };
    return run(puppet, Escape::Met::Turning, {}, {kRoom.room, flush}, failures).result;
  };
  EXPECT_EQ(try_after(0), Escape::Result::Failed) << "walls are spared as long as other ways may do";
  EXPECT_EQ(try_after(1), Escape::Result::Free);
}

/// Between steps only one direction leads out, and turns of 60 degrees miss it: the next try turns by another angle.
TEST(Escape, TriesOtherAnglesAfterItFailed) {
  const double way_out = deg_to_rad(100.0);
  const auto try_all = [&](int tries) {
    Puppet puppet;
    puppet.may = [&](const TPose2D& next) {
      const bool turns = next.x == puppet.pose.x && next.y == puppet.pose.y;
      return turns || std::abs(wrap_angle(puppet.pose.phi - way_out)) < deg_to_rad(12.0);
    };
    for (int failures = 0; failures < tries; ++failures) {
      puppet.pose = {};
      if (run(puppet, Escape::Met::Turning, {}, kRoom, failures).result == Escape::Result::Free) return true;
    }
    return false;
  };
  EXPECT_FALSE(try_all(1));
  EXPECT_TRUE(try_all(4));
}

/// In by an arc between steps that let nothing turn: out by the same arc, though neither straight back nor turns help.
TEST(Escape, RetracesPoseByPoseWhatLetsItThroughInNoOtherWay) {
  const auto on_arc = [](const TPose2D& p) {  // 0.8 m about (0, 0.8), heading along it
    return std::abs(std::hypot(p.x, p.y - 0.8) - 0.8) < 0.03 &&
           std::abs(wrap_angle(std::atan2(p.x, 0.8 - p.y) - p.phi)) < deg_to_rad(7.0);
  };
  WayBack came;
  Puppet puppet;
  for (double a = -60.0; a <= 0.0; a += 0.5) {
    const double phi = deg_to_rad(a);
    puppet.pose = {0.8 * std::sin(phi), 0.8 - 0.8 * std::cos(phi), phi};
    ASSERT_TRUE(on_arc(puppet.pose));
    came.add(Stamp::from_seconds(1.0), puppet.pose);
  }
  puppet.may = on_arc;
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, kRoom).result, Escape::Result::Failed) << "the case is too easy";
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, kRoom, 1, came).result, Escape::Result::Free);
  EXPECT_TRUE(on_arc(puppet.pose));
}

/// On a pallet of steps it would be held again half a metre back.
TEST(Escape, LeavesATrapAllTheWay) {
  Trap trap;
  trap.size = 1.2;
  Puppet puppet;
  const WayOut way_out(robot::RobotModel{}, trap, {}, {});
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, kRoom, 0, {}, way_out).result, Escape::Result::Free);
  EXPECT_FALSE(trap.holds({puppet.pose.x, puppet.pose.y}, 0.25)) << "its body is off it as well";
  puppet.pose = {};
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, {}, kRoom).result, Escape::Result::Free);
  EXPECT_TRUE(trap.holds({puppet.pose.x, puppet.pose.y})) << "the case is too easy";
}

/// Straight back would be quicker, but it came in by a bend between things that stand to both sides of it.
TEST(Escape, BacksOutOfATrapAlongItsTrailToTheEnd) {
  Trap trap;
  trap.size = 1.2;
  const auto aside = [](const TPose2D& p) { return std::abs(std::hypot(p.x, p.y - 1.2) - 1.2); };
  std::vector<TPoint2D> trail;
  for (double a = -75.0; a <= 0.0; a += 5.0)
    trail.push_back({1.2 * std::sin(deg_to_rad(a)), 1.2 - 1.2 * std::cos(deg_to_rad(a))});
  Puppet puppet;
  double most = 0.0, ahead = 0.0;
  puppet.may = [&](const TPose2D& p) {
    most = std::max(most, aside(p));
    ahead = std::max(ahead, p.x - puppet.pose.x);
    return true;
  };
  const WayOut way_out(robot::RobotModel{}, trap, {}, {});
  EXPECT_EQ(run(puppet, Escape::Met::Forwards, trail, kRoom, 0, {}, way_out).result, Escape::Result::Free);
  EXPECT_LT(most, 0.08);
  EXPECT_LT(ahead, 1e-4) << "never ahead";
}

/// Floor that it had left the other way before: of the two passes the last one counts.
TEST(Escape, BacksAlongTheLastOfTwoPasses) {
  Trap trap;
  trap.size = 1.2;
  const auto arc = [](double radius, double deg) {
    return TPoint2D{radius * std::sin(deg_to_rad(deg)), 1.2 - radius * std::cos(deg_to_rad(deg))};
  };
  const auto most_aside = [&](const std::vector<TPoint2D>& trail) {
    Puppet puppet;
    double most = 0.0;
    puppet.may = [&](const TPose2D& p) {
      most = std::max(most, std::abs(std::hypot(p.x, p.y - 1.2) - 1.2));
      return true;
    };
    run(puppet, Escape::Met::Forwards, trail, kRoom, 0, {}, WayOut(robot::RobotModel{}, trap, {}, {}));
    return most;
  };
  std::vector<TPoint2D> once, twice;
  for (double deg = -75.0; deg <= 0.0; deg += 7.0) once.push_back(arc(1.2, deg));
  for (double deg = -1.0; deg >= -75.0; deg -= 7.0) twice.push_back(arc(1.21, deg));
  twice.insert(twice.end(), once.begin(), once.end());
  EXPECT_LT(most_aside(twice), most_aside(once) + 0.005);
}

/// Where no plan leads out, pose by pose the way it came may.
TEST(Escape, RetracesItsWayOutOfATrapWithoutAPlan) {
  Trap trap;
  trap.size = 1.2;
  std::vector<TPoint2D> ring;
  for (double a = 0.0; a < 2.0 * kPi; a += 0.1) ring.push_back({0.5 * std::cos(a), 0.5 * std::sin(a)});
  WayBack came;
  for (double x = -1.5; x <= 0.0; x += 0.02) came.add(Stamp::from_seconds(1.0), {x, 0.0, 0.0});
  Puppet puppet;
  double aside = 0.0;
  puppet.may = [&](const TPose2D& p) {
    aside = std::max(aside, std::abs(p.y));
    return true;
  };
  const Outcome outcome =
      run(puppet, Escape::Met::Forwards, {}, kRoom, 0, came, WayOut(robot::RobotModel{}, trap, ring, {}));
  EXPECT_EQ(outcome.result, Escape::Result::Free);
  EXPECT_LT(puppet.pose.x, -0.85);
  EXPECT_LT(aside, 0.01);
}

/// The motors report a stall for some 0.3 s more; the way back is none the worse for that.
TEST(Escape, TheStallThatBeganItDoesNotEndItsFirstMove) {
  for (const double lasts : {0.4, 5.0}) {
    Puppet puppet;
    puppet.may = [&](const TPose2D&) { return lasts < 1.0; };
    Escape escape(deg_to_rad(60.0));
    Stamp now = Stamp::from_seconds(1.0);
    escape.begin(Escape::Met::Forwards, {}, now);
    bool turned = false;
    for (double t = 0.0; t < 2.0; t += kEscapeTick, now = now + kEscapeTick) {
      escape.step(puppet.pose, escape.drive(), t < lasts, {}, false, kEscapeTick, now, {}, {}, kRoom);
      puppet.obey(escape.drive());
      turned = turned || escape.drive().w != 0.0;
    }
    EXPECT_EQ(turned, lasts > 1.0) << lasts;
  }
}

/// Between two poses of its way that it cannot get to it would rock for as long as a move may last.
TEST(Escape, AMoveThatRocksInItsPlaceIsGivenUp) {
  WayBack came;
  for (const double x : {-0.15, -0.10, -0.05, 0.0}) came.add(Stamp::from_seconds(1.0), {x, 0.0, 0.0});
  Escape escape(deg_to_rad(60.0));
  Stamp now = Stamp::from_seconds(1.0);
  escape.begin(Escape::Met::Forwards, {}, now, 1);
  const auto straight_back = [&] { return escape.drive().v == -0.2 && escape.drive().w == 0.0; };
  double t = 0.0;
  for (; !straight_back() && t < 20.0; t += kEscapeTick, now = now + kEscapeTick) {
    const TPose2D pose{0.0, 0.0, deg_to_rad(3.0) * std::sin(8.0 * t)};
    const robot::Drive none;  // it is turned against what it does, now to one side, now to the other
    ASSERT_EQ(escape.step(pose, none, false, {}, false, kEscapeTick, now, {}, came, kRoom), Escape::Result::UnderWay);
  }
  EXPECT_LT(t, 4.0);
}

/// Flush with a wall it neither turns on the spot nor gets anywhere straight on: the next try turns as it rolls.
TEST(Escape, AfterAFailureItTurnsAsItRolls) {
  for (const int failures : {0, 1, 2}) {
    Puppet puppet;
    puppet.may = [&](const TPose2D& next) {
      return next.phi != puppet.pose.phi && position(next) != position(puppet.pose);
    };
    const Outcome outcome = run(puppet, Escape::Met::Forwards, {}, kRoom, failures);
    EXPECT_EQ(outcome.result, failures > 0 ? Escape::Result::Free : Escape::Result::Failed) << failures;
  }
}

/// A dead end at the foot of a slope: a wall to its right that it slides down to as it turns, one ahead, one behind,
/// and the only way out up the slope, to its left. From a curve that leads off the wall it has to go on straight in
/// time.
TEST(Escape, GoesOnStraightWhereACurveHasOpenedTheWayOut) {
  constexpr double kHalf = 0.25, kSide = 0.45, kSlide = 0.2;
  const auto corners = [](const TPose2D& pose) {
    std::vector<TPoint2D> all;
    for (const double x : {-kHalf, kHalf})
      for (const double y : {-kHalf, kHalf}) all.push_back(pose.composePoint({x, y}));
    return all;
  };
  const auto gap_aside = [&](const TPose2D& pose) {
    double least = 1.0;
    for (const TPoint2D& corner : corners(pose)) least = std::min(least, kSide - std::abs(corner.x));
    return least;
  };
  const auto gap_below = [&](const TPose2D& pose) {
    double least = 1.0;
    for (const TPoint2D& corner : corners(pose)) least = std::min(least, corner.y + kHalf);
    return least;
  };
  const auto gap = [&](const TPose2D& pose) { return std::min(gap_aside(pose), gap_below(pose)); };
  Puppet puppet;
  puppet.may = [&](TPose2D next) {
    if (next.phi != puppet.pose.phi) next.y -= kSlide * kEscapeTick;
    next.y -= std::min(0.0, gap_below(next));  // the wall pushes it off
    if (gap_aside(next) >= 0.0) puppet.pose = next;
    return false;
  };
  const Escape::Around around{[&](const TPose2D& pose) { return std::abs(pose.x) < kSide - kHalf; }, gap};
  const Outcome outcome = run(puppet, Escape::Met::Turning, {}, around, 1);
  EXPECT_EQ(outcome.result, Escape::Result::Free);
  EXPECT_GT(puppet.pose.y, 0.3);
}

TEST(Escape, SaysSoWhenNothingHelps) {
  Puppet puppet;
  puppet.may = [](const TPose2D&) { return false; };
  const Outcome outcome = run(puppet, Escape::Met::Forwards, {}, kRoom);
  EXPECT_EQ(outcome.result, Escape::Result::Failed);
  EXPECT_LT(outcome.seconds, 90.0);
}

}  // namespace
}  // namespace rubble::explore
