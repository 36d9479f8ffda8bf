#include "robot/logs/foreign/carmen.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/carmen_log_tools.h>

#include <sstream>

#include "base/error.h"
#include "tests/support/robot_carmen.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;
using testing::arc;
using testing::CarmenWriter;
using testing::message_of;
using testing::scans_of;

const std::vector<double> kRanges{1.0, 2.5, 81.83, 0.0, 3.0};
const std::string kHalfCircle = "PARAM laser_front_laser_fov 180 nohost 0\n";

Trajectory odometry_of(const ForeignLog& log) {
  Trajectory path;
  for (const Inputs& tick : log.ticks)
    for (const Odometry& o : tick.odometry) path.push_back({o.stamp, o.pose});
  return path;
}

void expect_near(const TPose2D& a, const TPose2D& b, double tolerance = 1e-6) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(wrap_angle(a.phi - b.phi), 0.0, tolerance);
}

TEST(Carmen, PlainLogGivesItsOdometryFromZeroAndNoReference) {
  const TPose2D start(5.0, -3.0, 1.0);
  const auto path = arc(40);
  CarmenWriter log;
  log.text = "# a comment\nPARAM robot_frontlaser_offset 0.2 nohost 0\nPARAM other on\nSYNC x\n\n";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const TPose2D robot = start + path[i];
    log.odom(robot, 0.1 * static_cast<double>(i), 0.2, 0.1);
    if (i % 4 == 3) log.flaser(kRanges, robot + TPose2D(0.2, 0, 0), robot, 0.1 * static_cast<double>(i));
  }
  const ForeignLog read = read_carmen(log.text, "a.log");
  EXPECT_TRUE(read.reference.empty());
  EXPECT_EQ(scans_of(read).size(), 10u);
  EXPECT_FALSE(read.model.has_levelling_unit);
  EXPECT_EQ(read.model.T_base_laser.x, 0.2);
  EXPECT_NEAR(read.model.laser.scan_period, 0.4, 1e-9);
  const Trajectory odometry = odometry_of(read);
  ASSERT_EQ(odometry.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) expect_near(odometry[i].pose, path[i]);
  EXPECT_EQ(read.ticks.front().odometry.front().v, 0.2);
}

TEST(Carmen, ReanchoredLogGivesBackTheRawOdometryAndTheReference) {
  const auto raw = arc(60);
  // The truth turns a little more than the wheels say.
  std::vector<TPose2D> truth{TPose2D(1, 2, 0.5)};
  for (std::size_t i = 1; i < raw.size(); ++i)
    truth.push_back(truth.back() + (raw[i] - raw[i - 1]) + TPose2D(0, 0, 0.003));
  CarmenWriter log;
  TPose2D anchor = truth[0];
  std::size_t anchored_at = 0;
  std::size_t scans = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const double time = 100.0 + 0.1 * static_cast<double>(i);
    log.odom(anchor + (raw[i] - raw[anchored_at]), time);
    if (i % 5 != 4) continue;
    log.flaser(kRanges, truth[i], truth[i], time);
    log.odom(truth[i], scans % 7 == 0 ? 1e-42 : 0.0);  // the restart mark, its time means nothing
    log.text += "NEFF 15\n";
    anchor = truth[i];
    anchored_at = i;
    ++scans;
  }
  const ForeignLog read = read_carmen(log.text, "a.log");
  EXPECT_EQ(scans_of(read).size(), scans);
  ASSERT_EQ(read.reference.size(), scans);
  for (std::size_t k = 0; k < scans; ++k) expect_near(read.reference[k].pose, truth[5 * k + 4]);
  const Trajectory odometry = odometry_of(read);
  ASSERT_EQ(odometry.size(), raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) expect_near(odometry[i].pose, raw[i]);
}

TEST(Carmen, CorrectedLaserPosesBecomeTheReference) {
  const auto path = arc(30);
  CarmenWriter log;
  log.text = kHalfCircle + "PARAM robot_frontlaser_offset 0.1 nohost 0\n";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const TPose2D truth = path[i] + TPose2D(0, 0, 0.01 * static_cast<double>(i));
    log.flaser(kRanges, truth + TPose2D(0.1, 0, 0), path[i], 0.1 * static_cast<double>(i));
  }
  const ForeignLog read = read_carmen(log.text, "a.log");
  ASSERT_EQ(read.reference.size(), path.size());
  const Trajectory odometry = odometry_of(read);
  ASSERT_EQ(odometry.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    expect_near(read.reference[i].pose, path[i] + TPose2D(0, 0, 0.01 * static_cast<double>(i)));
    expect_near(odometry[i].pose, path[i]);
  }
  EXPECT_EQ(read.model.T_base_laser.x, 0.1);
  EXPECT_EQ(read.model.T_base_laser.yaw, 0.0) << "poses that were corrected apart tell no mount";
  EXPECT_TRUE(read.notes.empty());
}

/// A log whose scans say by their poses that the laser sits at `T_base_laser`.
std::string mounted_at(const TPose2D& T_base_laser, const std::string& head) {
  CarmenWriter log;
  log.text = kHalfCircle + head;
  const auto path = arc(30);
  for (std::size_t i = 0; i < path.size(); ++i)
    log.flaser(kRanges, path[i] + T_base_laser, path[i], 0.1 * static_cast<double>(i));
  return log.text;
}

TEST(Carmen, TheScansTellWhereTheLaserLooksAlsoWherePARAMTellsHowFarAheadItIs) {
  for (const TPose2D& seen : {TPose2D(0.1, 0.05, 0.5 * kPi), TPose2D(0.1, 0, kPi), TPose2D(0.1, 0, 0)}) {
    const ForeignLog read = read_carmen(mounted_at(seen, "PARAM robot_frontlaser_offset 0.1 nohost 0\n"), "a.log");
    const mrpt::math::TPose3D& mount = read.model.T_base_laser;
    expect_near({mount.x, mount.y, mount.yaw}, seen);
    EXPECT_TRUE(read.notes.empty());
    EXPECT_TRUE(read.reference.empty());
  }
}

TEST(Carmen, ALaserThatTheScansPutElsewhereThanPARAMIsTold) {
  const ForeignLog read =
      read_carmen(mounted_at({0.1, 0, kPi}, "PARAM robot_frontlaser_offset 0.3 nohost 0\n"), "a.log");
  expect_near({read.model.T_base_laser.x, read.model.T_base_laser.y, read.model.T_base_laser.yaw}, {0.3, 0, kPi});
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_EQ(
      read.notes[0].find("a.log: robot_frontlaser_offset puts the laser 0.30 m ahead, the poses of its scans 0.10"), 0u)
      << read.notes[0];
}

TEST(Carmen, OnePoseForRobotAndLaserContradictsNothing) {
  const ForeignLog read = read_carmen(mounted_at({0, 0, 0}, "PARAM robot_frontlaser_offset -0.04 nohost 0\n"), "a.log");
  EXPECT_EQ(read.model.T_base_laser.x, -0.04);
  EXPECT_EQ(read.model.T_base_laser.y, 0.0);
  EXPECT_EQ(read.model.T_base_laser.yaw, 0.0);
  EXPECT_TRUE(read.notes.empty());
}

TEST(Carmen, ScanPosesApartFromTheOdometryLinesAreTheReference) {
  const auto path = arc(60);
  CarmenWriter log;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const TPose2D truth =
        TPose2D(0, 0, 0.05 * static_cast<double>(i)) + path[i] + TPose2D(0.02 * static_cast<double>(i), 0, 0);
    log.odom(path[i], 0.1 * static_cast<double>(i));
    log.flaser(kRanges, truth, truth, 0.1 * static_cast<double>(i) + 0.01);
  }
  const ForeignLog read = read_carmen(log.text, "a.log");
  EXPECT_EQ(read.reference.size(), path.size());
  const Trajectory odometry = odometry_of(read);
  ASSERT_EQ(odometry.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) expect_near(odometry[i].pose, path[i]);
}

TEST(Carmen, RangesMeanReturnMissOrNothingKnown) {
  CarmenWriter log;
  log.flaser({1.0, 29.99, 30.0, 81.83, 0.0}, {}, {}, 1.0);
  const auto scans = scans_of(read_carmen(log.text, "a.log"));
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_TRUE(testing::same(scans[0].ranges, {1.0f, 29.99f, testing::kMiss, testing::kMiss, testing::kUnknown}));
}

/// Scans of a room whose ranges differ from beam to beam and scan to scan; `written` where nothing comes back.
std::string room_with_gaps(double written, double farthest) {
  CarmenWriter log;
  const auto path = arc(40);
  for (std::size_t i = 0; i < path.size(); ++i) {
    std::vector<double> ranges;
    for (std::size_t beam = 0; beam < 91; ++beam)
      ranges.push_back(
          beam % 9 == 4 ? written : 0.5 + (farthest - 0.5) * static_cast<double>((37 * beam + 61 * i) % 200) / 200.0);
    log.flaser(ranges, path[i], path[i], 0.1 * static_cast<double>(i));
  }
  return log.text;
}

TEST(Carmen, ThePileOfOneLargeNumberIsNoReturn) {
  for (const double written : {4.0, 8.19, 20.0}) {
    for (const LaserScan& scan : scans_of(read_carmen(room_with_gaps(written, 0.97 * written), "a.log"))) {
      EXPECT_LT(scan.range_max, written);
      for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam)
        EXPECT_EQ(std::isinf(scan.ranges[beam]), beam % 9 == 4) << written << ' ' << beam << ' ' << scan.ranges[beam];
    }
  }
}

TEST(Carmen, FarthestWallsAreNoPile) {
  // The largest readings are as common as the rest.
  for (const LaserScan& scan : scans_of(read_carmen(room_with_gaps(1.0, 8.0), "a.log")))
    for (const float range : scan.ranges) EXPECT_TRUE(std::isfinite(range));
  // One beam that reads the same in every scan: a robot at rest before the farthest wall.
  CarmenWriter log;
  for (int i = 0; i < 60; ++i) log.flaser({1.0, 2.0, 7.0, 1.5, 3.0}, {}, {}, 0.1 * i);
  for (const LaserScan& scan : scans_of(read_carmen(log.text, "a.log"))) EXPECT_EQ(scan.ranges[2], 7.0f);
}

TEST(Carmen, BeamCountTellsTheStep) {
  for (const auto& [beams, step_deg] : {std::pair{180, 1.0}, {181, 1.0}, {360, 0.5}, {361, 0.5}}) {
    CarmenWriter log;
    log.flaser(std::vector<double>(static_cast<std::size_t>(beams), 1.0), {}, {}, 1.0);
    const ForeignLog read = read_carmen(log.text, "a.log");
    EXPECT_NEAR(read.model.laser.angle_step, deg_to_rad(step_deg), 1e-12) << beams;
    EXPECT_NEAR(read.model.laser.angle_min, deg_to_rad(-90.0), 1e-12);
    EXPECT_EQ(read.model.laser.beams, beams);
  }
}

ForeignLog fan_of(std::size_t beams, const std::string& head) {
  CarmenWriter log;
  log.text = head;
  log.flaser(std::vector<double>(beams, 1.0), {}, {}, 1.0);
  return read_carmen(log.text, "a.log");
}

TEST(Carmen, PARAMTellsTheFieldOfViewInDegreesOrRadiansWhereItGoesWithTheBeams) {
  const struct {
    std::size_t beams;
    std::string fov, resolution;
    double min_deg, step_deg;
  } cases[] = {
      {401, "1.74533", "0.25", -50.0, 0.25}, {401, "100", "0.25", -50.0, 0.25},  {401, "", "0.25", -50.0, 0.25},
      {401, "100", "0.00436332", -50, 0.25}, {541, "270", "", -135.0, 0.5},      {1080, "270", "0.25", -135.0, 0.25},
      {361, "3.14159", "0.5", -90.0, 0.5},   {360, "", "0.5", -90.0, 0.5},       {181, "180", "none", -90.0, 1.0},
      {682, "240", "0.352", -119.9, 0.352},  {721, "6.28319", "0.5", -180, 0.5},
  };
  for (const auto& c : cases) {
    std::string head;
    if (!c.fov.empty()) head += "PARAM laser_front_laser_fov " + c.fov + " nohost 0\n";
    if (!c.resolution.empty()) head += "PARAM laser_front_laser_resolution " + c.resolution + " nohost 0\n";
    SCOPED_TRACE(std::to_string(c.beams) + "\n" + head);
    const ForeignLog read = fan_of(c.beams, head);
    EXPECT_NEAR(rad_to_deg(read.model.laser.angle_step), c.step_deg, 1e-5);
    EXPECT_NEAR(rad_to_deg(read.model.laser.angle_min), c.min_deg, 0.2);
    EXPECT_TRUE(read.notes.empty()) << read.notes[0];
  }
  // The half circle to the bit, however it is rounded in the head.
  const double step = fan_of(361, "").model.laser.angle_step;
  EXPECT_EQ(fan_of(361, "PARAM laser_front_laser_fov 3.14159\nPARAM laser_front_laser_resolution 0.5\n")
                .model.laser.angle_step,
            step);
}

TEST(Carmen, AFieldOfViewThatIsOnlyAssumedIsTold) {
  const struct {
    std::size_t beams;
    std::string head, note;
  } cases[] = {
      {101, "", "a.log: nothing tells the field of view of FLASER lines of 101 beams: 180 deg are assumed"},
      {541, "", "a.log: nothing tells the field of view of FLASER lines of 541 beams: 180 deg are assumed"},
      {181, "PARAM laser_front_laser_fov 270\nPARAM laser_front_laser_resolution 0.5\n",
       "a.log: laser_front_laser_fov or"},
      {180, "PARAM laser_front_laser_resolution 0.5\n", "a.log: laser_front_laser_fov or"},
      {1000, "PARAM laser_front_laser_resolution 1\n", "a.log: laser_front_laser_fov or"},
      {181, "PARAM laser_front_laser_fov none\n", ""},
      {181, "PARAM laser_front_laser_fov 0\n", ""},
      {181, "PARAM laser_front_laser_fov nan\n", ""},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(std::to_string(c.beams) + "\n" + c.head);
    const ForeignLog read = fan_of(c.beams, c.head);
    EXPECT_EQ(read.model.laser.angle_min, -0.5 * kPi);
    ASSERT_EQ(read.notes.size(), c.note.empty() ? 0u : 1u);
    for (const std::string& note : read.notes) EXPECT_EQ(note.find(c.note), 0u) << note;
  }
  for (const std::size_t beams : {90u, 91u, 180u, 181u, 360u, 361u, 720u, 721u})
    EXPECT_TRUE(fan_of(beams, "").notes.empty()) << beams;
}

TEST(Carmen, RobotLaserLinesBringTheirOwnGeometry) {
  const std::string text =
      "ROBOTLASER1 0 -2.0943951 4.1887902 0.0061359 5.6 0.01 0 3 1.5 5.6 0.7 2 100 200 "
      "1.1 2.0 0.5 1.0 2.0 0.5 0.3 0.1 0.2 0.2 1e6 12.5 host 0.5\n";
  const ForeignLog read = read_carmen(text, "a.log");
  const auto scans = scans_of(read);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_TRUE(testing::same(scans[0].ranges, {1.5f, testing::kMiss, 0.7f}));
  EXPECT_EQ(scans[0].angle_min, -2.0943951);
  EXPECT_EQ(scans[0].angle_step, 0.0061359);
  EXPECT_EQ(scans[0].range_max, 5.6);
  EXPECT_TRUE(read.notes.empty());
  EXPECT_EQ(scans[0].stamp.ns, 12500000000);
  EXPECT_EQ(read.ticks[0].odometry[0].v, 0.3);
  EXPECT_NEAR(read.model.T_base_laser.x, 0.1 * std::cos(0.5), 1e-9);
}

TEST(Carmen, RangesAgreeWithMrptsReader) {
  CarmenWriter log;
  std::vector<double> ranges;
  Rng rng(4, "ranges");
  for (int i = 0; i < 361; ++i) ranges.push_back(std::floor(rng.uniform(0.5, 20.0) * 1000.0) * 0.001);
  log.flaser(ranges, {1, 2, 0.3}, {1, 2, 0.3}, 10.0);
  std::istringstream stream(log.text);
  std::vector<mrpt::obs::CObservation::Ptr> theirs;
  ASSERT_TRUE(mrpt::obs::carmen_log_parse_line(stream, theirs, mrpt::Clock::time_point{}));
  const LaserScan ours = scans_of(read_carmen(log.text, "a.log")).at(0);
  bool compared = false;
  for (const auto& observation : theirs) {
    const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(observation);
    if (!scan) continue;
    compared = true;
    ASSERT_EQ(scan->getScanSize(), ours.ranges.size());
    // Not the bearings: MRPT spreads n beams over n steps, half a step too wide.
    for (std::size_t i = 0; i < ours.ranges.size(); ++i) EXPECT_FLOAT_EQ(scan->getScanRange(i), ours.ranges[i]);
  }
  EXPECT_TRUE(compared);
}

TEST(Carmen, StampsKeepTheirMicroseconds) {
  CarmenWriter log;
  log.flaser(kRanges, {}, {}, 1071078718.462310);
  EXPECT_EQ(scans_of(read_carmen(log.text, "a.log")).at(0).stamp.ns, 1071078718462310000);
}

TEST(Carmen, JitteringClockLeavesTheOrderOfTheLinesAndALargeJumpIsRefused) {
  CarmenWriter log;
  const auto path = arc(4);
  for (const auto& [i, time] : {std::pair{0, 1.0}, {1, 1.9}, {2, 1.2}, {3, 2.0}}) {
    log.odom(path[static_cast<std::size_t>(i)], time);
    log.flaser(kRanges, path[static_cast<std::size_t>(i)], path[static_cast<std::size_t>(i)], time);
  }
  const ForeignLog read = read_carmen(log.text, "a.log");
  const Trajectory odometry = odometry_of(read);
  ASSERT_EQ(odometry.size(), 4u);
  const std::vector<LaserScan> scans = scans_of(read);
  ASSERT_EQ(scans.size(), 4u);
  const double times[] = {1.0, 1.2, 1.9, 2.0};
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    EXPECT_EQ(odometry[i].stamp, Stamp::from_seconds(times[i]));
    EXPECT_EQ(scans[i].stamp, odometry[i].stamp);
    expect_near(odometry[i].pose, path[i]);
  }

  log.flaser(kRanges, {}, {}, -5.0);
  const std::string message = message_of<InputError>([&] { read_carmen(log.text, "a.log"); });
  EXPECT_EQ(message.find("a.log:9:1: the time jumps back by 7.000 s"), 0u) << message;
}

/// Trajectories are named by the log's own stamps where these tell the scans apart, and lose no pose where they do not.
TEST(Carmen, TrajectoriesGetTheLogsOwnStampsWhereTheseTellScansApart) {
  const testing::TempFolder folder;
  const auto trajectory_of = [&](const std::vector<double>& times) {
    CarmenWriter log;
    const auto path = arc(static_cast<int>(times.size()));
    for (std::size_t i = 0; i < times.size(); ++i) log.flaser(kRanges, path[i], path[i], times[i]);
    testing::write_bytes(folder.file("a.log"), log.text);
    ReplayRobot robot(folder.file("a.log"));
    Trajectory delivered;
    while (const auto inputs = robot.read())
      for (const LaserScan& scan : inputs->scans) delivered.push_back({scan.stamp, {}});
    EXPECT_EQ(delivered.size(), times.size());
    return robot.in_own_stamps(delivered);
  };
  const Trajectory jittering = trajectory_of({1.0, 1.9, 1.2, 2.0});
  const double own[] = {1.0, 1.2, 1.9, 2.0};
  ASSERT_EQ(jittering.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(jittering[i].stamp, Stamp::from_seconds(own[i]));
  EXPECT_EQ(trajectory_of({5.0, 5.0, 5.0, 5.0, 5.0}).size(), 5u);
}

TEST(Carmen, LinesOfEqualTimeAllStay) {
  CarmenWriter log;
  const auto path = arc(5);
  for (const auto& pose : path) {
    log.odom(pose, 1.0);
    log.flaser(kRanges, pose, pose, 1.0);
  }
  const ForeignLog read = read_carmen(log.text, "a.log");
  const Trajectory odometry = odometry_of(read);
  const std::vector<LaserScan> scans = scans_of(read);
  ASSERT_EQ(odometry.size(), 5u);
  ASSERT_EQ(scans.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    expect_near(odometry[i].pose, path[i]);
    EXPECT_EQ(scans[i].stamp, odometry[i].stamp);
    EXPECT_EQ(odometry[i].stamp.ns, 1000000000 + 1000 * static_cast<std::int64_t>(i));
  }
}

TEST(Carmen, LoggersClockServesWhereTheSendersStandsStill) {
  std::string text;
  for (int i = 0; i < 5; ++i) text += "FLASER 2 1 1 0 0 0 0 0 0 0 host " + std::to_string(i) + ".5\n";
  const auto scans = scans_of(read_carmen(text, "a.log"));
  ASSERT_EQ(scans.size(), 5u);
  EXPECT_EQ(scans[3].stamp.ns, 3500000000);
}

TEST(Carmen, WrongLinesAreNamedByLineAndColumn) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"ODOM 1 2 x 0 0 0 1 h 1\n", "a.log:2:10: 'x' is not a finite number"},
      {"ODOM 1 2 nan 0 0 0 1 h 1\n", "a.log:2:10: 'nan' is not a finite number"},
      {"ODOM 1 2 inf 0 0 0 1 h 1\n", "a.log:2:10: 'inf' is not a finite number"},
      {"ODOM 1 2 1e999 0 0 0 1 h 1\n", "a.log:2:10: '1e999' is not a finite number"},
      {"ODOM 1 2\n", "a.log:2:9: the line ends where 'odometry pose'"},
      {"FLASER 3 1 2 3 0 0 0 0 0 0 1 h\n", "a.log:2:31: the line ends where 'logger_timestamp'"},
      {"FLASER 3 1 -2 3 0 0 0 0 0 0 1 h 1\n", "a.log:2:12: a range is negative"},
      {"FLASER three\n", "a.log:2:8: 'three'"},
      {"FLASER 1e9 1\n", "a.log:2:8: 'num_readings' must be a whole number"},
      {"FLASER 2.5 1\n", "a.log:2:8: 'num_readings' must be a whole number"},
      {"flaser 1 2\n", "a.log:2:1: 'flaser' is no CARMEN message"},
      {"17 4\n", "a.log:2:1: '17' is no CARMEN message"},
      {"ODOM 1 2 3 0 0 0 1e300 h 1\n", "a.log:2:18: 'ipc_timestamp' is not a time in seconds"},
      {"PARAM robot_frontlaser_offset front\n", "a.log:2:31: 'front' is not a finite number"},
  };
  for (const auto& [line, start] : cases) {
    const std::string text = "# log\n" + line + "FLASER 2 1 1 0 0 0 0 0 0 1 h 1\n";
    const std::string message = message_of<InputError>([&] { read_carmen(text, "a.log"); });
    EXPECT_EQ(message.find(start), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(Carmen, AZeroByteDoesNotEndTheMessage) {
  const std::string text = std::string("FLASER \0 180", 12) + "\n";
  const std::string message = message_of<InputError>([&] { read_carmen(text, "a.log"); });
  EXPECT_EQ(message, std::string(message.c_str()));
  EXPECT_NE(message.find("'num_readings' must be one"), std::string::npos) << message;
}

TEST(Carmen, TheTimeFromTheFirstToTheLastHas64Bits) {
  const auto log = [](const std::string& first, const std::string& last) {
    return "FLASER 2 1 1 0 0 0 0 0 0 " + first + " h " + first + "\nFLASER 2 1 1 0 0 0 0 0 0 " + last + " h " + last +
           "\n";
  };
  EXPECT_EQ(read_carmen(log("-4.5e9", "4.5e9"), "a.log").ticks.size(), 2u);
  const std::string message = message_of<InputError>([&] { read_carmen(log("-9e9", "9e9"), "a.log"); });
  EXPECT_NE(message.find("is not a time in seconds"), std::string::npos) << "once: it jumps back; " << message;
}

TEST(Carmen, AByteOrderMarkBeforeTheFirstLineIsPassedOver) {
  const std::string text =
      "\xef\xbb\xbf"
      "FLASER 2 1 1 0 0 0 0 0 0 1 h 1\n";
  EXPECT_TRUE(is_carmen(text));
  EXPECT_EQ(scans_of(read_carmen(text, "a.log")).size(), 1u);
  EXPECT_FALSE(is_carmen("\xef\xbb" + text));
  const std::string message = message_of<InputError>([&] {
    read_carmen(
        "\xef\xbb\xbf"
        "ODOM 1 x\n",
        "a.log");
  });
  EXPECT_EQ(message.find("a.log:1:8: 'x'"), 0u) << message;
}

TEST(Carmen, LogWithoutScansSaysSo) {
  const std::string message = message_of<InputError>([] { read_carmen("ODOM 1 2 3 0 0 0 1 h 1\n", "a.log"); });
  EXPECT_NE(message.find("no FLASER"), std::string::npos) << message;
}

TEST(Carmen, RandomGarbageIsRefusedInOneLine) {
  const std::uint64_t seed = 5;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Rng rng(seed, "garbage");
  CarmenWriter log;
  for (const auto& pose : arc(5)) {
    log.odom(pose, 1.0);
    log.flaser(kRanges, pose, pose, 1.0);
  }
  for (int trial = 0; trial < 5000; ++trial) {
    std::string text = log.text;
    for (std::uint32_t i = 0; i <= rng.below(3); ++i) {
      const std::uint32_t place = rng.below(static_cast<std::uint32_t>(text.size()));
      text[place] = static_cast<char>(rng.below(128));
    }
    try {
      read_carmen(text, "a.log");
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find("a.log:"), 0u) << e.what();
    }
  }
}

}  // namespace
}  // namespace rubble::robot
