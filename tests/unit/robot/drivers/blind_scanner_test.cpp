// A scanner whose scans come in time and show nothing, before a robot that drives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <thread>

#include "robot/drivers/host_clock.h"
#include "robot/drivers/real_robot.h"
#include "robot/drivers/scan_queue.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"

namespace rubble::robot {
namespace {

enum class Lens { Clear, Covered, Hangs, Hall };

/// A base that drives in a room, and the scans of it.
class Room : public Scanner {
 public:
  Room()
      : world_([this] {
          const Stamp start = host_now();
          for (int i = 0; !ending_; ++i) {
            const Stamp now = start + 0.01 * i;
            sleep_until(now);
            turn(i, now);
          }
        }) {}
  ~Room() override {
    ending_ = true;
    world_.join();
  }
  std::vector<LaserScan> take() override { return queue_.take(); }
  ScannerStatus status() const override { return queue_.status(); }
  ScannerInfo info() const override { return queue_.info(); }
  int descriptor() const override { return queue_.descriptor(); }

  const std::string& port() const { return server_.port(); }
  std::atomic<Lens> lens{Lens::Clear};
  std::atomic<double> speed{0.0};

 private:
  void turn(int i, Stamp now) {
    Drive motion;
    server_.with([&] { motion = arcos_.motion(); });
    pose_.x += 0.01 * (speed = motion.v);
    if (i % 10 == 0) server_.with([&] { arcos_.measure({now, pose_, motion.v, motion.w, false}, now); });
    if (i % 10 == 5) scan(now);
  }
  void scan(Stamp now) {
    constexpr float kMiss = std::numeric_limits<float>::infinity();
    LaserScan scan;
    scan.stamp = now - 0.08;
    for (int i = 0; i < 100; ++i)
      scan.ranges.push_back(lens == Lens::Covered ? kMiss : 2.0f + 0.001f * static_cast<float>(random_() % 20));
    if (lens == Lens::Hangs) scan.ranges = last_;
    if (lens == Lens::Hall) {  // 15 m wide: a wall behind, one ahead, none to the sides
      scan.range_max = 4.0;
      scan.angle_step = 0.042;
      const auto seen = [&](double beam) {
        const double c = std::cos(0.042 * (beam - 49.5));
        const double range = c < -0.2 ? (hall_x_ + 1.0) / -c : c > 0.2 ? (14.0 - hall_x_) / c : 1e3;
        return range < 4.0 ? static_cast<float>(range) + 0.001f * static_cast<float>(random_() % 20) : kMiss;
      };
      for (int i = 0; i < 100; ++i) scan.ranges[static_cast<std::size_t>(i)] = seen(i);
      hall_x_ = std::min(hall_x_ + 0.7, 7.0);  // soon in its middle, where it sees nothing
    }
    last_ = scan.ranges;
    queue_.put(scan, now);
  }

  ArcosEmulator arcos_{ArcosEmulatorSettings{}};
  DeviceServer server_{"tcp:127.0.0.1:0", arcos_, 1};
  ScanQueue queue_;
  std::mt19937 random_{1};
  std::vector<float> last_;
  double hall_x_ = 0.0;
  mrpt::math::TPose2D pose_;
  std::atomic<bool> ending_{false};
  std::thread world_;
};

class BlindScanner : public testing::Test {
 protected:
  BlindScanner() {
    settings.base_port = room.port();
    settings.model.has_levelling_unit = false;
  }
  /// Commands on, whatever read() waits for, until the law holds; false: it does not.
  template <class Law>
  bool drives_until(RealRobot& robot, const Law& law) {
    const Stamp end = host_now() + 20.0;
    const auto wanted = [&] {
      robot.command({{0.3, 0.0}, {}});
      return !law() && host_now() < end;
    };
    robot.while_waiting([&](const RobotStatus& status) {
      for (const Hindrance& one : status.silent) said = one.line();
      return wanted();
    });
    while (wanted()) {
      const auto inputs = robot.read();
      for (const LaserScan& scan : inputs ? inputs->scans : std::vector<LaserScan>{})
        blind_mapped += std::isfinite(scan.ranges.front()) ? 0 : 1;
    }
    return law();
  }

  Room room;
  RealRobotSettings settings;
  std::string said;      ///< of what held it last
  int blind_mapped = 0;  ///< scans without a range that the core got
};

TEST_F(BlindScanner, HoldsTheRobotUntilItSeesAgain) {
  RealRobot robot(settings, room, nullptr);
  ASSERT_TRUE(drives_until(robot, [&] { return room.speed > 0.1; }));
  for (const Lens lens : {Lens::Covered, Lens::Hangs}) {
    room.lens = lens;
    said.clear();
    ASSERT_TRUE(drives_until(robot, [&] { return room.speed == 0.0; })) << "it drives on blindly";
    EXPECT_THAT(said, testing::HasSubstr(lens == Lens::Covered ? "urg: sees nothing" : "urg: repeats the same scan"));
    EXPECT_FALSE(robot.status().held) << "nobody needs to let it go";
    room.lens = Lens::Clear;
    ASSERT_TRUE(drives_until(robot, [&] { return room.speed > 0.1; })) << "it is not let go";
  }
  EXPECT_LE(blind_mapped, 15) << "of some forty that came";
}

TEST_F(BlindScanner, AWideHallHoldsNobodyWhoCameThereSeeing) {
  RealRobot robot(settings, room, nullptr);
  ASSERT_TRUE(drives_until(robot, [&] { return room.speed > 0.1; }));
  room.lens = Lens::Hall;
  said.clear();
  const Stamp end = host_now() + 4.0;
  EXPECT_TRUE(drives_until(robot, [&] { return host_now() > end; }));
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("sees nothing")));
  EXPECT_GT(room.speed, 0.1);
  EXPECT_GT(blind_mapped, 5) << "the hall's emptiness is mapped";
}

TEST_F(BlindScanner, WhoIsToldThatNothingIsNoCoverDrivesOn) {
  settings.safety.scans.nothing_holds = false;
  RealRobot robot(settings, room, nullptr);
  ASSERT_TRUE(drives_until(robot, [&] { return room.speed > 0.1; }));
  room.lens = Lens::Covered;
  ASSERT_TRUE(drives_until(robot, [&] { return !robot.status().troubles.empty(); }));
  EXPECT_THAT(robot.status().troubles.front().line(), testing::HasSubstr("urg: sees nothing"));
  EXPECT_GT(room.speed, 0.1);
}

TEST_F(BlindScanner, WhoOnlyMapsIsToldAndGoesOn) {
  settings.base.passive = true;
  RealRobot robot(settings, room, nullptr);
  room.lens = Lens::Covered;
  ASSERT_TRUE(drives_until(robot, [&] { return !robot.status().troubles.empty(); }));
  EXPECT_THAT(robot.status().troubles.front().line(), testing::HasSubstr("urg: sees nothing"));
  EXPECT_TRUE(robot.status().silent.empty());
  EXPECT_TRUE(robot.read());
}

}  // namespace
}  // namespace rubble::robot
