#include "robot/logs/foreign/mrpt_bridge.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "base/error.h"
#include "robot/logs/foreign/module/to_mrpt.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose3D;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using testing::kMiss;
using testing::kUnknown;

LaserScan urg_scan(Rng& rng) {
  const LaserModel laser;
  LaserScan scan;
  scan.stamp.ns = static_cast<std::int64_t>(rng.below(2000000000)) * 100;
  scan.angle_min = laser.angle_min;
  scan.angle_step = laser.angle_step;
  scan.range_max = laser.range_max;
  for (int i = 0; i < laser.beams; ++i) {
    const std::uint32_t sort = rng.below(5);
    const double range = rng.uniform(0.02, 5.5);
    scan.ranges.push_back(sort == 0 ? kMiss : (sort == 1 ? kUnknown : static_cast<float>(range)));
  }
  return scan;
}

MrptScan held(const CObservation2DRangeScan& scan) {
  MrptScan held{
      scan.timestamp, scan.sensorPose, scan.aperture, scan.maxRange, scan.rightToLeft, scan.sensorLabel, {}, {}};
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    held.ranges.push_back(scan.getScanRange(i));
    held.valid.push_back(scan.getScanRangeValidity(i));
  }
  return held;
}

MrptOdometry held(const CObservationOdometry& odometry) {
  return {odometry.timestamp, odometry.odometry, odometry.velocityLocal.vx, odometry.velocityLocal.omega};
}

TEST(MrptBridge, ScanComesBackFromMrptWithTheSameBits) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "scan");
    const LaserScan scan = urg_scan(rng);
    TPose3D mount(0.1, -0.05, 0.3, 0.0, 0.0, 0.0);
    mount.yaw = rng.uniform(-3.0, 3.0);
    mount.pitch = rng.uniform(-0.3, 0.3);
    mount.roll = rng.uniform(-0.3, 0.3);
    CObservation2DRangeScan theirs;
    to_mrpt(scan, mount, theirs);
    const LaserScan back = from_mrpt(held(theirs), mount);
    EXPECT_EQ(back.stamp, scan.stamp);
    EXPECT_TRUE(testing::same(back.ranges, scan.ranges)) << "returns, misses and unknown beams stay apart";
    EXPECT_EQ(back.range_max, scan.range_max);
    for (const std::size_t i : {std::size_t{0}, std::size_t{340}, scan.ranges.size() - 1})
      EXPECT_NEAR(back.bearing(i), scan.bearing(i), 3e-7) << "float precision";
  }
}

TEST(MrptBridge, MrptSeesEachBeamWhereItIs) {
  Rng rng(1, "scan");
  const LaserScan scan = urg_scan(rng);
  const TPose3D mount(0.145, 0.0, 0.3, 0.2, 0.0, 0.0);
  CObservation2DRangeScan theirs;
  to_mrpt(scan, mount, theirs);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double bearing = theirs.sensorPose.yaw() + static_cast<double>(theirs.getScanAngle(i));
    EXPECT_NEAR(wrap_angle(bearing - mount.yaw - scan.bearing(i)), 0.0, 1e-6);
    EXPECT_EQ(theirs.getScanRangeValidity(i), std::isfinite(scan.ranges[i]));
  }
}

TEST(MrptBridge, ClockwiseScansAreTurnedRound) {
  CObservation2DRangeScan theirs;
  theirs.rightToLeft = false;
  theirs.aperture = 2.0f;
  theirs.maxRange = 10.0f;
  theirs.resizeScanAndAssign(3, 1.0f, true);
  theirs.setScanRange(0, 5.0f);  // the leftmost beam
  const LaserScan scan = from_mrpt(held(theirs), TPose3D());
  EXPECT_EQ(scan.ranges[2], 5.0f);
  EXPECT_EQ(scan.bearing(2), 1.0);
}

TEST(MrptBridge, OdometryComesBackFromMrptWithTheSameBits) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "odometry");
    Odometry odometry;
    odometry.stamp.ns = -static_cast<std::int64_t>(rng.below(1000)) * 100;
    odometry.pose.x = rng.uniform(-100.0, 100.0);
    odometry.pose.y = rng.uniform(-100.0, 100.0);
    odometry.pose.phi = rng.uniform(-3.14, 3.14);
    odometry.v = rng.uniform(-1.0, 1.0);
    odometry.w = rng.uniform(-1.0, 1.0);
    CObservationOdometry theirs;
    to_mrpt(odometry, theirs);
    EXPECT_TRUE(testing::same(from_mrpt(held(theirs)), odometry));
  }
}

TEST(MrptBridge, NoTimeStaysNoTime) {
  CObservationOdometry theirs;
  theirs.timestamp = INVALID_TIMESTAMP;
  EXPECT_EQ(from_mrpt(held(theirs)).stamp, Stamp::never());
  Odometry odometry;
  odometry.stamp = Stamp::never();
  to_mrpt(odometry, theirs);
  EXPECT_EQ(theirs.timestamp, INVALID_TIMESTAMP);
}

}  // namespace
}  // namespace rubble::robot
