#include "robot/logs/foreign/foreign_log.h"

#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

LaserScan scan_at(double seconds, double beam_period) {
  LaserScan scan;
  scan.stamp = Stamp::from_seconds(seconds);
  scan.beam_period = beam_period;
  scan.ranges.assign(100, 1.0f);
  return scan;
}

Odometry odometry_at(double seconds) {
  Odometry odometry;
  odometry.stamp = Stamp::from_seconds(seconds);
  odometry.pose.x = seconds;
  return odometry;
}

template <class T>
void expect_sorted_and_past(const std::vector<T>& list, Stamp now) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_LE(list[i].stamp, now);
    EXPECT_LE(list[i == 0 ? 0 : i - 1].stamp, list[i].stamp);
  }
}

TEST(AssembledTicks, EachScanComesOnceWithTheOdometryThatBracketsIt) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "ticks");
    const double beam_period = rng.below(2) == 0 ? 0.0 : 1e-3;
    std::vector<LaserScan> scans;
    std::vector<Odometry> odometry;
    for (std::uint32_t i = 0, n = rng.below(30); i < n; ++i)
      scans.push_back(scan_at(rng.uniform(0.0, 3.0), beam_period));
    for (std::uint32_t i = 0, n = rng.below(30); i < n; ++i) odometry.push_back(odometry_at(rng.uniform(0.0, 3.0)));
    Stamp newest_given = Stamp::never();
    for (const Odometry& o : odometry) newest_given = std::max(newest_given, o.stamp);

    const std::vector<Inputs> ticks = assemble_ticks(scans, odometry);
    std::size_t scans_seen = 0;
    Stamp last_now = Stamp::never();
    Stamp last_scan = Stamp::never();
    Stamp oldest = Stamp::never();
    Stamp newest = Stamp::never();
    for (const Inputs& tick : ticks) {
      EXPECT_GT(tick.now, last_now);
      last_now = tick.now;
      expect_sorted_and_past(tick.scans, tick.now);
      expect_sorted_and_past(tick.odometry, tick.now);
      for (const Odometry& o : tick.odometry) {
        EXPECT_GT(o.stamp, newest);
        if (oldest == Stamp::never()) oldest = o.stamp;
        newest = o.stamp;
      }
      for (const LaserScan& scan : tick.scans) {
        EXPECT_GE(scan.stamp, last_scan);
        last_scan = scan.stamp;
        EXPECT_GE(tick.now, scan.beam_stamp(scan.ranges.size() - 1));
        EXPECT_LE(oldest, scan.middle()) << "odometry before the scan";
        EXPECT_GE(newest, std::min(scan.middle(), newest_given)) << "and after it, as far as the log goes";
        ++scans_seen;
      }
    }
    EXPECT_EQ(scans_seen, scans.size());
  }
}

TEST(AssembledTicks, RobotWithoutOdometryStandsStill) {
  const std::vector<Inputs> ticks = assemble_ticks({scan_at(1.0, 0.0), scan_at(1.5, 0.0), scan_at(2.0, 0.0)}, {});
  ASSERT_EQ(ticks.size(), 3u);
  for (const Inputs& tick : ticks) {
    ASSERT_EQ(tick.odometry.size(), 1u);
    EXPECT_EQ(tick.odometry[0].stamp, tick.scans.at(0).stamp);
    EXPECT_EQ(tick.odometry[0].pose.x, 0.0);
  }
}

TEST(AssembledTicks, LastOdometryOfOneTimeStays) {
  std::vector<Odometry> odometry{odometry_at(1.0), odometry_at(1.0), odometry_at(2.0)};
  odometry[1].pose.x = 7.0;
  const std::vector<Inputs> ticks = assemble_ticks({scan_at(1.0, 0.0)}, odometry);
  ASSERT_EQ(ticks.size(), 2u);
  ASSERT_EQ(ticks[0].odometry.size(), 1u);
  EXPECT_EQ(ticks[0].odometry[0].pose.x, 7.0);
}

TEST(AssembledTicks, NothingGivesNothing) { EXPECT_TRUE(assemble_ticks({}, {}).empty()); }

}  // namespace
}  // namespace rubble::robot
