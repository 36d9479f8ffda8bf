#include "slam/paper/paper_mapper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Inputs;
using robot::RobotModel;

const std::vector<TPoint2D> kTour{{0.0, 0.0},   {3.2, 0.2},  {3.2, 1.0}, {0.0, 0.5},
                                  {-1.4, -0.8}, {1.0, -0.6}, {0.0, 0.0}};

Trajectory odometry_of(const std::vector<Inputs>& ticks) {
  Trajectory trajectory;
  for (const Inputs& tick : ticks) trajectory.push_back({tick.odometry.front().stamp, tick.odometry.front().pose});
  return trajectory;
}

void play(PaperMapper& mapper, const std::vector<Inputs>& ticks) {
  for (const Inputs& tick : ticks) mapper.update(tick);
}

TEST(PaperMapper, TrajectoryIsFarBetterThanTheOdometry) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto ticks = slam_test::record(slam_test::furnished_room(), drive, model, 1.5, 0.01, seed);
    PaperMapper mapper(model, {}, seed);
    play(mapper, ticks);
    const double odometry = slam_test::first_pose_rmse(odometry_of(ticks), drive.truth);
    const double mapped = slam_test::first_pose_rmse(mapper.trajectory(), drive.truth);
    EXPECT_LT(mapped, 0.10);
    EXPECT_LT(mapped, 0.4 * odometry);
  }
}

TEST(PaperMapper, RoomHasItsSize) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  PaperMapper mapper(model, {}, 1);
  play(mapper, slam_test::record(slam_test::furnished_room(), drive, model, 1.0, 0.01, 1));
  const OccupancyGrid grid = mapper.map().classify();
  // Walk from the middle of the room to the first wall cells west, east, south and north.
  const auto wall = [&](Cell from, int dx, int dy) {
    Cell c = from;
    while (grid.inside(c) && grid[c] != Occupancy::Occupied) c = {c.x + dx, c.y + dy};
    return c;
  };
  const Cell middle = grid.cell({1.0, 0.3});
  const double width = (wall(middle, 1, 0).x - wall(middle, -1, 0).x) * grid.resolution();
  const double height = (wall(middle, 0, 1).y - wall(middle, 0, -1).y) * grid.resolution();
  EXPECT_NEAR(width, 6.0, 0.15);
  EXPECT_NEAR(height, 4.0, 0.15);
}

TEST(PaperMapper, SameSeedSameBits) {
  const RobotModel model;
  const auto ticks =
      slam_test::record(slam_test::furnished_room(), slam_test::drive_through(kTour, 0.0), model, 1.0, 0.01, 4);
  PaperMapper a(model, {}, 7);
  PaperMapper b(model, {}, 7);
  PaperMapper other(model, {}, 8);
  play(a, ticks);
  play(b, ticks);
  play(other, ticks);
  ASSERT_EQ(a.trajectory().size(), b.trajectory().size());
  for (std::size_t i = 0; i < a.trajectory().size(); ++i) EXPECT_EQ(a.trajectory()[i].pose, b.trajectory()[i].pose);
  ASSERT_EQ(a.map().frame(), b.map().frame());
  EXPECT_EQ(slam_test::p_occ_of(a.map()), slam_test::p_occ_of(b.map()));
  EXPECT_NE(a.trajectory().back().pose, other.trajectory().back().pose);
}

TEST(PaperMapper, MapFrameIsTheBaseAtTheFirstScan) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through({{1.0, 0.5}, {2.0, 0.5}}, 2.0);
  PaperMapper mapper(model, {}, 1);
  play(mapper, slam_test::record(slam_test::furnished_room(), drive, model, 0.0, 0.01, 1));
  EXPECT_EQ(mapper.trajectory().front().pose, TPose2D());
  const TPose2D expected = drive.truth.back().pose - drive.truth.front().pose;
  EXPECT_NEAR(mapper.pose().x, expected.x, 0.06);
  EXPECT_NEAR(mapper.pose().y, expected.y, 0.06);
  EXPECT_NEAR(wrap_angle(mapper.pose().phi - expected.phi), 0.0, 0.03);
}

std::vector<Inputs> standing(const RobotModel& model, int ticks, double x) {
  std::vector<Inputs> all;
  Rng noise(2, "scan");
  for (int i = 0; i < ticks; ++i) {
    Inputs inputs;
    inputs.now = Stamp{i * 100000000ll};
    inputs.odometry.push_back({inputs.now, {x, 0.0, 0.0}, 0.0, 0.0, false});
    inputs.scans.push_back(
        slam_test::scan_at(slam_test::furnished_room(), {x, 0.0, 0.0}, model, inputs.now, 0.01, noise));
    all.push_back(inputs);
  }
  return all;
}

TEST(PaperMapper, StandingStillMapsTheFirstScansOnly) {
  const RobotModel model;
  PaperConfig config;
  PaperMapper mapper(model, config, 1);
  play(mapper, standing(model, 50, 0.0));
  EXPECT_EQ(mapper.counts().scans, 50u);
  EXPECT_EQ(mapper.counts().mapped, static_cast<std::uint64_t>(config.first_scans));
  EXPECT_EQ(mapper.trajectory().size(), 50u);
  EXPECT_EQ(mapper.map().version(), mapper.counts().mapped);
}

TEST(PaperMapper, PoseIsCarriedOnByOdometryBetweenScans) {
  const RobotModel model;
  PaperMapper mapper(model, {}, 1);
  play(mapper, standing(model, 10, 0.0));
  const TPose2D before = mapper.pose();
  Inputs inputs;
  inputs.now = Stamp{2000000000};
  inputs.odometry.push_back({inputs.now, {0.3, 0.0, 0.1}, 0.0, 0.0, false});
  mapper.update(inputs);
  const TPose2D after = mapper.pose() - before;
  EXPECT_NEAR(after.x, 0.3, 1e-9);
  EXPECT_NEAR(after.phi, 0.1, 1e-9);
}

TEST(PaperMapper, ScanWaitsForOdometryFromAfterIt) {
  const RobotModel model;
  PaperMapper mapper(model, {}, 1);
  std::vector<Inputs> ticks = standing(model, 2, 0.0);
  ticks[0].scans[0].beam_period = 1e-4;  // its middle lies 34 ms after the odometry
  mapper.update(ticks[0]);
  EXPECT_TRUE(mapper.trajectory().empty());
  ticks[1].scans.clear();
  mapper.update(ticks[1]);
  ASSERT_EQ(mapper.trajectory().size(), 1u);
  EXPECT_EQ(mapper.trajectory()[0].stamp, ticks[0].scans[0].middle());
}

TEST(PaperMapper, ScanDoesNotWaitForEverWhenOdometryFallsSilent) {
  const RobotModel model;
  PaperMapper mapper(model, {}, 1);
  std::vector<Inputs> ticks = standing(model, 10, 0.0);
  for (std::size_t i = 1; i < ticks.size(); ++i) ticks[i].odometry.clear();
  play(mapper, ticks);
  EXPECT_GE(mapper.trajectory().size(), 7u);
}

TEST(PaperMapper, LogsWithoutOdometryAreMappedByScanMatchingAlone) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  auto ticks = slam_test::record(slam_test::furnished_room(), drive, model, 1.0, 0.01, 1);
  for (Inputs& tick : ticks) tick.odometry.clear();
  PaperMapper mapper(model, {}, 1);
  play(mapper, ticks);
  EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.15);
}

TEST(PaperMapper, RepeatedAndEmptyScansAreDroppedAndCounted) {
  const RobotModel model;
  PaperMapper mapper(model, {}, 1);
  std::vector<Inputs> ticks = standing(model, 3, 0.0);
  ticks[1].scans.push_back(ticks[0].scans[0]);
  ticks[2].scans.push_back({});
  play(mapper, ticks);
  EXPECT_EQ(mapper.counts().scans, 5u);
  EXPECT_EQ(mapper.counts().out_of_order, 2u);
  EXPECT_EQ(mapper.trajectory().size(), 3u);
}

TEST(PaperMapper, BlindScansCarryThePoseOn) {
  const RobotModel model;
  PaperMapper mapper(model, {}, 1);
  auto ticks = slam_test::record({}, slam_test::drive_through({{0.0, 0.0}, {1.0, 0.0}}, 0.0), model, 0.0, 0.0, 1);
  play(mapper, ticks);
  EXPECT_GT(mapper.pose().x, 0.8);
  EXPECT_TRUE(mapper.last_hits().empty());
}

TEST(PaperMapper, LastHitsLieOnTheWalls) {
  const RobotModel model;
  PaperMapper mapper(model, {}, 1);
  const std::size_t scans = static_cast<std::size_t>(PaperConfig{}.first_scans);
  play(mapper, standing(model, static_cast<int>(scans), 0.0));
  ASSERT_GT(mapper.last_hits().size(), 400u);
  int on_occupied = 0;
  for (const TPoint2D& p : mapper.last_hits()) on_occupied += mapper.map().p_occ(mapper.map().frame().cell(p)) > 0.0;
  EXPECT_EQ(on_occupied, static_cast<int>(mapper.last_hits().size()));
}

/// As printed: resampling alone waits for motion.
TEST(PaperMapper, WithTheResamplingGatedEachScanIsMapped) {
  const RobotModel model;
  PaperConfig config;
  config.gated = GatedPart::Resampling;
  config.icp = false;  // its jitter would be motion
  PaperMapper standing_still(model, config, 1);
  play(standing_still, standing(model, 50, 0.0));
  EXPECT_EQ(standing_still.counts().mapped, 50u);
  EXPECT_EQ(standing_still.pose(), TPose2D()) << "no motion, no error";

  config.icp = true;
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  const auto ticks = slam_test::record(slam_test::furnished_room(), drive, model, 1.0, 0.01, 1);
  PaperMapper driving(model, config, 1);
  play(driving, ticks);
  EXPECT_EQ(driving.counts().mapped, ticks.size());
}

/// The scan matcher's motion from scan to scan adds up: without noise to where the robot is, whatever is mapped.
TEST(PaperMapper, IcpMatchesWithTheLastScanOrTheLastMappedOne) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  const auto ticks = slam_test::record(slam_test::furnished_room(), drive, model, 1.5, 0.0, 1);
  const double odometry = slam_test::first_pose_rmse(odometry_of(ticks), drive.truth);
  for (const bool trimmed : {true, false})
    for (const IcpTarget target : {IcpTarget::LastMapped, IcpTarget::LastScan}) {
      SCOPED_TRACE(std::string(trimmed ? "trimmed" : "whole") +
                   (target == IcpTarget::LastScan ? ", last scan" : ", last mapped"));
      PaperConfig config;
      config.icp_target = target;
      config.icp_trimmed = trimmed;
      PaperMapper mapper(model, config, 1);
      play(mapper, ticks);
      EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.5 * odometry);
    }
}

/// A pose belongs to the moment that it is given out for, de-skewed or not.
TEST(PaperMapper, PoseIsThatOfTheReferenceOfTheSweep) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through({{0.0, 0.0}, {3.0, 0.0}}, 0.0);
  const auto ticks = slam_test::record_sweeping(slam_test::furnished_room(), drive, model, 0.0, 0.0, 0.0665, 1);
  for (const SweepReference reference : {SweepReference::Middle, SweepReference::Stamp}) {
    PaperConfig config;
    config.sweep_reference = reference;
    PaperMapper mapper(model, config, 1);
    play(mapper, ticks);
    ASSERT_GT(mapper.trajectory().size(), 20u);
    const robot::LaserScan& scan = ticks[1].scans.front();
    const Stamp expected = reference == SweepReference::Stamp ? scan.stamp : scan.middle();
    EXPECT_EQ(mapper.trajectory().front().stamp, expected);
    EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.03);
  }
}

}  // namespace
}  // namespace rubble::slam
