// The base driver that docs/extending.md shows drives a real robot as the shipped one does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include "base/error.h"
#include "examples/own_base/line_base.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/real_robot.h"
#include "robot/drivers/scan_queue.h"
#include "robot/emulators/device_server.h"

namespace rubble::robot {
namespace {

/// The microcontroller that LineBase talks to; its wheels obey at once.
class LineDevice : public EmulatedDevice {
 public:
  void client_came(Stamp) override {}
  void client_left(Stamp) override {}
  void receive(std::string_view bytes, Stamp) override {
    for (const char c : bytes) {
      if (c != '\n') {
        line_ += c;
        continue;
      }
      int on = 0;
      if (std::sscanf(line_.c_str(), "M %d", &on) == 1) motors = on != 0 && !button;
      std::sscanf(line_.c_str(), "V %lf %lf", &v, &w);
      line_.clear();
    }
  }
  void advance(Stamp now) override {
    if (next_ == Stamp::never()) next_ = now;
    for (; now >= next_; next_ = next_ + 0.05) {
      if (button) motors = false;
      if (!motors) v = w = 0.0;
      phi_ += 0.05 * w;
      x_ += 0.05 * v * std::cos(phi_);
      y_ += 0.05 * v * std::sin(phi_);
      char text[128];
      std::snprintf(text, sizeof text, "O %.4f %.4f %.4f %.3f %.3f %d 24.5\n", x_, y_, phi_, v, w, motors ? 1 : 0);
      output_ += text;
    }
  }
  std::string take_output() override { return std::exchange(output_, ""); }

  double v = 0.0, w = 0.0;
  bool motors = false;
  bool button = false;  ///< pressed: its motors are off whatever it is told

 private:
  std::string line_, output_;
  Stamp next_ = Stamp::never();
  double x_ = 0.0, y_ = 0.0, phi_ = 0.0;
};

class TickingScanner : public Scanner {
 public:
  TickingScanner()
      : thread_([this] {
          while (!ending_) {
            LaserScan scan;
            scan.stamp = host_now() - 0.08;
            scan.ranges.assign(10, 1.0f);
            if (scans) queue_.put(scan, host_now());
            sleep_until(host_now() + 0.1);
          }
        }) {}
  ~TickingScanner() override {
    ending_ = true;
    thread_.join();
  }
  std::vector<LaserScan> take() override { return queue_.take(); }
  ScannerStatus status() const override { return queue_.status(); }
  ScannerInfo info() const override { return queue_.info(); }
  int descriptor() const override { return queue_.descriptor(); }
  std::atomic<bool> scans{true};

 private:
  ScanQueue queue_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

TEST(OwnBase, DrivesWithinItsLimitsStopsWithTheScannerAndIsLeftAtRest) {
  LineDevice device;
  DeviceServer server("tcp:127.0.0.1:0", device, 1);
  TickingScanner scanner;
  RealRobotSettings settings;
  settings.own_base = [](const BaseSettings& base) { return std::make_unique<LineBase>(base); };
  settings.base_port = server.port();
  settings.base.max_v = 0.3;
  settings.model.has_levelling_unit = false;
  settings.safety.start = settings.safety.give_up = 10.0;
  const auto fastest = [&] {
    double v = 0.0;
    server.with([&] { v = device.v; });
    return v;
  };
  {
    RealRobot robot(settings, scanner, nullptr);
    double way = 0.0;
    double seen = 0.0;
    for (int i = 0; i < 400 && way < 0.2; ++i) {
      const auto inputs = robot.read();
      ASSERT_TRUE(inputs);
      robot.command({{2.0, 0.0}, {}});
      if (!inputs->odometry.empty()) way = inputs->odometry.back().pose.x;
      seen = std::max(seen, fastest());
    }
    EXPECT_GE(way, 0.2);
    EXPECT_NEAR(seen, 0.3, 1e-3);
    EXPECT_TRUE(robot.status().motors_on);
    EXPECT_NEAR(robot.status().battery, 24.5, 1e-9);
    scanner.scans = false;
    // The core commands on: it is the scanner's silence that stops the base.
    Stamp asked = host_now();
    const Stamp until = asked + 5.0;
    double slow = 0.0;  // so long the machine took from one question to the next, beyond the pause between
    robot.while_waiting([&](const RobotStatus&) {
      slow = std::max(slow, host_now() - asked - 0.05);
      asked = host_now();
      robot.command({{2.0, 0.0}, {}});
      return fastest() != 0.0 && host_now() < until;
    });
    while (host_now() < until && robot.read()) {
      robot.command({{2.0, 0.0}, {}});
      asked = host_now();
    }
    EXPECT_EQ(fastest(), 0.0) << "it drives on blindly";
    EXPECT_LT(asked - scanner.status().last_scan, 0.3 + 0.15 + 2.0 * slow);
  }
  bool motors = true;
  server.with([&] { motors = device.motors; });
  EXPECT_FALSE(motors);
}

TEST(OwnBase, OneThatWasStoppedAtTheRobotWaitsForTheOperator) {
  LineDevice device;
  DeviceServer server("tcp:127.0.0.1:0", device, 1);
  TickingScanner scanner;
  RealRobotSettings settings;
  settings.own_base = [](const BaseSettings& base) { return std::make_unique<LineBase>(base); };
  settings.base_port = server.port();
  settings.model.has_levelling_unit = false;
  RealRobot robot(settings, scanner, nullptr);
  const auto motors = [&] {
    bool on = false;
    server.with([&] { on = device.motors; });
    return on;
  };
  const auto drives_until = [&](const auto& law, double most) {
    const Stamp end = host_now() + most;
    const auto wanted = [&] {
      robot.command({{0.2, 0.0}, {}});
      return !law() && host_now() < end;
    };
    robot.while_waiting([&](const RobotStatus&) { return wanted(); });
    while (wanted()) robot.read();
    return law();
  };
  ASSERT_TRUE(drives_until(motors, 20.0));
  ASSERT_TRUE(drives_until([&] { return robot.status().motors_on; }, 20.0));
  server.with([&] { device.button = true; });
  ASSERT_TRUE(drives_until([&] { return robot.status().held; }, 20.0));
  server.with([&] { device.button = false; });
  EXPECT_FALSE(drives_until(motors, 3.0)) << "it drives off when the button is let go";
  EXPECT_TRUE(robot.rearm());
  EXPECT_TRUE(drives_until(motors, 20.0));
}

TEST(OwnBase, WhatIsNoNumberIsNoReport) {
  for (const char* line :
       {"O nan 0 0 0 0 1 12\n", "O 0 inf 0 0 0 1 12\n", "O 1e308 0 0 0 0 1 12\n", "O 0 0 0 0 -inf 1 12\n"}) {
    SCOPED_TRACE(line);
    LineBase base{BaseSettings{}};
    base.opened(Stamp::from_seconds(1.0), LineKind::Tcp);
    base.receive(line, Stamp::from_seconds(2.0));
    EXPECT_FALSE(base.ready());
    EXPECT_EQ(base.bad_sums(), 1u);
    EXPECT_TRUE(base.take_odometry().empty());
  }
}

TEST(OwnBase, ANameThatNobodyHasIsRefusedInOneLine) {
  try {
    make_base("segway", {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("segway"), testing::HasSubstr("arcos")));
  }
}

}  // namespace
}  // namespace rubble::robot
