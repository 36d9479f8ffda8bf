#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;

/// A public log: all scans and odometry, in order.
struct Played {
  std::vector<LaserScan> scans;
  Trajectory odometry;
  Trajectory reference;
  RobotModel model;
  std::string format;

  explicit Played(const std::string& path) {
    ReplayRobot replay(path);
    format = replay.format();
    model = replay.model();
    reference = replay.reference();
    Stamp last = Stamp::never();
    while (const auto inputs = replay.read()) {
      EXPECT_GT(inputs->now, last);
      last = inputs->now;
      scans.insert(scans.end(), inputs->scans.begin(), inputs->scans.end());
      for (const Odometry& o : inputs->odometry) odometry.push_back({o.stamp, o.pose});
    }
  }
};

double path_length(const Trajectory& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += std::hypot(path[i].pose.x - path[i - 1].pose.x, path[i].pose.y - path[i - 1].pose.y);
  return length;
}

std::size_t lines_starting_with(const std::string& text, const std::string& start) {
  std::size_t count = text.compare(0, start.size(), start) == 0 ? 1 : 0;
  for (std::size_t at = 0; (at = text.find("\n" + start, at)) != std::string::npos; ++at) ++count;
  return count;
}

struct Corrected {
  const char* name;
  int beams;
  double length;     ///< of the reference path and of the wheels' [m]
  double drift;      ///< of the raw odometry over the run [m]
  double drift_deg;  ///< [deg]
};
void PrintTo(const Corrected& log, std::ostream* out) { *out << log.name; }

class CorrectedLogs : public ::testing::TestWithParam<Corrected> {};

// Figures of the recovered odometry from an independent evaluation of the same files.
TEST_P(CorrectedLogs, RawOdometryIsRecovered) {
  if (testing::data_folder().empty()) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  const Corrected& expected = GetParam();
  const std::string path = testing::data_folder() + "/logs/" + expected.name + "-corrected.log.gz";
  const Played log(path);
  EXPECT_EQ(log.format, "CARMEN log");
  EXPECT_EQ(log.scans.size(), lines_starting_with(unpacked(read_file(path), path), "FLASER "));
  EXPECT_EQ(log.model.laser.beams, expected.beams);
  EXPECT_NEAR(path_length(log.reference), expected.length, 0.02 * expected.length);
  EXPECT_NEAR(path_length(log.odometry), expected.length, 0.08 * expected.length) << "no running to and fro";

  // Both paths start at the first scan; the end of the last scan shows the drift.
  const auto raw_start = pose_at(log.odometry, log.reference.front().stamp);
  const auto raw_end = pose_at(log.odometry, log.reference.back().stamp);
  ASSERT_TRUE(raw_start && raw_end);
  const TPose2D raw = *raw_end - *raw_start;
  const TPose2D truth = log.reference.back().pose - log.reference.front().pose;
  EXPECT_NEAR(std::hypot(raw.x - truth.x, raw.y - truth.y), expected.drift, 1.0);
  EXPECT_NEAR(std::abs(rad_to_deg(wrap_angle(raw.phi - truth.phi))), expected.drift_deg, 2.0);
}

TEST_P(CorrectedLogs, RawOdometryIsSmoothWhereTheCorrectedPosesJump) {
  if (testing::data_folder().empty()) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  const Played log(testing::data_folder() + "/logs/" + GetParam().name + "-corrected.log.gz");
  // Between two scans raw odometry and reference see nearly the same motion: the matcher only polishes it.
  std::vector<double> differences;
  for (std::size_t i = 1; i < log.reference.size(); ++i) {
    const auto from = pose_at(log.odometry, log.reference[i - 1].stamp);
    const auto to = pose_at(log.odometry, log.reference[i].stamp);
    ASSERT_TRUE(from && to);
    const TPose2D raw = *to - *from;
    const TPose2D corrected = log.reference[i].pose - log.reference[i - 1].pose;
    differences.push_back(std::hypot(raw.x - corrected.x, raw.y - corrected.y));
  }
  std::nth_element(differences.begin(), differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2),
                   differences.end());
  EXPECT_LT(differences[differences.size() / 2], 0.15);
}

INSTANTIATE_TEST_SUITE_P(Radish, CorrectedLogs,
                         ::testing::Values(Corrected{"intel", 180, 500.0, 62.0, 151.0},
                                           Corrected{"freiburg-079", 360, 422.0, 46.0, 29.0},
                                           Corrected{"aces", 180, 323.0, 3.9, 58.0}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

std::string exp1() { return testing::data_folder() + "/logs/exp1.dat"; }

TEST(CoreSlamLog, HasItsScansAndItsLength) {
  if (testing::data_folder().empty()) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  const Played log(exp1());
  EXPECT_EQ(log.format, "CoreSLAM log");
  EXPECT_EQ(log.scans.size(), 756u);
  EXPECT_NEAR(path_length(log.odometry), 46.0, 0.3);
  float longest = 0.0f;
  for (const LaserScan& scan : log.scans)
    for (const float range : scan.ranges)
      if (std::isfinite(range)) longest = std::max(longest, range);
  EXPECT_NEAR(static_cast<double>(longest), 5.562, 1e-6);
}

/// How far the view turned between two scans [rad]: the shift at which their ranges agree best.
std::optional<double> turn_seen(const LaserScan& a, const LaserScan& b) {
  constexpr int kReach = 50;
  double best = 1e9;
  int best_shift = 0;
  for (int shift = -kReach; shift <= kReach; ++shift) {
    double sum = 0.0;
    int count = 0;
    for (int i = 62; i <= 641; i += 2) {
      const int j = i - shift;
      if (j < 62 || j > 641) continue;
      const double difference = std::abs(static_cast<double>(a.ranges[static_cast<std::size_t>(i)]) -
                                         static_cast<double>(b.ranges[static_cast<std::size_t>(j)]));
      if (!std::isfinite(difference)) continue;
      sum += std::min(difference, 0.3);
      ++count;
    }
    if (count < 60 || sum / count >= best) continue;
    best = sum / count;
    best_shift = shift;
  }
  if (best > 1.0) return std::nullopt;
  return best_shift * a.angle_step;
}

TEST(CoreSlamLog, ScansSeeTheTurnsOfTheWheelsAtTheirOwnTime) {
  if (testing::data_folder().empty()) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  const Played log(exp1());
  // Median disagreement of wheels and scans when the scans were taken `later` than their stamps say.
  const auto disagreement = [&](double later) {
    std::vector<double> errors;
    for (std::size_t i = 1; i < log.scans.size(); ++i) {
      const auto from = pose_at(log.odometry, log.scans[i - 1].middle() + later);
      const auto to = pose_at(log.odometry, log.scans[i].middle() + later);
      if (!from || !to || std::abs(wrap_angle(to->phi - from->phi)) < 0.03) continue;
      if (const auto seen = turn_seen(log.scans[i - 1], log.scans[i]))
        errors.push_back(std::abs(wrap_angle(to->phi - from->phi) - *seen));
    }
    EXPECT_GT(errors.size(), 100u);
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    return errors[errors.size() / 2];
  };
  const double as_stamped = disagreement(0.0);
  EXPECT_LT(as_stamped, deg_to_rad(1.5));
  EXPECT_LT(as_stamped, disagreement(0.15)) << "as if a scan had no age when its line is stamped";
  EXPECT_LT(as_stamped, disagreement(-0.1));
}

const std::string kMrptData = "/usr/share/mrpt/datasets/";

TEST(MrptLogs, SimulatedRunComesWithItsTruth) {
  const std::string path = kMrptData + "graphslam-engine-demos/action_observations_map/simul.rawlog";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs the datasets of mrpt-common";
  const Played log(path);
  EXPECT_EQ(log.format, "MRPT rawlog");
  EXPECT_EQ(log.scans.size(), 1733u);
  EXPECT_EQ(log.model.laser.beams, 361);
  EXPECT_EQ(log.reference.size(), 1734u);
  EXPECT_NEAR(log.model.T_base_laser.x, 0.2, 1e-6);
  // Simulated wheels are noisy, but from scan to scan they see the true motion.
  std::vector<double> errors;
  for (std::size_t i = 1; i < log.scans.size(); ++i) {
    const auto from = pose_at(log.odometry, log.scans[i - 1].stamp);
    const auto to = pose_at(log.odometry, log.scans[i].stamp);
    const auto true_from = pose_at(log.reference, log.scans[i - 1].stamp);
    const auto true_to = pose_at(log.reference, log.scans[i].stamp);
    if (!from || !to || !true_from || !true_to) continue;
    const TPose2D raw = *to - *from;
    const TPose2D truth = *true_to - *true_from;
    errors.push_back(std::hypot(raw.x - truth.x, raw.y - truth.y));
  }
  ASSERT_GT(errors.size(), 1700u);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05);
}

TEST(MrptLogs, SenaLoopAndLocalizationDemoAreRead) {
  const std::string sena = kMrptData + "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  if (!std::filesystem::exists(sena)) GTEST_SKIP() << "needs the datasets of mrpt-common";
  const Played loop(sena);
  EXPECT_GE(loop.scans.size(), 224u);
  EXPECT_EQ(loop.model.laser.beams, 361);
  EXPECT_TRUE(loop.reference.empty());
  EXPECT_GT(path_length(loop.odometry), 50.0);
  const Played demo(kMrptData + "localization_demo.rawlog");
  EXPECT_EQ(demo.scans.size(), 37u);
}

TEST(MrptLogs, LogsOfOtherSensorsAreRefusedInOneLine) {
  const std::string path = kMrptData + "test_rtk_path.rawlog";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs the datasets of mrpt-common";
  const std::string message = testing::message_of<InputError>([&] { ReplayRobot replay(path); });
  EXPECT_NE(message.find("holds no 2D laser scan"), std::string::npos) << message;
}

TEST(RealLogs, RecordingAndExportingThemKeepsEveryScan) {
  if (testing::data_folder().empty()) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  const testing::TempFolder folder;
  ReplayRobot original(exp1());
  const std::vector<Inputs> ticks = testing::play(original);
  {
    ReplayRobot replay(exp1());
    RecordingRobot recorder(replay, folder.file("a.log"), "");
    while (recorder.read()) {
    }
  }
  EXPECT_TRUE(testing::same_list(testing::play(folder.file("a.log")), ticks));
  const double beams = 756.0 * 683.0;
  EXPECT_LT(static_cast<double>(std::filesystem::file_size(folder.file("a.log"))), 1.5 * beams);

  export_rawlog(folder.file("a.log"), folder.file("a.rawlog"));
  const Played exported(folder.file("a.rawlog"));
  EXPECT_EQ(exported.scans.size(), 756u);
  std::size_t i = 0;
  for (const Inputs& tick : ticks)
    for (const LaserScan& scan : tick.scans) EXPECT_TRUE(testing::same(exported.scans[i++].ranges, scan.ranges));
}

}  // namespace
}  // namespace rubble::robot
