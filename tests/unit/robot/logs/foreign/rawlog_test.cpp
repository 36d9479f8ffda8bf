#include <malloc.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <sys/resource.h>

#include "base/error.h"
#include "base/sanitized.h"
#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/mrpt_logs.h"
#include "robot/logs/foreign/mrpt_stamp.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;
using testing::message_of;
using testing::TempFolder;

constexpr double kRoom = 2.5;  // half width of the room [m]

TPose2D pose_at_step(int step) {
  // Straight for a while, then a wide bend.
  const double bend = 0.004 * std::max(0, step - 60);
  TPose2D pose(-1.5, -1.0, bend);
  for (int i = 0; i < step; ++i) {
    const double heading = 0.004 * std::max(0, i - 60);
    pose.x += 0.02 * std::cos(heading);
    pose.y += 0.02 * std::sin(heading);
  }
  return pose;
}

/// A robot drives through a square room; its odometry arrives between the scans and makes each way `slip` times as
/// long.
std::vector<Inputs> drive_through_room(int steps, const RobotModel& model, double slip = 1.0) {
  std::vector<Inputs> ticks;
  for (int step = 0; step < steps; ++step) {
    const double time = 0.1 * step;
    Inputs inputs;
    inputs.now = Stamp::from_seconds(time + 0.08);
    Odometry odometry;
    odometry.stamp = Stamp::from_seconds(time);
    odometry.pose = pose_at_step(step) - pose_at_step(0);
    odometry.pose.x *= slip;
    odometry.pose.y *= slip;
    odometry.v = 0.2;
    odometry.w = step <= 60 ? 0.0 : 0.04;
    inputs.odometry.push_back(odometry);
    const TPose2D laser = pose_at_step(step) + TPose2D(model.T_base_laser.x, 0, 0);
    inputs.scans.push_back(
        testing::room_scan(Stamp::from_seconds(time + 0.001), laser.x, laser.y, laser.phi, kRoom, model.laser));
    ticks.push_back(inputs);
  }
  return ticks;
}

template <class T, class Member>
std::vector<T> collect(const std::vector<Inputs>& ticks, Member member) {
  std::vector<T> list;
  for (const Inputs& tick : ticks) list.insert(list.end(), (tick.*member).begin(), (tick.*member).end());
  return list;
}

std::string output_of(const std::string& command, const TempFolder& folder) {
  const std::string file = folder.file("output.txt");
  const int status = std::system((command + " > '" + file + "' 2>&1 < /dev/null").c_str());
  EXPECT_EQ(status, 0) << command << "\n" << testing::read_bytes(file);
  return testing::read_bytes(file);
}

bool installed(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
}

TEST(Rawlog, ExportGivesBackScansAndOdometryBitExact) {
  const TempFolder folder;
  const std::vector<Inputs> ticks = drive_through_room(80, {});
  testing::record(ticks, folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  RobotModel model;
  model.laser.beams = 0;
  const std::vector<Inputs> back = read_rawlog(folder.file("a.rawlog"), model);
  EXPECT_TRUE(testing::same_list(collect<LaserScan>(back, &Inputs::scans), collect<LaserScan>(ticks, &Inputs::scans)));
  EXPECT_TRUE(
      testing::same_list(collect<Odometry>(back, &Inputs::odometry), collect<Odometry>(ticks, &Inputs::odometry)));
  EXPECT_EQ(model.laser.beams, 682);
  EXPECT_EQ(model.name, "p3at");
  EXPECT_TRUE(model.has_levelling_unit);
}

TEST(Rawlog, SameLogGivesTheSameFile) {
  const TempFolder folder;
  testing::record(drive_through_room(5, {}), folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  export_rawlog(folder.file("a.log"), folder.file("b.rawlog"));
  EXPECT_EQ(testing::read_bytes(folder.file("a.rawlog")), testing::read_bytes(folder.file("b.rawlog")));
}

TEST(Rawlog, ALateScanIsSortedInAndALongLogTakesNoMemoryOfItsLength) {
  const auto held = [] {
    const struct mallinfo2 now = mallinfo2();  // under a sanitizer 0
    return now.uordblks + now.hblkhd;
  };
  const TempFolder folder;
  std::vector<Inputs> ticks;
  for (int i = 1; i <= 6000; ++i) {
    Inputs inputs;
    inputs.now = Stamp::from_seconds(0.2 * i);
    LaserScan scan;
    scan.angle_min = -2.0;
    scan.angle_step = 0.006;
    scan.range_max = 4.0;
    scan.ranges.assign(682, 1.0f + 0.001f * static_cast<float>(i % 100));
    scan.stamp = inputs.now - (i % 100 == 0 ? 50.0 : 0.1);
    inputs.scans.push_back(scan);
    ticks.push_back(inputs);
  }
  testing::record(ticks, folder.file("a.log"));
  std::size_t most = 0, bytes = 0;
  const std::size_t before = held();
  ReplayRobot replay(folder.file("a.log"));
  std::vector<Stamp> stamps;
  mrpt_logs().rawlog([&] { return replay.read(); }, {}, "",
                     [&](std::string_view piece) {
                       bytes += piece.size();
                       most = std::max(most, held());
                     });
  EXPECT_GT(bytes, 18u << 20);
  EXPECT_LT(most, before + (6u << 20));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  ReplayRobot again(folder.file("a.rawlog"));
  std::size_t scans = 0;
  Stamp last = Stamp::never();
  while (const auto inputs = again.read())
    for (const LaserScan& scan : inputs->scans) {
      ASSERT_LT(last, scan.stamp);
      last = scan.stamp;
      ++scans;
    }
  EXPECT_EQ(scans, ticks.size());
}

TEST(Rawlog, RawlogEditListsWhatWasExported) {
  if (!installed("rawlog-edit")) GTEST_SKIP() << "needs rawlog-edit of mrpt-apps";
  const TempFolder folder;
  testing::record(drive_through_room(30, {}), folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  const std::string info = output_of("rawlog-edit --info -i '" + folder.file("a.rawlog") + "'", folder);
  EXPECT_NE(info.find("Observations format               : Yes"), std::string::npos) << info;
  EXPECT_NE(info.find("LASER /     30 /10.000"), std::string::npos) << info;
  EXPECT_NE(info.find("ODOMETRY /     30 /10.000"), std::string::npos) << info;
}

TEST(Rawlog, IcpSlamFindsTheTrueMotionInTheExportedScans) {
  if (!installed("icp-slam")) GTEST_SKIP() << "needs icp-slam of mrpt-apps";
  const TempFolder folder;
  const int steps = 100;
  testing::record(drive_through_room(steps, {}, 1.08), folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  testing::write_bytes(
      folder.file("icp.ini"),
      "[ICP]\nmaxIterations=80\nminAbsStep_trans=1e-6\nminAbsStep_rot=1e-6\nthresholdDist=0.3\n"
      "thresholdAng_DEG=5\nALFA=0.8\nsmallestThresholdDist=0.05\nonlyUniqueRobust=true\n"
      "ICP_algorithm=icpClassic\ncorresponding_points_decimation=5\n"
      "[MappingApplication]\nrawlog_offset=0\nlogOutput_dir=" +
          folder.file("out") +
          "\nLOG_FREQUENCY=1000\nSAVE_3D_SCENE=0\nSAVE_POSE_LOG=0\nCAMERA_3DSCENE_FOLLOWS_ROBOT=0\nSHOW_PROGRESS_3D_"
          "REAL_TIME_DELAY_MS=0\nSHOW_LASER_SCANS_3D=0\nSHOW_PROGRESS_3D_REAL_TIME=0\n"
          "localizationLinDistance=0.2\nlocalizationAngDistance=5\ninsertionLinDistance=1.0\n"
          "insertionAngDistance=30\nminICPgoodnessToAccept=0.4\nmatchAgainstTheGrid=0\n"
          "occupancyGrid_count=0\npointsMap_count=1\nlikelihoodMapSelection=-1\n"
          "[MappingApplication_pointsMap_00_insertOpts]\nminDistBetweenLaserPoints=0.05\n"
          "isPlanarMap=true\nalso_interpolate=false\n");
  output_of("icp-slam '" + folder.file("icp.ini") + "' '" + folder.file("a.rawlog") + "'", folder);
  std::ifstream path(folder.file("out") + "/log_estimated_path.txt");
  int step = 0;
  TPose2D last;
  while (path >> step >> last.x >> last.y >> last.phi) {
  }
  const TPose2D truth = pose_at_step(steps - 1) - pose_at_step(0);
  EXPECT_GE(step, 2 * steps - 1);
  EXPECT_NEAR(last.x, truth.x, 0.04) << "odometry alone is 0.16 m off";
  EXPECT_NEAR(last.y, truth.y, 0.04);
  EXPECT_NEAR(last.phi, truth.phi, 0.03);
}

/// Serializes MRPT objects one after the other, as a rawlog holds them.
class RawlogWriter {
 public:
  RawlogWriter() : archive_(mrpt::serialization::archiveFrom(stream_)) {}
  void add(const mrpt::serialization::CSerializable& object) { archive_ << object; }
  std::string bytes() {
    return std::string(static_cast<const char*>(stream_.getRawBufferData()),
                       static_cast<std::size_t>(stream_.getTotalBytesCount()));
  }

 private:
  mrpt::io::CMemoryStream stream_;
  decltype(mrpt::serialization::archiveFrom(stream_)) archive_;
};

mrpt::obs::CObservation2DRangeScan::Ptr mrpt_scan(mrpt::Clock::time_point time, const std::string& label) {
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->timestamp = time;
  scan->sensorLabel = label;
  scan->aperture = 3.0f;
  scan->maxRange = 8.0f;
  scan->sensorPose = mrpt::poses::CPose3D(0.2, 0, 0.3, 0.1, 0, 0);
  scan->resizeScanAndAssign(5, 2.0f, true);
  scan->setScanRange(1, 8.0f);  // at the limit, though marked valid
  scan->setScanRange(2, 9.0f);
  scan->setScanRangeValidity(2, false);
  scan->setScanRange(3, 0.0f);
  scan->setScanRangeValidity(3, false);
  return scan;
}

std::string action_frame_log(bool timed, int frames) {
  RawlogWriter writer;
  for (int i = 0; i < frames; ++i) {
    mrpt::obs::CActionCollection actions;
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(mrpt::poses::CPose2D(i == 0 ? 0.0 : 0.1, 0.0, i == 0 ? 0.0 : 0.05), {});
    actions.insert(movement);
    writer.add(actions);
    const auto time = timed ? to_mrpt_time(Stamp::from_seconds(1000.0 + 0.25 * i)) : INVALID_TIMESTAMP;
    mrpt::obs::CSensoryFrame frame;
    frame.insert(mrpt_scan(time, "FRONT"));
    frame.insert(mrpt_scan(time, "REAR"));
    writer.add(frame);
  }
  return writer.bytes();
}

TEST(Rawlog, ActionsAddUpToOdometryAndOneScannerIsRead) {
  const TempFolder folder;
  write_gzip(folder.file("a.rawlog"), action_frame_log(true, 6));
  RobotModel model;
  const std::vector<Inputs> ticks = read_rawlog(folder.file("a.rawlog"), model);
  ASSERT_EQ(ticks.size(), 6u);
  TPose2D expected(0, 0, 0);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (i > 0) expected = expected + TPose2D(0.1, 0.0, 0.05);
    ASSERT_EQ(ticks[i].scans.size(), 1u);
    ASSERT_EQ(ticks[i].odometry.size(), 1u);
    EXPECT_EQ(ticks[i].scans[0].stamp, Stamp::from_seconds(1000.0 + 0.25 * static_cast<double>(i)));
    EXPECT_EQ(ticks[i].odometry[0].stamp, ticks[i].scans[0].stamp);
    EXPECT_NEAR(ticks[i].odometry[0].pose.x, expected.x, 1e-12);
    EXPECT_NEAR(ticks[i].odometry[0].pose.phi, expected.phi, 1e-12);
  }
  EXPECT_TRUE(testing::same(ticks[0].scans[0].ranges, {2.0f, testing::kMiss, testing::kMiss, testing::kUnknown, 2.0f}));
  EXPECT_NEAR(ticks[0].scans[0].angle_min, -1.5, 1e-6);
  EXPECT_EQ(model.laser.name, "FRONT");
  EXPECT_EQ(model.laser.beams, 5);
  EXPECT_NEAR(model.laser.scan_period, 0.25, 1e-9);
  EXPECT_NEAR(model.T_base_laser.x, 0.2, 1e-9);
  EXPECT_NEAR(model.T_base_laser.yaw, 0.1, 1e-9);
  EXPECT_FALSE(model.has_levelling_unit);
}

TEST(Rawlog, FramesWithoutTimeComeATenthOfASecondApart) {
  const TempFolder folder;
  write_gzip(folder.file("a.rawlog"), action_frame_log(false, 4));
  RobotModel model;
  const std::vector<Inputs> ticks = read_rawlog(folder.file("a.rawlog"), model);
  ASSERT_EQ(ticks.size(), 4u);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i].scans.at(0).stamp, Stamp::from_seconds(0.1 * static_cast<double>(i)));
    EXPECT_EQ(ticks[i].odometry.at(0).stamp, ticks[i].scans.at(0).stamp);
  }
}

TEST(Rawlog, ObservedOdometryGoesBeforeActions) {
  RawlogWriter writer;
  mrpt::obs::CObservationOdometry odometry;
  for (int i = 0; i < 4; ++i) {
    odometry.timestamp = to_mrpt_time(Stamp::from_seconds(10.0 + i));
    odometry.odometry = mrpt::poses::CPose2D(5.0 + i, 1.0, 0.0);
    writer.add(odometry);
    writer.add(*mrpt_scan(to_mrpt_time(Stamp::from_seconds(10.5 + i)), "LASER"));
  }
  const ForeignLog log = read_rawlog_bytes(writer.bytes(), "a.rawlog");
  ASSERT_EQ(log.ticks.size(), 4u);
  EXPECT_EQ(log.ticks[0].odometry.size(), 2u) << "the scan waits for the odometry behind it";
  EXPECT_EQ(log.ticks[0].odometry[0].pose.x, 0.0) << "odometry starts at zero";
  EXPECT_EQ(log.ticks[0].odometry[1].pose.x, 1.0);
}

TEST(Rawlog, CutInsideAnEntrySaysWhere) {
  const std::string bytes = action_frame_log(true, 6);
  Rng rng(6, "cuts");
  int refused = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const std::size_t size = 1 + rng.below(static_cast<std::uint32_t>(bytes.size()) - 1);
    try {
      read_rawlog_bytes(bytes.substr(0, size), "a.rawlog");
    } catch (const InputError& e) {
      const std::string message = e.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      if (message.find("holds no 2D laser scan") != std::string::npos) continue;
      EXPECT_EQ(message.find("a.rawlog: entry "), 0u) << message;
      EXPECT_NE(message.find("ends in the middle of this entry"), std::string::npos) << message;
      ++refused;
    }
  }
  EXPECT_GT(refused, 80);
}

/// What a reader makes of damaged bytes: a log (empty message), or one line.
std::string reading_message(const std::string& bytes) {
  try {
    read_rawlog_bytes(bytes, "a.rawlog");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Rawlog, WrongBeamCountIsOneLine) {
  const TempFolder folder;
  testing::record(drive_through_room(3, {}), folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  std::string bytes = unpacked(testing::read_bytes(folder.file("a.rawlog")), "a.rawlog");
  const std::size_t count = bytes.find(std::string("\xaa\x02\x00\x00", 4));
  ASSERT_NE(count, std::string::npos);
  for (const char top : {'\x01', '\x10', '\x7f', '\xf0'}) {
    bytes[count + 3] = top;
    const std::string message = reading_message(bytes);
    EXPECT_EQ(message.find("a.rawlog: entry "), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(Rawlog, AnyDamageIsALogOrOneLineAndBoundedMemory) {
  const TempFolder folder;
  testing::record(drive_through_room(2, {}), folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  const std::string whole[] = {unpacked(testing::read_bytes(folder.file("a.rawlog")), "a.rawlog"),
                               action_frame_log(true, 3)};
  const std::uint64_t seed = 15;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Rng rng(seed, "damage");
  int refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string bytes = whole[trial % 2];
    for (std::uint32_t n = 1 + rng.below(3); n > 0; --n) {
      // Mostly where the lengths and names are: near the beginning of an entry.
      const auto size = static_cast<std::uint32_t>(bytes.size());
      const std::size_t at = rng.below(2) == 0 ? rng.below(size) : rng.below(std::min<std::uint32_t>(size, 400));
      bytes[at] = static_cast<char>(rng.below(256));
    }
    const std::string message = reading_message(bytes);
    EXPECT_EQ(message.find('\n'), std::string::npos) << "trial " << trial << ": " << message;
    if (!message.empty()) ++refused;
  }
  EXPECT_GT(refused, 100);
  rusage use{};
  getrusage(RUSAGE_CHILDREN, &use);
  if (!kAddressSanitizer) {
    EXPECT_LT(use.ru_maxrss, 512 * 1024) << "kB in the largest child";
  }
}

TEST(Rawlog, TimeBeyondOurRangeIsRefused) {
  RawlogWriter writer;
  writer.add(*mrpt_scan(mrpt::Clock::time_point(mrpt::Clock::duration(std::numeric_limits<std::int64_t>::max())), "A"));
  const std::string message = reading_message(writer.bytes());
  EXPECT_EQ(message.find("a.rawlog: entry 0: is damaged (a time"), 0u) << message;
}

TEST(Rawlog, FlagOfAnyByteIsTrueOrFalse) {
  RawlogWriter writer;
  auto scan = mrpt_scan(to_mrpt_time(Stamp::from_seconds(1.0)), "LASER");
  scan->rightToLeft = true;
  writer.add(*scan);
  std::string bytes = writer.bytes();
  const std::string aperture("\x00\x00\x40\x40", 4);  // 3 rad
  const std::size_t flag = bytes.find(aperture) + 4;
  ASSERT_EQ(bytes[flag], '\x01');
  const ForeignLog straight = read_rawlog_bytes(bytes, "a.rawlog");
  bytes[flag] = '\xff';
  const ForeignLog odd = read_rawlog_bytes(bytes, "a.rawlog");
  EXPECT_TRUE(testing::same(odd.ticks.at(0).scans.at(0).ranges, straight.ticks.at(0).scans.at(0).ranges));
}

TEST(Rawlog, CutFileSaysWhereItEnds) {
  const TempFolder folder;
  testing::record(drive_through_room(30, {}), folder.file("a.log"));
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  const std::string bytes = testing::read_bytes(folder.file("a.rawlog"));
  testing::write_bytes(folder.file("b.rawlog"), bytes.substr(0, 2 * bytes.size() / 3));
  const std::string message = message_of<InputError>([&] { ReplayRobot replay(folder.file("b.rawlog")); });
  EXPECT_NE(message.find("b.rawlog: the gzip data stop at byte"), std::string::npos) << message;
}

TEST(Rawlog, ScansOfDifferentWidthsAllSurviveTheExport) {
  const TempFolder folder;
  std::string carmen;
  for (int i = 0; i < 6; ++i) {
    const int beams = 4 + i % 2;
    carmen += "FLASER " + std::to_string(beams);
    for (int beam = 0; beam < beams; ++beam) carmen += " 2.5";
    carmen += " 0 0 0 0 0 0 " + std::to_string(i) + ".5 h " + std::to_string(i) + ".5\n";
  }
  testing::write_bytes(folder.file("a.log"), carmen);
  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  const auto before = collect<LaserScan>(testing::play(folder.file("a.log")), &Inputs::scans);
  const auto after = collect<LaserScan>(testing::play(folder.file("a.rawlog")), &Inputs::scans);
  ASSERT_EQ(after.size(), 6u);
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_TRUE(testing::same(after[i].ranges, before[i].ranges));
    EXPECT_NEAR(after[i].angle_min, before[i].angle_min, 1e-6);
    EXPECT_NEAR(after[i].angle_step, before[i].angle_step, 1e-6);
  }
}

TEST(Rawlog, DamagedModelCommentIsNamed) {
  RawlogWriter writer;
  writer.add(*mrpt_scan(to_mrpt_time(Stamp{0}), "LASER"));
  mrpt::obs::CObservationComment comment;
  comment.text = "rubble robot model: {\"name\": 3}";
  writer.add(comment);
  const std::string message = message_of<InputError>([&] { read_rawlog_bytes(writer.bytes(), "a.rawlog"); });
  EXPECT_EQ(message.find("a.rawlog: entry 1: the comment"), 0u) << message;
}

TEST(Rawlog, OtherFilesAreRefused) {
  const TempFolder folder;
  testing::write_bytes(folder.file("a"), "ODOM 1 2 3\n");
  RobotModel model;
  EXPECT_NE(message_of<InputError>([&] { read_rawlog(folder.file("a"), model); }).find("MRPT"), std::string::npos);
}

TEST(Rawlog, TruthBesideTheRawlogIsTheReference) {
  const TempFolder folder;
  const std::string path = folder.file("a.rawlog");
  EXPECT_TRUE(read_rawlog_reference(path).empty());
  testing::write_bytes(path + ".GT.txt", "# time x y phi\n1464600320.989009 1.5 -2 0.25\n1464600321.041046 2 0 0\n");
  const Trajectory reference = read_rawlog_reference(path);
  ASSERT_EQ(reference.size(), 2u);
  EXPECT_EQ(reference[0].stamp.ns, 1464600320989009000);
  EXPECT_EQ(reference[0].pose.phi, 0.25);
  testing::write_bytes(path + ".GT.txt", "1 2 3 4\n1 2 x 4\n");
  EXPECT_NE(message_of<InputError>([&] { read_rawlog_reference(path); }).find(".GT.txt:2:5: 'x'"), std::string::npos);
  testing::write_bytes(path + ".GT.txt", "2 2 3 4\n1 2 3 4\n");
  EXPECT_NE(message_of<InputError>([&] { read_rawlog_reference(path); }).find(".GT.txt:2:1: "), std::string::npos);
}

}  // namespace
}  // namespace rubble::robot
