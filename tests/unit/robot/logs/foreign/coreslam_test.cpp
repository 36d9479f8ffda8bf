#include "robot/logs/foreign/coreslam.h"

#include "base/error.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using testing::message_of;
using testing::scans_of;

std::string line_of(long time_us, long left, long right, const std::vector<int>& ranges) {
  std::string line = std::to_string(time_us) + " 14710 " + std::to_string(left) + " " + std::to_string(right);
  for (int i = 4; i < 24; ++i) line += " 170.1";
  for (const int range : ranges) line += " " + std::to_string(range);
  return line + "\n";
}

std::vector<int> all(int mm) { return std::vector<int>(683, mm); }

TEST(CoreSlam, CodesAreMissesOrUnknownAndTheRobotsBodyIsLeftOut) {
  std::vector<int> ranges = all(1234);
  ranges[100] = 0;
  ranges[101] = 7;
  ranges[102] = 19;
  ranges[103] = 20;
  const ForeignLog log = read_coreslam(line_of(1000000, 0, 0, ranges), "a.dat");
  const LaserScan scan = scans_of(log).at(0);
  ASSERT_EQ(scan.ranges.size(), 683u);
  EXPECT_EQ(scan.ranges[100], testing::kMiss);
  EXPECT_TRUE(std::isnan(scan.ranges[101]));
  EXPECT_TRUE(std::isnan(scan.ranges[102]));
  EXPECT_EQ(scan.ranges[103], 0.02f);
  EXPECT_EQ(scan.ranges[341], 1.234f);
  EXPECT_TRUE(std::isnan(scan.ranges[61]));
  EXPECT_FALSE(std::isnan(scan.ranges[62]));
  EXPECT_FALSE(std::isnan(scan.ranges[641]));
  EXPECT_TRUE(std::isnan(scan.ranges[642]));
  EXPECT_EQ(scan.bearing(341), 0.0) << "beam 341 looks ahead";
  EXPECT_EQ(log.model.T_base_laser.x, 0.145);
}

TEST(CoreSlam, WheelsTurnIntoMetresAndRadians) {
  // One turn of both wheels, then a turn on the spot.
  const std::string text = line_of(1000000, 500, 700, all(1000)) + line_of(2000000, 2500, 2700, all(1000)) +
                           line_of(3000000, 2400, 2800, all(1000));
  const ForeignLog log = read_coreslam(text, "a.dat");
  std::vector<Odometry> odometry;
  for (const Inputs& tick : log.ticks) odometry.insert(odometry.end(), tick.odometry.begin(), tick.odometry.end());
  odometry.erase(odometry.begin());  // stands still before the first line
  ASSERT_EQ(odometry.size(), 3u);
  EXPECT_EQ(odometry[0].pose.x, 0.0);
  EXPECT_NEAR(odometry[1].pose.x, 0.077 * 2.0 * kPi, 1e-12);
  EXPECT_NEAR(odometry[1].v, 0.077 * 2.0 * kPi, 1e-12);
  EXPECT_NEAR(odometry[2].pose.x, odometry[1].pose.x, 1e-12);
  EXPECT_NEAR(odometry[2].pose.phi, 0.077 * 2.0 * kPi * 200.0 / (2000.0 * 2.0 * 0.165), 1e-12);
}

TEST(CoreSlam, WrongLinesAreNamedByLineAndColumn) {
  const std::string good = line_of(1000000, 0, 0, all(1000));
  std::string bad = line_of(1100000, 0, 0, all(1000));
  bad.replace(0, 7, "11000x0");
  EXPECT_EQ(message_of<InputError>([&] { read_coreslam(good + bad, "a.dat"); }).find("a.dat:2:1: '11000x0'"), 0u);
  const std::string shorter = "1100000 1 2 3\n";
  EXPECT_EQ(message_of<InputError>([&] { read_coreslam(good + shorter, "a.dat"); }).find("a.dat:2:14: the line ends"),
            0u);
  std::string longer = line_of(1100000, 0, 0, std::vector<int>(684, 1000));
  EXPECT_NE(message_of<InputError>([&] { read_coreslam(good + longer, "a.dat"); }).find("more than 707"),
            std::string::npos);
  const std::string negative = line_of(1100000, 0, 0, all(-5));
  EXPECT_NE(message_of<InputError>([&] { read_coreslam(good + negative, "a.dat"); }).find("'range in mm'"),
            std::string::npos);
  const std::string late = line_of(900000000, 0, 0, all(1000));
  EXPECT_NE(message_of<InputError>([&] { read_coreslam(late + good, "a.dat"); }).find("a.dat:2:1: the time jumps back"),
            std::string::npos);
}

}  // namespace
}  // namespace rubble::robot
