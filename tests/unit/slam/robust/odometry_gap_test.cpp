#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Inputs;
using robot::RobotModel;
using slam_test::figure;
using Ticks = std::vector<Inputs>;

const std::vector<TPoint2D> kGapTour{{0.0, 0.0},   {0.6, 0.0},  {3.2, 0.2},   {3.2, 1.0}, {0.0, 0.5},
                                     {-1.4, -0.8}, {1.0, -0.6}, {-1.4, -0.8}, {0.0, 0.0}};
constexpr double kTurnRate = deg_to_rad(90.0);

slam_test::Drive fast_drive() { return slam_test::drive_through(kGapTour, 0.0, kTurnRate); }

/// A drive with a laser that takes 67 ms a sweep, turning at 90 deg/s.
Ticks fast_ticks(std::uint64_t seed) {
  return slam_test::record_sweeping(slam_test::furnished_room(), fast_drive(), RobotModel(), 1.0, 0.01, 0.0665, seed);
}

/// When the robot begins its turns on the spot of at least `angle`.
std::vector<Stamp> turns(const Trajectory& truth, double angle) {
  std::vector<Stamp> out;
  for (std::size_t i = 1; i < truth.size();) {
    std::size_t end = i;
    double turned = 0.0;
    while (end < truth.size() && std::abs(wrap_angle(truth[end].pose.phi - truth[end - 1].pose.phi)) > 0.02)
      turned += std::abs(wrap_angle(truth[end].pose.phi - truth[end - 1].pose.phi)), ++end;
    if (turned >= angle) out.push_back(truth[i].stamp);
    i = std::max(end, i + 1);
  }
  return out;
}

/// Calls `change` for each odometry within [from, to), which leaves it out where `change` says so.
Ticks spoiled(Ticks ticks, Stamp from, Stamp to, const std::function<bool(robot::Odometry&)>& keep) {
  for (Inputs& tick : ticks)
    for (auto o = tick.odometry.begin(); o != tick.odometry.end();)
      o = o->stamp >= from && o->stamp < to && !keep(*o) ? tick.odometry.erase(o) : o + 1;
  return ticks;
}

/// What follows `from` in a frame of its own: as if its first pose were `origin`.
Ticks reset(Ticks ticks, Stamp from, const TPose2D& origin) {
  std::optional<TPose2D> first;
  for (Inputs& tick : ticks)
    for (robot::Odometry& o : tick.odometry) {
      if (o.stamp < from) continue;
      if (!first) first = o.pose;
      o.pose = origin + (o.pose - *first);
    }
  return ticks;
}

TPose2D last_before(const Ticks& ticks, Stamp stamp) {
  TPose2D pose;
  for (const Inputs& tick : ticks)
    for (const robot::Odometry& o : tick.odometry)
      if (o.stamp < stamp) pose = o.pose;
  return pose;
}

/// Scans of a held robot arrive together with the first odometry after the gap.
Ticks held(const Ticks& ticks, Stamp from, Stamp to) {
  Ticks out;
  std::vector<robot::LaserScan> scans;
  for (const Inputs& tick : ticks) {
    const bool hold = tick.now >= from && tick.now < to;
    if (hold) {
      scans.insert(scans.end(), tick.scans.begin(), tick.scans.end());
      continue;
    }
    Inputs copy = tick;
    copy.scans.insert(copy.scans.begin(), scans.begin(), scans.end());
    scans.clear();
    out.push_back(std::move(copy));
  }
  return out;
}

void expect_good_in_spite(const Ticks& ticks) {
  RobustMapper mapper(RobotModel(), {}, 1);
  const slam_test::Outcome o = slam_test::play(mapper, ticks, slam_test::furnished_room(), fast_drive().truth);
  EXPECT_LT(o.rmse, 0.05);
  EXPECT_LT(o.heading, deg_to_rad(3.0));
  EXPECT_LT(o.outside, 0.02);
}

TEST(OdometryGap, TourTurnsFarAndFastAndIsMappedWellWithoutAFault) {
  EXPECT_GE(turns(fast_drive().truth, deg_to_rad(150.0)).size(), 2u);
  expect_good_in_spite(fast_ticks(1));
}

TEST(OdometryGap, ScansTakenAsOneInstantBendTheMapOfATourThatTurnsFast) {
  RobustConfig config;
  config.deskew = false;
  RobustMapper bent(RobotModel(), config, 1), straight(RobotModel(), {}, 1);
  const Ticks ticks = fast_ticks(1);
  const auto played = [&](RobustMapper& mapper) {
    return slam_test::play(mapper, ticks, slam_test::furnished_room(), fast_drive().truth);
  };
  const slam_test::Outcome b = played(bent), s = played(straight);
  EXPECT_GT(b.heading, 2.0 * s.heading);
  EXPECT_GT(b.outside, 5.0 * s.outside + 0.002);
}

TEST(OdometryGap, SilenceWhileTheRobotTurns) {
  const Ticks ticks = fast_ticks(2);
  for (const Stamp turn : turns(fast_drive().truth, deg_to_rad(80.0)))
    for (const double length : {1.0, 2.0, 4.0}) {
      SCOPED_TRACE("at " + std::to_string(turn.seconds()) + " s for " + std::to_string(length) + " s");
      const Stamp from = turn + 0.2;
      expect_good_in_spite(spoiled(ticks, from, from + length, [](robot::Odometry&) { return false; }));
    }
}

TEST(OdometryGap, SilenceAndAFrameThatForgotTheTurn) {
  const Ticks ticks = fast_ticks(3);
  for (const Stamp turn : turns(fast_drive().truth, deg_to_rad(80.0)))
    for (const double length : {1.0, 4.0}) {
      SCOPED_TRACE("at " + std::to_string(turn.seconds()) + " s for " + std::to_string(length) + " s");
      const Stamp from = turn + 0.2;
      const Ticks gap = spoiled(ticks, from, from + length, [](robot::Odometry&) { return false; });
      const TPose2D kept = last_before(ticks, from);
      expect_good_in_spite(reset(gap, from + length, kept));  // the frame goes on as if it had stood
      expect_good_in_spite(held(reset(gap, from + length, kept), from + 0.3, from + length));
      expect_good_in_spite(reset(gap, from + length, TPose2D()));  // or begins anew
    }
}

TEST(OdometryGap, FrozenWhileTheRobotMoves) {
  const Ticks ticks = fast_ticks(4);
  for (const Stamp turn : turns(fast_drive().truth, deg_to_rad(80.0)))
    for (const double length : {1.0, 3.0}) {
      SCOPED_TRACE("at " + std::to_string(turn.seconds()) + " s for " + std::to_string(length) + " s");
      const Stamp from = turn + 0.2;
      const TPose2D kept = last_before(ticks, from);
      expect_good_in_spite(reset(spoiled(ticks, from, from + length,
                                         [&](robot::Odometry& o) {
                                           o.pose = kept;
                                           return true;
                                         }),
                                 from + length, kept));
    }
}

TEST(OdometryGap, FrameThatBeginsAnewWithoutAGap) {
  const Ticks ticks = fast_ticks(1);
  for (const double at : {5.0, 12.3, 20.0}) {
    SCOPED_TRACE("at " + std::to_string(at) + " s");
    expect_good_in_spite(reset(ticks, ticks.front().now + at, TPose2D()));
    expect_good_in_spite(reset(ticks, ticks.front().now + at, TPose2D(40.0, -3.0, 2.0)));
  }
}

/// Scans that come seldom find odometry that has spoken all the time, and it is believed.
TEST(OdometryGap, SeldomScansAreNoSilenceOfTheOdometry) {
  for (const double apart : {2.5, 4.0}) {
    SCOPED_TRACE(apart);
    Ticks ticks = slam_test::record(slam_test::furnished_room(), fast_drive(), RobotModel(), 1.0, 0.01, 6);
    Stamp last = Stamp::never();
    for (Inputs& tick : ticks) {
      if (last != Stamp::never() && tick.now - last < apart) tick.scans.clear();
      if (!tick.scans.empty()) last = tick.now;
    }
    RobustMapper mapper(RobotModel(), {}, 1);
    const slam_test::Outcome o = slam_test::play(mapper, ticks, slam_test::furnished_room(), fast_drive().truth);
    EXPECT_GE(mapper.counts().scans, 5u);
    EXPECT_EQ(figure(mapper, "odometry_silent"), 0.0);
    EXPECT_LT(o.rmse, 0.05);
  }
}

/// A recorder that stamps what has piled up all at once makes no robot fast: two scans of a turn milliseconds apart.
TEST(OdometryGap, BunchedStampsAreNoJumps) {
  RobotModel model;
  model.laser.scan_period = 0.7;
  Rng noise(7, "scan");
  RobustMapper mapper(model, {}, 1);
  Trajectory truth;
  for (int i = 0; i < 25; ++i) {
    const TPose2D T_world_base(0.0, 0.0, wrap_angle(0.6 * i));
    Inputs tick;
    tick.now = Stamp::from_seconds(1.0 + 0.7 * (i - i % 2) + 0.005 * (i % 2));
    tick.odometry.push_back({tick.now, T_world_base, 0.0, 0.0, false});
    tick.scans.push_back(slam_test::scan_at(slam_test::furnished_room(), T_world_base, model, tick.now, 0.01, noise));
    truth.push_back({tick.now, T_world_base});
    mapper.update(tick);
  }
  mapper.finish();
  EXPECT_EQ(figure(mapper, "odometry_jumps"), 0.0);
  EXPECT_EQ(mapper.trajectory().size(), truth.size());
  EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), truth), 0.03);
}

/// Lidar and odometry both gone while the robot turns: it is found again, and nothing wrong is drawn meanwhile.
TEST(OdometryGap, NothingAtAllForAWhile) {
  const Ticks ticks = fast_ticks(1);
  for (const Stamp turn : turns(fast_drive().truth, deg_to_rad(80.0))) {
    SCOPED_TRACE("at " + std::to_string(turn.seconds()) + " s");
    const Stamp from = turn + 0.2;
    Ticks gap = spoiled(ticks, from, from + 2.0, [](robot::Odometry&) { return false; });
    for (Inputs& tick : gap)
      if (tick.now >= from && tick.now < from + 2.0) tick.scans.clear();
    expect_good_in_spite(reset(gap, from + 2.0, last_before(ticks, from)));
  }
}

}  // namespace
}  // namespace rubble::slam
