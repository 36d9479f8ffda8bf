#include "slam/robust/robust_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/planar.h"
#include "tests/support/slam_floor.h"
#include "tests/support/slam_outcome.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Inputs;
using robot::RobotModel;
using slam_test::figure;
using slam_test::play;

const std::vector<TPoint2D> kTour{{0.0, 0.0},   {3.2, 0.2},  {3.2, 1.0}, {0.0, 0.5},
                                  {-1.4, -0.8}, {1.0, -0.6}, {0.0, 0.0}};

/// A room whose furniture a seed places, with a tour round it.
slam_test::World random_room(std::uint64_t seed) {
  Rng rng(seed, "room");
  slam_test::World world;
  slam_test::add_box(world, -2.0, -1.5, 4.0, 2.5);
  for (const TPoint2D& corner : {TPoint2D(2.0, 1.5), TPoint2D(-1.6, 0.9), TPoint2D(1.6, -1.4), TPoint2D(-0.6, 1.6)}) {
    const double x = corner.x + rng.uniform(0.0, 0.2);
    const double y = corner.y + rng.uniform(0.0, 0.2);
    slam_test::add_box(world, x, y, x + rng.uniform(0.1, 0.6), y + rng.uniform(0.1, 0.5));
  }
  return world;
}

/// What a mirror sees: left is right. The scanner's fan must be symmetric.
std::vector<Inputs> mirrored(std::vector<Inputs> ticks) {
  for (Inputs& tick : ticks) {
    for (robot::Odometry& o : tick.odometry) {
      o.pose = {o.pose.x, -o.pose.y, -o.pose.phi};
      o.w = -o.w;
    }
    for (robot::LaserScan& scan : tick.scans) {
      std::reverse(scan.ranges.begin(), scan.ranges.end());
      scan.angle_min = -(scan.angle_min + scan.angle_step * static_cast<double>(scan.ranges.size() - 1));
    }
  }
  return ticks;
}

TEST(RobustMapper, WithoutNoiseTheErrorIsBelowAFifthOfACell) {
  const RobotModel model;
  const RobustConfig config;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
    RobustMapper mapper(model, config, 1);
    play(mapper, slam_test::record(random_room(seed), drive, model, 0.0, 0.0, seed));
    EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.2 * config.resolution);
  }
}

TEST(RobustMapper, WithNoiseTheTrajectoryIsFarBetterThanTheOdometry) {
  const RobotModel model;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
    RobustMapper mapper(model, {}, 1);
    play(mapper, slam_test::record(random_room(seed), drive, model, 1.5, 0.01, seed));
    EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.02);
    EXPECT_LT(slam_test::first_pose_rmse(mapper.live_trajectory(), drive.truth), 0.04);
  }
}

/// What differs is the cells that points are gathered in. Of twelve seeds, without noise of the ranges: at most 6.7 mm
/// and 2.2 mrad, 1.4 mm and 0.64 mrad RMS; noise of 1 cm falls into them otherwise: 20.6 mm and 6.8 mrad, 8.1 mm
/// and 2.5 mrad.
TEST(RobustMapper, AMirroredWorldGivesAMirroredResult) {
  const RobotModel model;
  struct Bounds {
    double range_noise, apart, turned, apart_rms, turned_rms;
  };
  for (const Bounds& bounds : {Bounds{0.0, 0.008, 0.004, 0.0023, 0.0011}, Bounds{0.01, 0.03, 0.012, 0.014, 0.0043}})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", noise " + std::to_string(bounds.range_noise));
      const auto ticks = slam_test::record(random_room(seed), slam_test::drive_through(kTour, 0.0), model, 1.0,
                                           bounds.range_noise, seed);
      RobustMapper mapper(model, {}, 1);
      RobustMapper other(model, {}, 1);
      play(mapper, ticks);
      play(other, mirrored(ticks));
      ASSERT_EQ(mapper.trajectory().size(), other.trajectory().size());
      double apart = 0.0, turned = 0.0;  // sums of squares
      for (std::size_t i = 0; i < mapper.trajectory().size(); ++i) {
        const TPose2D& a = mapper.trajectory()[i].pose;
        const TPose2D& b = other.trajectory()[i].pose;
        const double off = length(a.x - b.x, a.y + b.y);
        const double askew = wrap_angle(a.phi + b.phi);
        EXPECT_LT(off, bounds.apart);
        EXPECT_NEAR(askew, 0.0, bounds.turned);
        apart += off * off;
        turned += askew * askew;
      }
      const auto poses = static_cast<double>(mapper.trajectory().size());
      EXPECT_LT(std::sqrt(apart / poses), bounds.apart_rms);
      EXPECT_LT(std::sqrt(turned / poses), bounds.turned_rms);
    }
}

std::vector<TPoint2D> rounds(int count) {
  std::vector<TPoint2D> points;
  for (int k = 0; k < count; ++k) points.insert(points.end(), kTour.begin(), kTour.end() - 1);
  points.push_back(kTour.front());
  return points;
}

TEST(RobustMapper, KnownGroundAddsNoKeyFramesAndThePlaceStays) {
  const RobotModel model;
  RobustConfig config;
  config.exact_frames = 60;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::World room = random_room(seed);
    std::vector<double> frames;
    for (const int count : {4, 8}) {
      const slam_test::Drive drive = slam_test::drive_through(rounds(count), 0.0);
      RobustMapper mapper(model, config, 1);
      play(mapper, slam_test::record(room, drive, model, 1.0, 0.01, seed));
      EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.03);
      EXPECT_LT(slam_test::first_pose_rmse(mapper.live_trajectory(), drive.truth), 0.04);
      frames.push_back(figure(mapper, "key_frames"));
      EXPECT_GT(figure(mapper, "frames_reused"), 20.0);
    }
    EXPECT_LE(frames[1], frames[0] + 3.0);
    RobustMapper all(model, {}, 1);
    play(all, slam_test::record(room, slam_test::drive_through(rounds(4), 0.0), model, 1.0, 0.01, seed));
    EXPECT_GT(figure(all, "key_frames"), 1.3 * frames[0]);
  }
}

/// Only a correction of the past unsettles the map; then it is drawn anew bit by bit.
TEST(RobustMapper, AfterACorrectionTheMapSettles) {
  const RobotModel model;
  RobustConfig config;
  config.budget_ms = 1.0;
  RobustMapper mapper(model, config, 1);
  const slam_test::Drive drive = slam_test::drive_through(rounds(4), 0.0);
  int unsettled = 0;
  for (const Inputs& tick : slam_test::record(random_room(1), drive, model, 2.0, 0.02, 1)) {
    const bool settled = mapper.settled();
    const std::uint64_t revision = mapper.revision();
    mapper.update(tick);
    if (mapper.revision() == revision && settled) {
      EXPECT_TRUE(mapper.settled());
    }
    if (!mapper.settled()) ++unsettled;
  }
  EXPECT_GT(mapper.revision(), 0u);
  EXPECT_GT(unsettled, 0);
  EXPECT_TRUE(mapper.settled()) << "known ground for long";
  mapper.finish();
  EXPECT_TRUE(mapper.settled());
}

TEST(RobustMapper, NewGroundBehindKnownGroundIsMappedAndTied) {
  // Two rooms: the first is known for long when the robot goes on to the second and comes back.
  slam_test::World rooms = {{{4.0, -1.5}, {4.0, 0.0}},   {{4.0, 0.9}, {4.0, 2.5}},  // the wall with its door
                            {{-2.0, -1.5}, {9.0, -1.5}}, {{9.0, -1.5}, {9.0, 2.5}},
                            {{9.0, 2.5}, {-2.0, 2.5}},   {{-2.0, 2.5}, {-2.0, -1.5}}};
  slam_test::add_box(rooms, 2.2, 1.4, 2.8, 1.9);
  slam_test::add_box(rooms, -1.4, 1.2, -0.9, 1.9);
  slam_test::add_box(rooms, 6.2, 1.5, 6.8, 2.0);
  slam_test::add_box(rooms, 7.6, -1.2, 8.1, -0.6);
  std::vector<TPoint2D> tour = rounds(4);
  for (const TPoint2D& p : {TPoint2D(3.2, 0.45), TPoint2D(5.0, 0.45), TPoint2D(8.2, 0.6), TPoint2D(6.0, -0.8),
                            TPoint2D(5.0, 0.45), TPoint2D(3.2, 0.45), TPoint2D(0.0, 0.0)})
    tour.push_back(p);
  const RobotModel model;
  RobustConfig config;
  config.exact_frames = 60;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Drive drive = slam_test::drive_through(tour, 0.0);
    RobustMapper mapper(model, config, 1);
    play(mapper, slam_test::record(rooms, drive, model, 1.0, 0.01, seed));
    EXPECT_LT(slam_test::first_pose_rmse(mapper.trajectory(), drive.truth), 0.03);
    EXPECT_GT(figure(mapper, "frames_reused"), 20.0);
    EXPECT_GT(figure(mapper, "key_frames"), 75.0) << "the second room's are new";
  }
}

/// Scans that follow one another give a map to be believed; the same scans in any other order do not, and it says so.
/// (Places on top of each other: LoopCloser's tests.)
TEST(RobustMapper, AMapOfScansThatDoNotFollowOneAnotherIsDoubted) {
  const RobotModel model;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const auto drive = slam_test::drive_through(floor.way({{0, 0}, {1, 0}, {2, 0}}), 0.0);
    std::vector<Inputs> ticks = slam_test::record(floor.world(), drive, model, 1.0, 0.01, seed);
    RobustMapper right(model, {}, 1);
    play(right, ticks);
    EXPECT_LT(slam_test::first_pose_rmse(right.trajectory(), drive.truth), 0.05);
    EXPECT_EQ(figure(right, "map_doubted"), 0.0) << figure(right, "frames_doubled");

    Rng rng(seed, "order");
    for (std::size_t i = ticks.size(); i > 1; --i) {
      auto& scans = ticks[i - 1].scans;
      auto& others = ticks[rng.below(static_cast<std::uint32_t>(i))].scans;
      for (std::size_t k = 0; k < std::min(scans.size(), others.size()); ++k)
        std::swap(scans[k].ranges, others[k].ranges);
    }
    RobustMapper wrong(model, {}, 1);
    play(wrong, ticks);
    EXPECT_EQ(figure(wrong, "map_doubted"), 1.0) << figure(wrong, "scans_unfit");
  }
}

TEST(RobustMapper, APureRotationDoesNotMoveThePose) {
  const RobotModel model;
  slam_test::Drive drive;
  for (int k = 0; k <= 160; ++k) drive.truth.push_back({Stamp{k * 100000000ll}, {0.0, 0.0, wrap_angle(0.08 * k)}});
  for (const double wheel_error : {0.0, 1.0}) {
    SCOPED_TRACE(wheel_error);
    RobustMapper mapper(model, {}, 1);
    const auto ticks = slam_test::record(slam_test::furnished_room(), drive, model, wheel_error, 0.005, 3);
    for (const Inputs& tick : ticks) {
      mapper.update(tick);
      EXPECT_LT(length(mapper.pose().x, mapper.pose().y), 0.02);
    }
    EXPECT_NEAR(wrap_angle(mapper.pose().phi - drive.truth.back().pose.phi), 0.0, 0.01);
  }
}

/// Once round a floor and on over known ground, and what is recorded on the way.
struct RoundDrive {
  slam_test::Drive drive;
  std::vector<Inputs> ticks;
};

RoundDrive round_drive(std::uint64_t seed) {
  const std::vector<Cell> round{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  std::vector<Cell> rooms = round;
  rooms.insert(rooms.end(), round.begin(), round.begin() + 4);
  const slam_test::Floor floor(seed, 4, 3);
  RoundDrive out;
  out.drive = slam_test::drive_through(floor.way(rooms), 0.0);
  out.ticks = slam_test::record(floor.world(), out.drive, RobotModel(), 1.0, 0.01, seed);
  return out;
}

/// What is told of them: where the robot was then, as seen from where it was long before.
TEST(RobustMapper, ClosedLoopsSayWhatIsTrue) {
  const auto [drive, ticks] = round_drive(1);
  RobustMapper mapper(RobotModel(), {}, 1);
  play(mapper, ticks);
  const std::vector<FoundLoop> loops = mapper.found_loops();
  ASSERT_TRUE(std::any_of(loops.begin(), loops.end(), [](const FoundLoop& loop) { return loop.closed(); }));
  for (const FoundLoop& loop : loops) {
    if (!loop.closed()) continue;
    EXPECT_LT(loop.from, loop.to);
    const auto from = pose_at(drive.truth, loop.from);
    const auto to = pose_at(drive.truth, loop.to);
    ASSERT_TRUE(from && to);
    const TPose2D off = loop.T_from_to - (*to - *from);
    EXPECT_LT(length(off.x, off.y), 0.1);
    EXPECT_LT(std::abs(wrap_angle(off.phi)), 0.05);
  }
}

/// Twice round a floor, so that loops are searched, closed and solved. A unit of work is about a nanosecond.
TEST(RobustMapper, NoScanTakesMoreWorkThanTwentyMilliseconds) {
  const std::vector<Cell> large{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  const std::vector<Cell> small{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  RobotModel fine;
  fine.laser.beams = 10000;
  fine.laser.angle_step = 4.0 / 10000;
  fine.laser.angle_min = -2.0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed)
    for (const auto& [model, round] : {std::pair(RobotModel(), large), std::pair(fine, small)}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", beams " + std::to_string(model.laser.beams));
      std::vector<Cell> rooms = round;
      rooms.insert(rooms.end(), round.begin(), round.end());
      rooms.push_back(round.front());
      const slam_test::Floor floor(seed, 4, 3);
      RobustMapper mapper(model, {}, 1);
      play(mapper,
           slam_test::record(floor.world(), slam_test::drive_through(floor.way(rooms), 0.0), model, 1.0, 0.01, seed));
      EXPECT_LT(figure(mapper, "most_work_ms"), 4.0);  // real logs take four times what these small floors do
      EXPECT_GT(figure(mapper, "graph_solved"), 2.0);
    }
}

void expect_same_bits(const RobustMapper& a, const RobustMapper& b) {
  ASSERT_EQ(a.trajectory().size(), b.trajectory().size());
  for (std::size_t i = 0; i < a.trajectory().size(); ++i) {
    EXPECT_EQ(a.trajectory()[i].pose, b.trajectory()[i].pose);
    EXPECT_EQ(a.live_trajectory()[i].pose, b.live_trajectory()[i].pose);
  }
  ASSERT_EQ(a.map().frame(), b.map().frame());
  EXPECT_EQ(slam_test::p_occ_of(a.map()), slam_test::p_occ_of(b.map()));
}

TEST(RobustMapper, SameInputsSameBits) {
  const RobotModel model;
  const auto ticks =
      slam_test::record(slam_test::furnished_room(), slam_test::drive_through(kTour, 0.0), model, 1.0, 0.01, 4);
  RobustMapper a(model, {}, 7);
  RobustMapper b(model, {}, 8);  // it draws no random numbers
  play(a, ticks);
  play(b, ticks);
  expect_same_bits(a, b);
}

TEST(RobustMapper, SameInputsSameBitsOfADriveThatClosesLoops) {
  constexpr std::uint64_t kSeed = 1;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const std::vector<Inputs> ticks = round_drive(kSeed).ticks;
  RobustMapper a(RobotModel(), {}, 7);
  RobustMapper b(RobotModel(), {}, 8);
  play(a, ticks);
  play(b, ticks);
  const std::vector<FoundLoop> loops = a.found_loops();
  EXPECT_TRUE(std::any_of(loops.begin(), loops.end(), [](const FoundLoop& loop) { return loop.closed(); }));
  EXPECT_GT(a.revision(), 0u) << "the past was corrected";
  EXPECT_EQ(a.revision(), b.revision());
  EXPECT_EQ(loops.size(), b.found_loops().size());
  expect_same_bits(a, b);
  EXPECT_EQ(a.saved_map(), b.saved_map());
}

TEST(RobustMapper, TheWorldsPlaceAndHeadingDoNotMatter) {
  const RobotModel model;
  const slam_test::Drive drive = slam_test::drive_through(kTour, 0.0);
  const auto ticks = slam_test::record(slam_test::furnished_room(), drive, model, 1.0, 0.01, 5);
  auto moved = ticks;
  const TPose2D there{40.0, -25.0, 2.0};  // where the odometry begins
  for (Inputs& tick : moved)
    for (robot::Odometry& o : tick.odometry) o.pose = there + o.pose;
  RobustMapper a(model, {}, 1);
  RobustMapper b(model, {}, 1);
  play(a, ticks);
  play(b, moved);
  ASSERT_EQ(a.trajectory().size(), b.trajectory().size());
  for (std::size_t i = 0; i < a.trajectory().size(); ++i) {
    EXPECT_NEAR(a.trajectory()[i].pose.x, b.trajectory()[i].pose.x, 2e-3);
    EXPECT_NEAR(a.trajectory()[i].pose.y, b.trajectory()[i].pose.y, 2e-3);
  }
}

}  // namespace
}  // namespace rubble::slam
