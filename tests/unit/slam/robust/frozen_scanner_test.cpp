#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/planar.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

/// A scanner that repeats what it saw while the robot drives on says no more than one that sees nothing.
namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;
using robot::Inputs;
using robot::RobotModel;
using slam_test::figure;
using Ticks = std::vector<Inputs>;

constexpr std::size_t kFrozenFrom = 60;
constexpr std::size_t kFrozenTo = 110;

slam_test::Drive round_the_room() {
  return slam_test::drive_through(
      {{0.0, 0.0}, {0.6, 0.0}, {3.2, 0.2}, {3.2, 1.0}, {0.0, 0.5}, {-1.4, -0.8}, {1.0, -0.6}, {0.0, 0.0}}, 0.0);
}

Ticks recorded_in_room(const slam_test::Drive& drive, double noise, std::uint64_t seed) {
  return slam_test::record(slam_test::furnished_room(), drive, RobotModel(), noise > 0.0 ? 1.0 : 0.0, noise, seed);
}

/// From kFrozenFrom to kFrozenTo with what the scan before saw.
Ticks with_frozen(Ticks ticks) {
  for (std::size_t i = kFrozenFrom; i < kFrozenTo; ++i)
    ticks[i].scans.front().ranges = ticks[kFrozenFrom - 1].scans.front().ranges;
  return ticks;
}

Ticks with_blind(Ticks ticks) {
  for (std::size_t i = kFrozenFrom; i < kFrozenTo; ++i)
    for (float& range : ticks[i].scans.front().ranges) range = std::numeric_limits<float>::quiet_NaN();
  return ticks;
}

TEST(FrozenScanner, IsNoWorseThanABlindOne) {
  const slam_test::Drive drive = round_the_room();
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const double noise : {0.01, 0.0}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", noise " + std::to_string(noise));
      const Ticks ticks = recorded_in_room(drive, noise, seed);
      RobustMapper without(RobotModel(), {}, 1);
      const auto seen = slam_test::play(without, with_blind(ticks), slam_test::furnished_room(), drive.truth);
      RobustMapper mapper(RobotModel(), {}, 1);
      const auto o = slam_test::play(mapper, with_frozen(ticks), slam_test::furnished_room(), drive.truth);
      EXPECT_LT(o.rmse, seen.rmse + 0.03);
      EXPECT_LT(o.heading, seen.heading + deg_to_rad(2.0));
      EXPECT_LT(o.outside, 0.02);
      EXPECT_GT(o.occupied, 300);
      EXPECT_GT(figure(mapper, "scans_repeated"), 40.0);
      EXPECT_LE(figure(mapper, "scans_repeated"), static_cast<double>(kFrozenTo - kFrozenFrom));
      EXPECT_EQ(figure(without, "scans_repeated"), 0.0);
    }
}

/// Of a robot that stands, scans without noise are the same, and true.
TEST(FrozenScanner, ARobotThatStandsSeesTheSameAgain) {
  slam_test::Drive drive = round_the_room();
  const auto at = drive.truth.begin() + static_cast<std::ptrdiff_t>(kFrozenFrom);
  drive.truth.insert(at, 50, drive.truth[kFrozenFrom]);
  for (std::size_t i = 0; i < drive.truth.size(); ++i)
    drive.truth[i].stamp = Stamp{static_cast<std::int64_t>(i) * 100000000};
  RobustMapper mapper(RobotModel(), {}, 1);
  const auto o = slam_test::play(mapper, recorded_in_room(drive, 0.0, 1), slam_test::furnished_room(), drive.truth);
  EXPECT_LT(o.rmse, 0.02);
  EXPECT_EQ(figure(mapper, "scans_repeated"), 0.0);
  EXPECT_EQ(figure(mapper, "unseen"), 0.0);
}

/// Along a bare corridor a scanner without noise sees the same all the way.
TEST(FrozenScanner, WithoutNoiseABareCorridorIsNotTakenForAHungScanner) {
  slam_test::World corridor;
  slam_test::add_box(corridor, -20.0, -0.6, 20.0, 0.6);
  const slam_test::Drive drive = slam_test::drive_through({{0.0, 0.0}, {4.0, 0.0}}, 0.0);
  RobustMapper mapper(RobotModel(), {}, 1);
  const auto o =
      slam_test::play(mapper, slam_test::record(corridor, drive, RobotModel(), 0.0, 0.0, 1), corridor, drive.truth);
  EXPECT_LT(o.rmse, 0.02);
  EXPECT_EQ(figure(mapper, "scans_repeated"), 0.0);
  EXPECT_EQ(figure(mapper, "unseen"), 0.0);
}

/// Wheels that spin on a robot that is held: what a scanner without noise repeats is true then, and a robot that stood
/// before has shown that it has none.
TEST(FrozenScanner, WithoutNoiseAPinnedRobotIsNotTakenForAHungScanner) {
  constexpr std::size_t kStood = 10;
  constexpr double kSpin = 0.02;  // from tick to tick [m]
  slam_test::Drive drive = round_the_room();
  drive.truth.insert(drive.truth.begin() + static_cast<std::ptrdiff_t>(kFrozenFrom), kFrozenTo - kFrozenFrom,
                     drive.truth[kFrozenFrom]);
  drive.truth.insert(drive.truth.begin(), kStood, drive.truth.front());
  for (std::size_t i = 0; i < drive.truth.size(); ++i)
    drive.truth[i].stamp = Stamp{static_cast<std::int64_t>(i) * 100000000};
  Ticks ticks = recorded_in_room(drive, 0.0, 1);
  TPose2D last, spun;
  for (std::size_t i = 0; i < ticks.size(); ++i)
    for (robot::Odometry& report : ticks[i].odometry) {
      const TPose2D step = i == 0 ? TPose2D() : report.pose - last;
      last = report.pose;
      const bool pinned = i > kStood + kFrozenFrom && i < kStood + kFrozenTo;
      report.pose = spun = i == 0 ? report.pose : spun + step + (pinned ? TPose2D(kSpin, 0.0, 0.0) : TPose2D());
    }
  RobustMapper mapper(RobotModel(), {}, 1);
  const auto o = slam_test::play(mapper, ticks, slam_test::furnished_room(), drive.truth);
  EXPECT_LT(o.rmse, 0.02);
  EXPECT_EQ(figure(mapper, "scans_repeated"), 0.0);
}

}  // namespace
}  // namespace rubble::slam
