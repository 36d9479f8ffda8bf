// What scans must show that a robot may be driven by them.
#include "robot/drivers/watch/scan_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "robot/logs/log.h"

namespace rubble::robot {
namespace {

using testing::HasSubstr;

constexpr float kMiss = std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Ten scans a second and ten reports; how long until it is in trouble, if it ever is within a while [s].
class Turning {
 public:
  explicit Turning(const ScanWatch::Settings& settings = ScanWatch::Settings()) : watch(settings) {}
  using Beams = std::function<float(int beam)>;

  double seconds_well(const Beams& beams, double speed = 0.0, double most = 10.0) {
    for (int i = 0; i < 10.0 * most; ++i) {
      if (!turn(beams, speed)) return 0.1 * i;
    }
    return most;
  }
  double seconds_ill(const Beams& beams) {
    for (int i = 0; i < 100; ++i)
      if (turn(beams, 0.0)) return 0.1 * i;
    return 10.0;
  }
  bool turn(const Beams& beams, double speed) {
    LaserScan scan;
    scan.range_max = 4.0;
    scan.angle_step = 0.00614;
    for (int i = 0; i < 682; ++i) scan.ranges.push_back(beams(i));
    scan.codes.assign(682, code);
    now_ = now_ + 0.1;
    Odometry report;
    report.pose.x = x_ += 0.1 * speed;
    watch.look({report});
    watch.see(scan, now_);
    EXPECT_EQ(watch.is_well(), watch.trouble().empty());
    return watch.is_well();
  }

  Beams noisy() {
    return [this](int) { return 2.0f + 0.001f * static_cast<float>(random_() % 20); };
  }
  /// Seen in a hall whose walls end `clear` metres ahead, to the left and right of `ahead` metres gone.
  Beams hall(double clear) {
    return [this, clear](int i) {
      const double bearing = 0.00614 * (i - 340.5);
      const double range = std::cos(bearing) < -0.2  ? (x_ + 0.5) / -std::cos(bearing)
                           : std::cos(bearing) > 0.2 ? (clear - x_) / std::cos(bearing)
                                                     : 1e3;
      return range > 0.0 && range <= 4.0 ? static_cast<float>(range) : kMiss;
    };
  }
  ScanWatch watch;
  std::uint8_t code = 0;  ///< of all beams

 private:
  std::mt19937 random_{1};
  Stamp now_ = Stamp::from_seconds(100.0);
  double x_ = 0.0;
};

TEST(ScanWatch, ACoveredScannerIsNamedAfterASecondWhateverItsBeamsSay) {
  for (const float beam : {kMiss, kUnknown, 0.02f, 0.1f}) {
    SCOPED_TRACE(beam);
    Turning robot;
    EXPECT_EQ(robot.seconds_well(robot.noisy(), 0.3), 10.0);
    EXPECT_NEAR(robot.seconds_well([&](int i) { return i % 3 == 0 ? kMiss : beam; }), ScanWatch::kBlind, 0.11);
    EXPECT_THAT(robot.watch.trouble(), HasSubstr("sees nothing"));
    EXPECT_NEAR(robot.seconds_ill(robot.noisy()), 1.0, 0.11) << "it is trusted when it has seen for a while";
  }
}

TEST(ScanWatch, WideRoomsAreNoCover) {
  Turning robot;
  for (const int one : {0, 340, 681})
    EXPECT_EQ(robot.seconds_well([&](int i) { return i == one ? 3.9f : kMiss; }, 0.3, 60.0), 60.0);
  // A glimpse of nothing at all, again and again.
  int scan = 0;
  EXPECT_EQ(robot.seconds_well([&](int i) { return (scan += i == 0 ? 1 : 0) % 9 == 0 ? 3.9f : kMiss; }, 0.3, 60.0),
            60.0);
}

TEST(ScanWatch, WallsThatGoOutOfReachAtItsEdgeAreAnEmptyHall) {
  Turning robot;
  // From one wall, behind it, to the other one 12 m on: 7.5 m without a range.
  EXPECT_EQ(robot.seconds_well(robot.hall(12.0), 0.4, 28.0), 28.0);
}

TEST(ScanWatch, AnEmptyHallIsLeftWithinTheWayThatIsGranted) {
  Turning robot(ScanWatch::Settings{true, 5.0});
  const double seen_no_more = 4.0 / 0.4;  // at the latest
  const double held = robot.seconds_well(robot.hall(100.0), 0.4, 60.0);
  EXPECT_LT(held, seen_no_more + 5.0 / 0.4 + 1.0);
  EXPECT_GT(held, 5.0 / 0.4);
  EXPECT_TRUE(robot.watch.holds());
}

TEST(ScanWatch, ACoverIsNoHall) {
  const auto wall = [](int i) { return 1.0f + 0.003f * static_cast<float>(i); };
  Turning near, strays, coded;
  near.seconds_well(wall, 0.3, 2.0);
  EXPECT_LT(near.seconds_well([](int) { return kMiss; }, 0.3), 1.2) << "walls do not go from one scan to the next";
  strays.seconds_well(strays.noisy(), 0.3, 2.0);
  int scan = 0;
  strays.seconds_well([&](int i) { return (scan += i == 0 ? 1 : 0) % 5 == 0 && i == 300 ? 3.9f : kMiss; }, 0.3, 3.0);
  EXPECT_LT(strays.seconds_well([](int) { return kMiss; }, 0.3), 1.2) << "a stray range far away is no hall's edge";
  coded.seconds_well(coded.hall(100.0), 0.4, 11.0);
  coded.code = 6;
  EXPECT_LT(coded.seconds_well([](int) { return kUnknown; }, 0.4), 1.2) << "an error is no empty hall";
  Turning unechoed;  // no_echo_is_miss: false
  unechoed.seconds_well(unechoed.hall(100.0), 0.4, 11.0);
  EXPECT_EQ(unechoed.seconds_well([](int) { return kUnknown; }, 0.4, 5.0), 5.0);
}

TEST(ScanWatch, WhereNothingHoldsItIsNamedAllTheSame) {
  Turning robot(ScanWatch::Settings{false, 8.0});
  EXPECT_LT(robot.seconds_well([](int) { return kMiss; }), 1.2);
  EXPECT_THAT(robot.watch.trouble(), HasSubstr("sees nothing"));
  EXPECT_FALSE(robot.watch.holds());
  robot.seconds_ill(robot.noisy());
  robot.seconds_well([](int i) { return 1.0f + 0.003f * static_cast<float>(i); });
  EXPECT_TRUE(robot.watch.holds()) << "one that hangs";
}

TEST(ScanWatch, TheSameScanAgainAndAgainIsNamedSoonerWhereTheWheelsTurn) {
  const auto wall = [](int i) { return 1.0f + 0.003f * static_cast<float>(i); };
  Turning stands, drives;
  EXPECT_NEAR(stands.seconds_well(wall), ScanWatch::kRepeats, 0.11);
  EXPECT_THAT(stands.watch.trouble(), HasSubstr("repeats the same scan"));
  EXPECT_NEAR(drives.seconds_well(wall, 0.3), ScanWatch::kRepeatsSoon, 0.11);
  EXPECT_NEAR(drives.seconds_ill(drives.noisy()), 1.0, 0.11);
}

TEST(ScanWatch, OneBeamThatDiffersAndAScanOfFewRangesAreNoRepetition) {
  Turning robot;
  int scan = 0;
  EXPECT_EQ(
      robot.seconds_well([&](int i) { return i == 0 ? 1.0f + 0.001f * static_cast<float>(++scan % 2) : 2.0f; }, 0.3),
      10.0);
  EXPECT_EQ(robot.seconds_well([&](int i) { return i < ScanWatch::kEnough - 1 ? 2.0f : kMiss; }, 0.0), 10.0);
}

/// As they were delivered, at rest and under way: nothing of what real scanners say in real rooms is taken for a cover
/// or a scanner that hangs.
TEST(ScanWatch, RecordedDrivesRaiseNoAlarm) {
  const char* data = std::getenv("RUBBLE_DATA");
  if (data == nullptr) GTEST_SKIP() << "set RUBBLE_DATA to the folder of public data";
  for (const char* name : {"aces-corrected.log.gz", "csail-corrected.log.gz", "exp1.dat", "fhw-corrected.log.gz",
                           "freiburg-079-corrected.log.gz", "intel-corrected.log.gz"}) {
    SCOPED_TRACE(name);
    ReplayRobot replay(std::string(data) + "/logs/" + name);
    ScanWatch watch;
    int scans = 0, alarms = 0;
    while (const auto inputs = replay.read()) {
      watch.look(inputs->odometry);
      for (const LaserScan& scan : inputs->scans) {
        watch.see(scan, scan.stamp);
        ++scans;
        alarms += watch.is_well() ? 0 : 1;
      }
    }
    EXPECT_GT(scans, 400);
    EXPECT_EQ(alarms, 0);
    std::printf("%s: %d scans, %d alarms\n", name, scans, alarms);
  }
}

}  // namespace
}  // namespace rubble::robot
