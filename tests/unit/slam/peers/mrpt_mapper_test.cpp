// What MRPT's builders are given and what is made of their answers, shown by the one that draws no random numbers.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "robot/beam_order.h"
#include "slam/peers/mrpt_mapper.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using robot::Inputs;

struct MrptIcpMapper : MrptMapper {
  explicit MrptIcpMapper(const robot::RobotModel& model = {})
      : MrptMapper(model, MrptIcpConfig().resolution, mrpt_slam().icp_builder(model, {})) {}
};

const std::vector<TPoint2D> kTour{{0.0, 0.0}, {3.0, 0.2}, {3.0, 1.0}, {0.5, 0.5}, {0.0, 0.0}};

std::vector<Inputs> recorded(const slam_test::Drive& drive, std::uint64_t seed) {
  return slam_test::record(slam_test::furnished_room(), drive, robot::RobotModel(), 1.0, 0.01, seed);
}

/// A builder whose grid is wide, as MRPT's becomes where poses go astray, and knows little of it.
class WideBuilder : public MapBuilder {
 public:
  static constexpr int kWidth = 9000;

  void process(const mrpt::math::TPose2D&, const robot::LaserScan&) override { ++steps_; }
  std::vector<mrpt::math::TPose2D> path() const override { return std::vector<mrpt::math::TPose2D>(steps_); }
  PoseCovariance uncertainty() const override { return {}; }
  BuilderGrid grid() const override {
    BuilderGrid grid{-445.0f, -1.0f, kWidth, 40, std::vector<float>(kWidth * 40, 0.5f)};
    const auto set = [&](int x, int y, float p_free) {
      grid.p_free[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] = p_free;
    };
    set(8910, 22, 0.1f);  // 0.5 m ahead of the start and 0.1 m to the left
    set(8890, 15, 0.9f);  // 0.5 m behind it, 0.25 m to the right
    set(100, 5, 0.1f);    // 440 m away
    return grid;
  }
  std::size_t inserted() const override { return steps_; }

 private:
  std::size_t steps_ = 0;
};

TEST(MrptMapper, ShowsOfAWideMapWhatIsKnownAndNoMoreThanOtherMappers) {
  const std::vector<Inputs> ticks = recorded(slam_test::drive_through({{0.0, 0.0}, {0.3, 0.0}}, 0.0), 3);
  MrptMapper mapper({}, 0.05, std::make_unique<WideBuilder>());
  for (const Inputs& tick : ticks) mapper.update(tick);
  const CountMap& map = mapper.map();
  EXPECT_EQ(map.frame().width, 21);
  EXPECT_EQ(map.frame().height, 8);
  EXPECT_NEAR(map.p_occ(map.frame().cell({0.51, 0.11})), 0.9, 1e-6);
  EXPECT_NEAR(map.p_occ(map.frame().cell({-0.49, -0.24})), 0.1, 1e-6);
  EXPECT_EQ(map.seen(map.frame().cell({0.01, 0.01})), 0);
}

TEST(MrptMapper, KnowsNothingBeforeTheFirstScan) {
  const MrptIcpMapper mapper;
  EXPECT_EQ(mapper.pose().norm(), 0.0);
  EXPECT_TRUE(mapper.trajectory().empty());
  EXPECT_TRUE(mapper.last_hits().empty());
  EXPECT_FALSE(mapper.pose_at(Stamp{0}));
  const OccupancyGrid grid = mapper.map().classify();
  for (const Occupancy cell : grid.cells()) EXPECT_EQ(cell, Occupancy::Unknown);
}

TEST(MrptMapper, MapsTheRoomBetterThanTheOdometry) {
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  const std::vector<Inputs> ticks = recorded(drive, 1);
  MrptIcpMapper mapper;
  const slam_test::Outcome outcome = slam_test::play(mapper, ticks, slam_test::furnished_room(), drive.truth);
  Trajectory odometry;
  for (const Inputs& tick : ticks)
    if (!tick.odometry.empty()) odometry.push_back({tick.odometry.front().stamp, tick.odometry.front().pose});
  EXPECT_LT(outcome.rmse, 0.5 * slam_test::first_pose_rmse(odometry, drive.truth));
  EXPECT_LT(outcome.rmse, 0.1);
  EXPECT_LT(outcome.outside, 0.05);
  EXPECT_GT(outcome.occupied, 300);
}

/// The scan of a laser on its head is that of one upright, told from right to left.
TEST(MrptMapper, AScannerUpsideDownMapsTheRoomAsWell) {
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  std::vector<Inputs> ticks = recorded(drive, 1);
  for (Inputs& tick : ticks)
    for (robot::LaserScan& scan : tick.scans) {
      robot::reverse_beams(scan);
      scan.angle_min = -scan.angle_min;
      scan.angle_step = -scan.angle_step;
    }
  for (const bool pitched : {false, true}) {
    robot::RobotModel model;
    if (pitched) {  // over its front: it looks backwards as well
      model.T_base_laser.pitch = kPi;
      for (Inputs& tick : ticks)
        for (robot::LaserScan& scan : tick.scans) scan.angle_min += kPi;
    } else {
      model.T_base_laser.roll = kPi;
    }
    MrptIcpMapper mapper(model);
    const slam_test::Outcome outcome = slam_test::play(mapper, ticks, slam_test::furnished_room(), drive.truth);
    EXPECT_LT(outcome.rmse, 0.1) << pitched;
    EXPECT_LT(outcome.outside, 0.05) << pitched;
    EXPECT_GT(outcome.occupied, 300) << pitched;
  }
}

TEST(MrptMapper, EveryScanHasItsPlaceOnTheTrajectory) {
  const std::vector<Inputs> ticks = recorded(slam_test::drive_through(kTour, 0.0), 2);
  MrptIcpMapper mapper;
  std::vector<Stamp> stamps;
  for (const Inputs& tick : ticks) {
    mapper.update(tick);
    for (const robot::LaserScan& scan : tick.scans) stamps.push_back(scan.middle());
  }
  ASSERT_FALSE(stamps.empty());
  EXPECT_EQ(mapper.counts().scans, stamps.size());
  EXPECT_EQ(mapper.counts().out_of_order, 0u);
  ASSERT_GE(stamps.size(), mapper.trajectory().size());
  ASSERT_LE(stamps.size(), mapper.trajectory().size() + 2);  // the last may wait for odometry
  for (std::size_t i = 0; i < mapper.trajectory().size(); ++i) {
    EXPECT_EQ(mapper.trajectory()[i].stamp, stamps[i]);
    EXPECT_EQ(mapper.live_trajectory()[i].stamp, stamps[i]);
    EXPECT_TRUE(mapper.pose_at(stamps[i]));
  }
}

TEST(MrptMapper, DoubledAndEmptyScansAreCountedAndChangeNothing) {
  std::vector<Inputs> ticks = recorded(slam_test::drive_through(kTour, 0.0), 3);
  ticks.resize(ticks.size() / 2);
  MrptIcpMapper plain, doubled;
  std::uint64_t added = 0;
  for (const Inputs& tick : ticks) {
    plain.update(tick);
    Inputs twice = tick;
    for (const robot::LaserScan& scan : tick.scans) {
      twice.scans.push_back(scan);
      robot::LaserScan empty = scan;
      empty.ranges.clear();
      twice.scans.push_back(empty);
      added += 2;
    }
    doubled.update(twice);
  }
  ASSERT_GT(added, 0u);
  EXPECT_EQ(doubled.counts().out_of_order, added);
  ASSERT_EQ(doubled.trajectory().size(), plain.trajectory().size());
  for (std::size_t i = 0; i < plain.trajectory().size(); ++i)
    EXPECT_EQ(doubled.trajectory()[i].pose, plain.trajectory()[i].pose) << i;
  EXPECT_EQ(doubled.map().classify().cells(), plain.map().classify().cells());
}

}  // namespace
}  // namespace rubble::slam
