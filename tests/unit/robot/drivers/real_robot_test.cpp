// The real robot against its emulated devices, over TCP on this machine.
#include "robot/drivers/real_robot.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "robot/battery_watch.h"
#include "robot/drivers/black_box_replay.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/heartbeat.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/scan_queue.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/levelling_emulator.h"
#include "robot/hardware_units.h"
#include "tests/support/base_files.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

/// A scanner that gives a scan whenever it is told to.
class ToldScanner : public Scanner {
 public:
  std::vector<LaserScan> take() override { return queue_.take(); }
  ScannerStatus status() const override { return queue_.status(); }
  ScannerInfo info() const override { return queue_.info(); }
  int descriptor() const override { return queue_.descriptor(); }
  void scan(Stamp now) {
    LaserScan scan;
    scan.stamp = now - 0.08;
    scan.ranges.assign(10, 1.0f);
    queue_.update([this](ScannerStatus& status) {
      ++status.scans;
      status.latency = latency;
      status.worst_latency = std::max(status.worst_latency, status.latency);
    });
    queue_.put(scan, now);
  }
  std::atomic<double> latency{0.005};  ///< of the line [s]

 private:
  ScanQueue queue_;
};

/// A robot on a bench: its wheels do at once what the base's emulator asks.
class Bench {
 public:
  explicit Bench(RealRobotSettings settings = {}) : box(folder / "devices.bytes") {
    if (settings.base_port.empty()) settings.base_port = base_server.port();
    settings.levelling_port = unit_server.port();
    settings.safety.start = 10.0;
    settings.safety.give_up = 10.0;
    robot = std::make_unique<RealRobot>(settings, scanner, &box);
    world = std::thread([this] { turn(); });
  }
  ~Bench() {
    ending = true;
    world.join();
  }

  void turn() {
    const Stamp start = host_now();
    for (int i = 0; !ending; ++i) {
      const Stamp now = start + 0.01 * i;
      sleep_until(now);
      const double woke_late = host_now() - now;
      if (woke_late > worst_wake) worst_wake = woke_late;
      Drive motion;
      base_server.with([&] { motion = arcos.motion(); });
      pose.phi += motion.w * 0.01;
      if (pushed != 0.0) motion = {pushed, 0.0};
      pose.x += motion.v * std::cos(pose.phi) * 0.01;
      pose.y += motion.v * std::sin(pose.phi) * 0.01;
      x = pose.x;
      speed = motion.v;
      if (i % 10 == 0 && reports) base_server.with([&] { arcos.measure({now, pose, motion.v, motion.w, false}, now); });
      if (i % 2 == 0)
        unit_server.with([&] {
          unit.measure({now, kGravity * std::sin(tilt), 0.0}, {now, unit.aim().pitch, 0.0}, now);
        });
      if (i % 10 == 5 && scans) scanner.scan(now);
    }
  }

  /// Reads and commands for so long; all that came.
  std::vector<Inputs> drive(double v, double seconds) {
    std::vector<Inputs> all;
    for (const Stamp end = host_now() + seconds; host_now() < end;) {
      auto inputs = robot->read();
      if (!inputs) break;
      robot->command({{v, 0.0}, aim});
      all.push_back(std::move(*inputs));
    }
    return all;
  }

  /// Commands without a pause, whatever read() waits for, until the robot brakes; when it began to, as the law has it
  /// after this moment (an emulator's ramp of 0.3 m/s2 has taken a fifth of the speed off by then); never: it did not
  /// within five seconds.
  Stamp braked_though_commanded(double v) {
    const double before = speed;
    if (before == 0.0) return host_now();  // a busy machine has let it come to rest meanwhile
    for (const Stamp end = host_now() + 5.0; host_now() < end; sleep_until(host_now() + 0.01)) {
      robot->command({{v, 0.0}, {}});
      if (speed < before - 0.01) return host_now() - 0.01 / 0.3;
    }
    return Stamp::never();
  }

  /// Whether it becomes so within some seconds.
  template <class Law>
  static bool soon(const Law& law, double seconds = 5.0) {
    for (const Stamp end = host_now() + seconds; host_now() < end; sleep_until(host_now() + 0.01))
      if (law()) return true;
    return law();
  }

  test::TempFolder folder;
  BlackBox box;
  ArcosEmulator arcos{ArcosEmulatorSettings{}};
  LevellingEmulator unit{LevellingEmulatorSettings{}};
  DeviceServer base_server{"tcp:127.0.0.1:0", arcos, 1};
  DeviceServer unit_server{"tcp:127.0.0.1:0", unit, 2};
  ToldScanner scanner;
  mrpt::math::TPose2D pose;    ///< the world's own, while it turns
  std::atomic<double> x{0.0};  ///< of the pose, for who looks on [m]
  std::atomic<double> speed{0.0};
  std::atomic<double> pushed{0.0};      ///< so fast whatever its motors do [m/s]
  std::atomic<double> tilt{0.0};        ///< that its platform feels [rad]
  LaserAim aim;                         ///< of the core
  std::atomic<double> worst_wake{0.0};  ///< so late this machine was at most [s]
  std::atomic<bool> scans{true}, reports{true};
  std::atomic<bool> ending{false};
  std::unique_ptr<RealRobot> robot;
  std::thread world;
};

TEST(RealRobot, MergesWhatArrivesAndDrives) {
  Bench bench;
  const std::vector<Inputs> all = bench.drive(0.3, 3.0);
  std::size_t scans = 0, odometry = 0, accelerations = 0;
  Stamp last = Stamp::never();
  for (const Inputs& inputs : all) {
    EXPECT_GT(inputs.now, last);
    last = inputs.now;
    scans += inputs.scans.size();
    odometry += inputs.odometry.size();
    accelerations += inputs.accelerations.size();
    for (const LaserScan& s : inputs.scans) EXPECT_LE(s.stamp, inputs.now);
    for (const Odometry& o : inputs.odometry) EXPECT_LE(o.stamp, inputs.now);
    for (const Acceleration& a : inputs.accelerations) EXPECT_LE(a.stamp, inputs.now);
  }
  EXPECT_GT(scans, 5u);
  EXPECT_GT(odometry, 5u);
  EXPECT_GT(accelerations, 20u);
  EXPECT_TRUE(bench.robot->status().motors_on);
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0 || bench.x > 0.1; }));
}

TEST(RealRobot, ARobotThatIsHeldFromTheStartIsLeftWhenTheTimeIsOver) {
  RealRobotSettings settings;
  settings.time_limit = 1.0;
  settings.safety.start = 1.0;
  Bench bench(settings);
  bench.base_server.with([&] { bench.arcos.fail(DeviceFault::Button, host_now()); });
  bool held = false;
  const Stamp most = host_now() + 20.0;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    held = held || status.held;
    return host_now() < most;
  });
  EXPECT_FALSE(bench.robot->read());
  EXPECT_TRUE(held);
  EXPECT_LT(host_now(), most) << "nothing but the operator ended it";
  EXPECT_EQ(bench.x, 0.0);
}

TEST(RealRobot, MotorsStayOffUntilAllReport) {
  Bench bench;
  bench.scans = false;
  int asked = 0;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    EXPECT_FALSE(status.motors_on);
    EXPECT_FALSE(status.silent.empty());
    return ++asked < 30;
  });
  EXPECT_FALSE(bench.robot->read()) << "the wait was ended";
  EXPECT_EQ(bench.x, 0.0);
  bench.base_server.with([&] { EXPECT_FALSE(bench.arcos.motors_on()); });
}

TEST(RealRobot, ASilentScannerStopsIt) {
  Bench bench;
  bench.drive(0.3, 3.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  bench.scans = false;
  std::thread core([&] { bench.drive(0.3, 2.0); });
  // The core commands on: it is the scanner's silence that stops the robot.
  bench.worst_wake = 0.0;
  const Stamp braked = bench.braked_though_commanded(0.3);
  EXPECT_NE(braked, Stamp::never()) << "it drives on blindly";
  if (braked != Stamp::never()) {
    EXPECT_LT(braked - bench.scanner.status().last_scan, 0.3 + 0.15 + 2.0 * bench.worst_wake);
  }
  EXPECT_TRUE(Bench::soon([&] {
    bench.robot->command({{0.3, 0.0}, {}});
    return bench.speed == 0.0;
  }));
  bench.scans = true;
  core.join();
}

/// What was late once, on the way in, is not why a scanner is silent now.
TEST(RealRobot, AScannerThatFallsSilentIsNotCalledHeldUpForWhatWasLateLongAgo) {
  Bench bench;
  std::vector<std::string> named;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    return true;
  });
  bench.drive(0.0, 1.0);
  bench.scanner.latency = 0.45;  // held up, not too old
  bench.drive(0.0, 0.5);
  for (const bool just_now : {true, false}) {
    SCOPED_TRACE(just_now);
    bench.scanner.latency = 0.005;
    bench.drive(0.0, just_now ? 0.3 : 5.0);
    named.clear();
    bench.scans = false;
    std::thread again([&] {
      sleep_until(host_now() + 1.0);
      bench.scans = true;
    });
    bench.drive(0.0, 1.2);
    again.join();
    EXPECT_THAT(named, testing::Contains(testing::StartsWith("urg: silent for")));
    const auto held_up = testing::Contains(testing::HasSubstr("holds scans up"));
    if (just_now) {
      EXPECT_THAT(named, held_up);
    } else {
      EXPECT_THAT(named, testing::Not(held_up));
    }
  }
}

TEST(RealRobot, ScansThatComeLateStopItThoughTheyNeverCease) {
  Bench bench;
  bench.drive(0.3, 3.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  std::vector<std::string> named;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    return true;
  });
  bench.scanner.latency = 2.0;
  std::thread core([&] { bench.drive(0.3, 4.0); });
  bench.worst_wake = 0.0;
  const Stamp late = host_now(), braked = bench.braked_though_commanded(0.3);
  EXPECT_NE(braked, Stamp::never()) << "it is not the core's silence that must stop it";
  if (braked != Stamp::never()) {
    EXPECT_LT(braked - late, 0.1 + 0.15 + 2.0 * bench.worst_wake) << "from the first late scan on";
  }
  EXPECT_TRUE(Bench::soon([&] {
    bench.robot->command({{0.3, 0.0}, {}});
    return bench.speed == 0.0;
  })) << "it drives by what it saw two seconds ago";
  bench.scanner.latency = 0.005;
  core.join();
  EXPECT_THAT(named, testing::Contains(testing::StartsWith("urg: its scans are 2.")));
  bench.drive(0.3, 1.0);
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; })) << "it goes on when they are fresh again";
}

/// A line at the edge of what is fresh enough must not make the robot jerk ten times a second.
TEST(RealRobot, ScansAtTheEdgeOfTooOldStopItOnce) {
  Bench bench;
  bench.drive(0.3, 2.0);
  int stops = 0;
  bool waiting = false;
  std::vector<std::string> named;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const std::string& line : lines_of(status.silent))
      // A machine that stalls makes the scanner silent, which is another matter.
      if (line.rfind("urg: its scans", 0) == 0 && !waiting) {
        ++stops;
        waiting = true;
        named.push_back(line);
      }
    return true;
  });
  bench.scanner.latency = SafetySettings{}.lidar_age - 0.05;  // too old in the second half of the wait for the next one
  const Stamp edge = host_now();
  std::thread fresh([&] {
    sleep_until(edge + 3.0);
    bench.scanner.latency = 0.005;
  });
  while (host_now() < edge + 6.0) {
    const auto inputs = bench.robot->read();
    if (!inputs) break;
    waiting = false;
    bench.robot->command({{0.3, 0.0}, {}});
  }
  fresh.join();
  EXPECT_EQ(stops, 1);
  ASSERT_FALSE(named.empty());
  for (const std::string& line : named) {
    double age = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "urg: its scans are %lf s old", &age), 1) << line;
    EXPECT_GE(age, 0.6);
  }
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; })) << "it goes on when they are fresh again";
}

/// Who waited until the other program ends would drive the robot on when that one has stopped it.
TEST(RealRobot, ARobotThatAnotherProgramDrivesIsNotWaitedFor) {
  Bench bench;
  bench.drive(0.3, 1.0);
  RealRobotSettings settings;
  settings.base_port = bench.base_server.port();
  settings.levelling_port = bench.unit_server.port();
  ToldScanner scanner;
  RealRobot second(settings, scanner, nullptr);
  const Stamp begun = host_now();
  try {
    second.read();
    FAIL() << "it drives a robot that is driven";
  } catch (const DeviceLost& lost) {
    // Whichever was tried first.
    EXPECT_THAT(lost.what(), testing::AnyOf(testing::HasSubstr("base: " + settings.base_port + ": another program"),
                                            testing::HasSubstr("levelling: " + settings.levelling_port + ": another")));
  }
  EXPECT_LT(host_now() - begun, 0.5 * settings.safety.start) << "it waited";
  bench.drive(0.3, 1.0);
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; })) << "the first one drives on";
}

/// A serial server (as ser2net): one connection to the device; while it is busy with another computer's, whoever comes
/// is told so, in its own words or in none, and hung up on.
class SerialServer {
 public:
  SerialServer(std::string device, std::string words) : device_(std::move(device)), words_(std::move(words)) {
    relay_ = std::thread([this] { relay(); });
  }
  ~SerialServer() {
    ending_ = true;
    relay_.join();
  }
  std::string port() const { return "tcp:127.0.0.1:" + std::to_string(number_); }

  std::atomic<bool> busy{false};
  std::atomic<int> refused{0};

 private:
  static Descriptor listening(int& number) {
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(socket.get(), 4);
    ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
    number = ntohs(address.sin_port);
    return socket;
  }

  void relay() {
    Descriptor client;
    std::unique_ptr<Port> device;
    std::uint8_t bytes[4096];
    for (; !ending_; sleep_until(host_now() + 0.002)) {
      Descriptor next(::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (busy) client.close(), device.reset();
      if (next && (busy || client)) {
        if (!words_.empty()) ::send(next.get(), words_.data(), words_.size(), MSG_NOSIGNAL);
        ++refused;
        continue;
      }
      if (next) client = std::move(next), device = open_port(device_);
      if (!client) continue;
      const ssize_t said = ::read(client.get(), bytes, sizeof bytes);
      if (said > 0) device->write(bytes, static_cast<std::size_t>(said), host_now());
      if (said == 0) {
        client.close(), device.reset();
        continue;
      }
      const Arrival heard = device->read(bytes, sizeof bytes, 0.0);
      if (heard.size > 0) ::send(client.get(), bytes, heard.size, MSG_NOSIGNAL);
    }
  }

  std::string device_, words_;
  int number_ = 0;
  Descriptor socket_ = listening(number_);
  std::atomic<bool> ending_{false};
  std::thread relay_;
};

class InUse : public testing::TestWithParam<std::string> {
 protected:
  InUse() { settings_.base_port = server_.port(); }
  bool motors_on() {
    bool on = false;
    bench_.base_server.with([&] { on = bench_.arcos.motors_on(); });
    return on;
  }

  Bench bench_;
  SerialServer server_{release(bench_), GetParam()};
  RealRobotSettings settings_;

 private:
  static std::string release(Bench& bench) {
    bench.robot.reset();
    return bench.base_server.port();
  }
};

/// It may be there a little later, but then somebody may have stopped it.
TEST_P(InUse, ItIsWaitedForButNotDrivenOnWhenItIsLetGo) {
  server_.busy = true;
  settings_.levelling_port = bench_.unit_server.port();
  bench_.robot = std::make_unique<RealRobot>(settings_, bench_.scanner, nullptr);
  bool told = false, motors_came_on = false;
  const Stamp begun = host_now();
  bench_.robot->while_waiting([&](const RobotStatus& status) {
    for (const std::string& line : lines_of(status.silent))
      told = told || line.find("another program uses the device") != std::string::npos;
    if (told && server_.refused > 8 && host_now() - begun > 2.0) server_.busy = false;
    motors_came_on = motors_came_on || motors_on();
    return true;
  });
  try {
    bench_.robot->read();
    ADD_FAILURE() << "it drives the robot on";
  } catch (const DeviceLost& lost) {
    EXPECT_THAT(lost.what(), testing::StartsWith("base: hung up at first"));
    EXPECT_THAT(lost.what(), testing::HasSubstr("start again"));
  }
  EXPECT_TRUE(told);
  EXPECT_FALSE(motors_came_on || motors_on());
}

TEST_P(InUse, ABaseThatNeverLetsUsInEndsTheWait) {
  server_.busy = true;
  settings_.levelling_port = bench_.unit_server.port();
  settings_.safety.start = 2.0;
  bench_.robot = std::make_unique<RealRobot>(settings_, bench_.scanner, nullptr);
  try {
    bench_.robot->read();
    ADD_FAILURE() << "it drives a robot that is in use";
  } catch (const DeviceLost& lost) {
    EXPECT_THAT(lost.what(), testing::HasSubstr("the other side hangs up at once; another program uses the device"));
  }
}

/// The one who took it while its line was away may have stopped it.
TEST_P(InUse, ABaseThatSomebodyTookOnTheWayIsHeldForTheOperator) {
  settings_.levelling_port = bench_.unit_server.port();
  bench_.robot = std::make_unique<RealRobot>(settings_, bench_.scanner, nullptr);
  bench_.drive(0.3, 3.0);
  ASSERT_TRUE(Bench::soon([&] { return bench_.speed > 0.0; }));
  std::atomic<bool> rearm{false};
  std::atomic<bool> held{false}, taken{false};
  bench_.robot->while_waiting([&](const RobotStatus& status) {
    held = status.held;
    taken = taken || status.taken;
    if (rearm.exchange(false)) bench_.robot->rearm();
    return true;
  });
  const int refused = server_.refused;
  server_.busy = true;
  std::thread core([&] { bench_.drive(0.3, 12.0); });
  EXPECT_TRUE(Bench::soon([&] { return server_.refused > refused + 1 && bench_.speed == 0.0; }));
  server_.busy = false;
  EXPECT_TRUE(Bench::soon([&] {
    bool open = false;
    bench_.base_server.with([&] { open = bench_.arcos.open(); });
    return open && held && taken;
  }));
  bool drove = false;
  for (const Stamp end = host_now() + 2.0; host_now() < end; sleep_until(host_now() + 0.01))
    drove = drove || motors_on() || bench_.speed != 0.0;
  EXPECT_FALSE(drove) << "it drives on without being asked to";
  rearm = true;
  EXPECT_TRUE(Bench::soon([&] { return bench_.speed > 0.0; })) << "the operator lets it go";
  core.join();
}

INSTANTIATE_TEST_SUITE_P(RealRobot, InUse, testing::Values("", "Port already in use\r\n"),
                         [](const auto& info) { return info.param.empty() ? "WithoutAWord" : "WithAWord"; });

/// A mapper may be busy for most of a second; whoever drives by hand is heard all the same.
TEST(RealRobot, TheHandIsHeardWhileTheCoreIsBusy) {
  RealRobotSettings settings;
  settings.safety.core_silence = 10.0;  // the core is as good as gone
  Bench bench(settings);
  std::atomic<double> wanted{0.3};
  bench.robot->steer_by_hand([&] { return Drive{wanted, 0.0}; });
  bench.drive(0.3, 2.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  wanted = 0.0;
  EXPECT_TRUE(Bench::soon([&] { return bench.speed == 0.0; })) << "braking waits for the core";
  wanted = -0.2;
  EXPECT_TRUE(Bench::soon([&] { return bench.speed < 0.0; }));
  const auto inputs = bench.robot->read();
  ASSERT_TRUE(inputs);
  ASSERT_TRUE(inputs->command);
  EXPECT_EQ(inputs->command->drive.v, -0.2) << "what the log says was in force";
}

/// Nor on a base that hears and tells nothing: what it does nobody knows.
TEST(RealRobot, TheHandDrivesNoBaseThatIsSilent) {
  RealRobotSettings settings;
  settings.safety.base_answer = 30.0;
  Bench bench(settings);
  bench.robot->steer_by_hand([] { return Drive{0.3, 0.0}; });
  bench.drive(0.3, 2.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  bench.reports = false;
  std::thread core([&] { bench.drive(0.3, 4.0); });
  EXPECT_TRUE(Bench::soon([&] { return bench.speed == 0.0; }, 2.5));
  bool drove = false;
  for (const Stamp end = host_now() + 1.5; host_now() < end; sleep_until(host_now() + 0.01))
    drove = drove || bench.speed != 0.0;
  EXPECT_FALSE(drove);
  bench.reports = true;
  core.join();
}

TEST(RealRobot, TheTimeIsOverAlsoWhileADeviceIsWaitedFor) {
  RealRobotSettings settings;
  settings.time_limit = 1.5;
  Bench bench(settings);
  bench.drive(0.1, 0.5);
  bench.scans = false;
  EXPECT_NO_THROW(bench.drive(0.1, 8.0)) << "give_up is longer";
  EXPECT_FALSE(bench.robot->read());
}

TEST(RealRobot, ASilentCoreStopsIt) {
  RealRobotSettings settings;
  settings.safety.core_silence = 0.3;
  Bench bench(settings);
  bench.drive(0.3, 3.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  EXPECT_TRUE(Bench::soon([&] { return bench.speed == 0.0; })) << "nobody commands any more";
}

TEST(RealRobot, AnUnpluggedBaseIsNamedAndPickedUpAgain) {
  Bench bench;
  bench.drive(0.1, 2.0);
  std::vector<std::string> named;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    return true;
  });
  bench.base_server.unplug(2.0);
  bench.drive(0.1, 6.0);
  EXPECT_THAT(named, testing::Contains(testing::StartsWith("base: ")));
  EXPECT_TRUE(bench.robot->status().silent.empty());
  EXPECT_TRUE(Bench::soon([&] { return bench.robot->status().motors_on; }));
}

TEST(RealRobot, AnEmergencyStopEndsTheRun) {
  Bench bench;
  bench.drive(0.3, 2.0);
  bench.robot->emergency_stop();
  EXPECT_TRUE(Bench::soon([&] { return bench.speed == 0.0; }));
  EXPECT_FALSE(bench.robot->read());
  EXPECT_TRUE(bench.robot->status().emergency);
}

TEST(RealRobot, TheButtonAtTheRobotHoldsItUntilTheOperatorRearmsIt) {
  Bench bench;
  bench.drive(0.3, 2.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  std::vector<std::string> named;
  std::atomic<bool> rearm{false};
  bool motors_came_on = false;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    if (rearm) bench.robot->rearm();
    bench.base_server.with([&] { motors_came_on = motors_came_on || (bench.arcos.motors_on() && !rearm); });
    return true;
  });
  std::thread core([&] { bench.drive(0.3, 12.0); });
  bench.base_server.with([&] { bench.arcos.fail(DeviceFault::Button, host_now()); });
  EXPECT_TRUE(Bench::soon([&] { return bench.robot->status().held && bench.speed == 0.0; }));
  sleep_until(host_now() + 3.0);  // the button is released after 2 s
  EXPECT_TRUE(bench.robot->status().held);
  EXPECT_EQ(bench.speed, 0.0);
  rearm = true;
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  core.join();
  EXPECT_FALSE(motors_came_on);
  EXPECT_THAT(named, testing::Contains("base: emergency button pressed"));
}

/// While the core waits only the wheels know where the robot is pushed to.
TEST(RealRobot, WhereAHeldRobotIsPushedToIsTold) {
  Bench bench;
  bench.drive(0.3, 2.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  std::vector<std::string> named;
  double farthest = 0.0;
  const Stamp end = host_now() + 6.0;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    farthest = std::max(farthest, status.unread.x);
    return host_now() < end;
  });
  bench.base_server.with([&] { bench.arcos.fail(DeviceFault::Button, host_now()); });
  while (!bench.robot->status().held) sleep_until(host_now() + 0.01);
  bench.pushed = 0.2;
  bench.drive(0.3, 6.0);
  EXPECT_GT(farthest, 0.5);
  EXPECT_THAT(named, testing::Contains(testing::HasSubstr("base: moves though it is held")));
}

TEST(RealRobot, ABatteryThatIsEmptyHoldsItUntilTheOperatorTakesItOnHimself) {
  Bench bench;
  bench.drive(0.3, 1.0);
  bench.base_server.with([&] { bench.arcos.set_battery(11.2); });
  const auto troubles = [&] {
    std::string all;
    for (const Hindrance& one : bench.robot->status().troubles) all += one.line();
    return all;
  };
  std::size_t told = 0;
  double volts = 0.0;
  for (const Inputs& inputs : bench.drive(0.1, BatteryWatch::kLasts + 2.0)) {
    told += inputs.battery ? 1 : 0;
    if (inputs.battery) volts = inputs.battery->volts;
  }
  EXPECT_GE(told, 10u) << "each second";
  EXPECT_LE(told, 13u);
  EXPECT_NEAR(volts, 11.2, 1e-9);
  EXPECT_THAT(troubles(), testing::HasSubstr("its battery is low: 11.2 V"));
  EXPECT_FALSE(bench.robot->status().held);
  bench.base_server.with([&] { bench.arcos.set_battery(10.8); });
  std::vector<std::string> named;
  Stamp rearm = Stamp::never();
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    if (status.held && rearm == Stamp::never()) rearm = host_now() + 2.0;
    if (host_now() > rearm) {
      EXPECT_EQ(bench.speed, 0.0);
      EXPECT_TRUE(bench.robot->rearm());
    }
    return true;
  });
  bench.drive(0.1, BatteryWatch::kLasts + 6.0);
  EXPECT_THAT(named, testing::Contains(testing::HasSubstr("base: its battery is empty: 10.8 V")));
  EXPECT_GT(bench.speed, 0.0) << "the operator let it go";
}

/// Its servo turns the other way than the robot file says.
TEST(RealRobot, AnAimThatMakesTheTiltLargerHoldsItAndIsLeftOffAfterwards) {
  Bench bench;
  bench.drive(0.1, 1.0);
  bench.tilt = 0.3;
  std::vector<std::string> named;
  Stamp rearm = Stamp::never();
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    if (status.held && rearm == Stamp::never()) rearm = host_now() + 1.0;
    if (host_now() > rearm) bench.robot->rearm();
    return true;
  });
  bench.aim = {-0.4, 0.0};
  bench.drive(0.1, 6.0);
  EXPECT_THAT(named, testing::Contains(testing::HasSubstr("levelling: ")));
  EXPECT_GT(bench.speed, 0.0);
  LaserAim aim;
  bench.unit_server.with([&] { aim = bench.unit.aim(); });
  EXPECT_NEAR(aim.pitch, 0.0, 0.01) << "it is not levelled any more";
  EXPECT_THAT(bench.robot->status().troubles.front().line(), testing::HasSubstr("levelling: off"));
}

/// Drives on by `v` for so long; what it was waiting for.
std::vector<std::string> named_while_driving(Bench& bench, double v, double seconds) {
  std::vector<std::string> named;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    return true;
  });
  bench.drive(v, seconds);
  bench.robot->while_waiting({});
  return named;
}

/// Its reports come as ever, only late.
TEST(RealRobot, ASlowLineToTheBaseIsNamedAndNotDrivenOn) {
  Bench bench;
  EXPECT_THAT(named_while_driving(bench, 0.3, 3.0),
              testing::Not(testing::Contains(testing::HasSubstr("late (at most"))));
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  bench.base_server.slow_down(7.5);
  const Stamp slow = host_now();
  std::vector<std::string> named;
  std::thread core([&] { named = named_while_driving(bench, 0.3, 6.0); });
  bench.worst_wake = 0.0;
  const Stamp braked = bench.braked_though_commanded(0.3);
  EXPECT_NE(braked, Stamp::never()) << "it drives on, though a stop would come a second late";
  if (braked != Stamp::never()) {
    EXPECT_LT(braked - slow, 2.5 + DeviceServer::kSlowWay + 2.0 * bench.worst_wake);
  }
  core.join();
  EXPECT_THAT(named,
              testing::Contains(testing::AllOf(testing::StartsWith("base: "), testing::HasSubstr("late (at most"))));
  EXPECT_EQ(bench.speed, 0.0);
  bench.drive(0.3, 6.0);
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; })) << "it goes on when the line is quick again";
}

/// Its reports come as ever, only late: the laser would swing. The way is shorter than what counts as silence, so that
/// no gap is taken for it: a unit that is asked anew tells how late it is only seconds later.
TEST(RealRobot, ASlowLineToTheLevellingUnitIsNamedAndNotDrivenOn) {
  Bench bench;
  bench.drive(0.3, 3.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  bench.unit_server.slow_down(60.0, 0.3);
  const auto is_late = testing::AllOf(testing::StartsWith("levelling: "), testing::HasSubstr("late (at most 0.25 s)"));
  std::vector<std::string> named;
  Stamp told = Stamp::never();
  bool rests = false;
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    if (told == Stamp::never() && testing::Value(named, testing::Contains(is_late))) told = host_now();
    // From 0.3 m/s the base runs down its ramp within a second.
    if (told == Stamp::never() || host_now() - told < 2.0) return true;
    rests = rests || bench.speed == 0.0;
    bench.unit_server.slow_down(0.0);
    return true;
  });
  bench.drive(0.3, 8.0);
  bench.robot->while_waiting({});
  EXPECT_THAT(named, testing::Contains(is_late));
  EXPECT_TRUE(rests) << "it drives on";
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; })) << "it goes on when the line is quick again";
}

TEST(RealRobot, ABaseThatDoesNotHearIsNamed) {
  Bench bench;
  bench.drive(0.3, 3.0);
  bench.base_server.with([&] { bench.arcos.fail(DeviceFault::Watchdog, host_now()); });
  EXPECT_THAT(named_while_driving(bench, 0.3, 3.0),
              testing::Contains(testing::StartsWith("base: reports, but has not")));
  EXPECT_THAT(named_while_driving(bench, 0.3, 5.0),
              testing::Not(testing::Contains(testing::HasSubstr("late (at most"))))
      << "the line is quick";
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; })) << "it goes on when it hears again";
}

TEST(RealRobot, WheelsThatStandThoughToldToDriveAreATrouble) {
  Bench bench;
  bench.drive(0.3, 3.0);
  EXPECT_TRUE(bench.robot->status().troubles.empty());
  bench.base_server.with([&] { bench.arcos.fail(DeviceFault::Stuck, host_now()); });
  std::thread core([&] { bench.drive(0.3, 8.0); });
  EXPECT_TRUE(Bench::soon([&] {
    const auto troubles = bench.robot->status().troubles;
    return troubles.size() == 1 && troubles[0].line().rfind("base: reports, but does not obey", 0) == 0;
  }));
  EXPECT_TRUE(Bench::soon([&] { return bench.robot->status().troubles.empty(); })) << "it obeys again";
  core.join();
}

/// It answers, reports, and does not stop.
TEST(RealRobot, ABaseThatMovesThoughToldOtherwiseIsSwitchedOffAndHeld) {
  Bench bench;
  bench.drive(0.3, 3.0);
  ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  std::vector<std::string> named;
  std::atomic<bool> rearm{false};
  bench.robot->while_waiting([&](const RobotStatus& status) {
    for (const Hindrance& one : status.silent) named.push_back(one.line());
    if (rearm) bench.robot->rearm();
    return true;
  });
  bench.base_server.with([&] { bench.arcos.fail(DeviceFault::Runaway, host_now()); });
  std::atomic<double> v{0.0};
  std::atomic<bool> done{false};
  std::thread core([&] {
    for (const Stamp end = host_now() + 20.0; !done && host_now() < end;) {
      if (!bench.robot->read()) break;
      bench.robot->command({{v, 0.0}, {}});
    }
  });
  const Stamp told = host_now();
  EXPECT_TRUE(Bench::soon([&] { return bench.robot->status().held && bench.speed == 0.0; }));
  EXPECT_LT(host_now() - told, 4.0);
  bench.base_server.with([&] { EXPECT_FALSE(bench.arcos.motors_on()); });
  v = 0.3;
  sleep_until(host_now() + 2.0);
  EXPECT_TRUE(bench.robot->status().held) << "somebody must see to it";
  EXPECT_EQ(bench.speed, 0.0);
  rearm = true;
  EXPECT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
  const auto doubts = bench.robot->status().troubles;
  ASSERT_EQ(doubts.size(), 1u) << "that it moves does not show yet that it obeys";
  EXPECT_STREQ(over(doubts[0].cause), "obeys again");
  EXPECT_TRUE(Bench::soon([&] { return bench.robot->status().troubles.empty(); }));
  done = true;
  core.join();
  EXPECT_THAT(named, testing::Contains(testing::HasSubstr("motors are being switched off")));
}

TEST(RealRobot, AMissingBaseIsNotTakenForTheScanner) {
  RealRobotSettings settings;
  settings.base_port = "pty:/nonexistent/base";
  settings.heartbeat = "/nonexistent/beat";
  Bench bench(settings);
  EXPECT_TRUE(Bench::soon([&] { return bench.scanner.status().scans > 3; }));
  std::vector<std::string> named = lines_of(bench.robot->status().silent);
  EXPECT_THAT(named, testing::Contains(testing::StartsWith("base: ")));
  EXPECT_THAT(named, testing::Not(testing::Contains(testing::StartsWith("urg: "))));
}

TEST(RealRobot, TheOperatorIsHeardWhileTheCoreIsBusy) {
  for (const OperatorWish wish : {OperatorWish::Stop, OperatorWish::EmergencyStop}) {
    RealRobotSettings settings;
    settings.safety.core_silence = 60.0;  // so the core's silence is not what stops it
    Bench bench(settings);
    bench.drive(0.3, 2.0);
    ASSERT_TRUE(Bench::soon([&] { return bench.speed > 0.0; }));
    bench.robot->listen([wish] { return wish; });
    EXPECT_TRUE(Bench::soon([&] {
      bool on = true;
      bench.base_server.with([&] { on = bench.arcos.motors_on(); });
      return !on && bench.speed == 0.0;
    }));
    bench.robot->listen({});
  }
}

TEST(RealRobot, WhoLeavesAtOnceSaysTheFarewellFirst) {
  RealRobotSettings settings;
  settings.safety.core_silence = 60.0;
  Bench bench(settings);
  bench.drive(0.3, 2.0);
  std::atomic<int> left{0};
  bench.robot->listen([] { return OperatorWish::Leave; }, [&] { ++left; });
  EXPECT_TRUE(Bench::soon([&] { return left == 1; }));
  EXPECT_TRUE(Bench::soon([&] {
    bool open = true;
    bench.base_server.with([&] { open = bench.arcos.open() || bench.arcos.motors_on(); });
    return !open && bench.speed == 0.0;
  }));
}

TEST(RealRobot, ItsEndLeavesTheBaseAtRest) {
  Bench bench;
  bench.drive(0.3, 2.0);
  bench.robot.reset();
  EXPECT_TRUE(Bench::soon([&] {
    bool open = true;
    bench.base_server.with([&] { open = bench.arcos.open(); });
    return !open;
  }));
  EXPECT_TRUE(Bench::soon([&] { return bench.speed == 0.0; }));
}

class BlackBoxOf : public testing::TestWithParam<int> {};

/// Also of a base whose stamps lie ahead of the computer's clock.
TEST_P(BlackBoxOf, ARealRobotGivesTheDriversTheSameAgain) {
  RealRobotSettings settings;
  settings.base.delay = -1e-3 * GetParam();
  Bench bench(settings);
  std::vector<Odometry> odometry;
  for (const Inputs& inputs : bench.drive(0.2, 3.0)) {
    for (const Odometry& o : inputs.odometry) EXPECT_LE(o.stamp, inputs.now);
    odometry.insert(odometry.end(), inputs.odometry.begin(), inputs.odometry.end());
  }
  ASSERT_GT(odometry.size(), 20u);
  for (std::size_t i = 1; i < odometry.size(); ++i) EXPECT_GT(odometry[i].stamp, odometry[i - 1].stamp);
  bench.robot.reset();
  ASSERT_FALSE(bench.box.failed());
  const ReplayedBox replayed =
      replay_black_box(read_black_box(bench.folder / "devices.bytes"), "arcos", settings.base, {});
  ASSERT_GE(replayed.odometry.size(), odometry.size());
  EXPECT_GT(replayed.accelerations.size(), 50u);
  std::size_t found = 0;
  for (const Odometry& then : odometry)
    for (const Odometry& now : replayed.odometry)
      if (now.stamp == then.stamp && now.pose.x == then.pose.x && now.v == then.v) ++found;
  EXPECT_EQ(found, odometry.size());
}

INSTANTIATE_TEST_SUITE_P(RealRobot, BlackBoxOf, testing::Values(0, 5, 30),
                         [](const auto& info) { return std::to_string(info.param) + "_ms_ahead"; });

TEST(Heartbeat, AFileMustBeTouchedAgain) {
  test::TempFolder folder;
  Heartbeat heartbeat(folder / "alive");
  const Stamp start{1'000'000'000};
  EXPECT_EQ(heartbeat.last(start), Stamp::never()) << "no file yet";
  std::ofstream(folder / "alive") << "a";
  EXPECT_EQ(heartbeat.last(start + 1.0), Stamp::never()) << "it may be an old file";
  fs::last_write_time(folder / "alive", fs::file_time_type::clock::now() + std::chrono::seconds(3));
  EXPECT_EQ(heartbeat.last(start + 2.0), start + 2.0);
  EXPECT_EQ(heartbeat.last(start + 5.0), start + 2.0);
  EXPECT_EQ(Heartbeat("").last(start), start) << "nobody is asked for";
}

TEST(Heartbeat, AFullPipeIsNotEmptiedAtOnce) {
  test::TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "beat").c_str(), 0600), 0);
  Heartbeat heartbeat(folder / "beat");
  const Stamp start{1'000'000'000};
  EXPECT_EQ(heartbeat.last(start), Stamp::never());
  const Descriptor writer(::open((folder / "beat").c_str(), O_WRONLY | O_NONBLOCK));
  const std::string much(32768, 'x');
  ASSERT_EQ(::write(writer.get(), much.data(), much.size()), static_cast<ssize_t>(much.size()));
  EXPECT_EQ(heartbeat.last(start + 1.0), start + 1.0);
  int waiting = 0;
  ASSERT_EQ(::ioctl(writer.get(), FIONREAD, &waiting), 0);
  EXPECT_GT(waiting, 0) << "a writer without pause would keep the reader for ever";
}

TEST(BlackBox, ADeviceThatSendsWithoutEndIsNamedAndDoesNotFillTheDisk) {
  test::TempFolder folder;
  std::string word, why;
  Stamp begun = host_now();
  {
    Descriptor server(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(server.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(server.get(), 4), 0);
    ASSERT_EQ(::getsockname(server.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    word = "tcp:127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    BlackBox box(folder / "flood");
    for (int connection = 0; connection < 3; ++connection) {
      const std::unique_ptr<Port> port = open_recorded(word, "base", &box);
      Descriptor flood(::accept4(server.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      const std::string much(65536, 'x');
      std::vector<std::uint8_t> bytes(65536);
      why.clear();
      try {
        for (int i = 0; i < 2000; ++i) {
          [[maybe_unused]] const ssize_t sent = ::send(flood.get(), much.data(), much.size(), MSG_NOSIGNAL);
          port->read(bytes.data(), bytes.size(), 0.001);
        }
      } catch (const DeviceLost& lost) {
        why = lost.what();
      }
      EXPECT_THAT(why, testing::AllOf(testing::StartsWith(word), testing::HasSubstr("more than 1 MB/s"),
                                      testing::HasSubstr("'base'")));
    }
    EXPECT_FALSE(box.failed());
  }
  // Over all its connections.
  EXPECT_LT(static_cast<double>(fs::file_size(folder / "flood")), 2.2e6 + 1.1e6 * (host_now() - begun));
}

/// A pipe that nobody reads is the slowest of all disks.
TEST(BlackBox, NobodyWaitsForASlowDisk) {
  test::TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "slow").c_str(), 0600), 0);
  const Descriptor reader(::open((folder / "slow").c_str(), O_RDONLY | O_NONBLOCK));
  std::string read;
  const std::string block(1000, 'x');
  std::atomic<bool> added{false};
  std::thread late;
  {
    BlackBox box(folder / "slow");
    late = std::thread([&] {
      EXPECT_TRUE(Bench::soon([&] { return added.load(); }, 30.0)) << "add() waits for the disk";
      char bytes[4096];
      for (const Stamp end = host_now() + 30.0; host_now() < end;) {
        const ssize_t got = ::read(reader.get(), bytes, sizeof bytes);
        if (got == 0) break;
        if (got > 0) read.append(bytes, static_cast<std::size_t>(got));
      }
    });
    for (int i = 0; i < 1000; ++i) box.add("base", Direction::FromDevice, block, {i});
    added = true;
    EXPECT_FALSE(box.failed());
  }
  late.join();
  std::ofstream(folder / "copy", std::ios::binary) << read;
  const auto whole = read_black_box(folder / "copy");
  ASSERT_EQ(whole.size(), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(whole[static_cast<std::size_t>(i)].stamp.ns, i);
}

TEST(BlackBox, SaysWhyItIsNotWhole) {
  test::TempFolder folder;
  if (fs::exists("/dev/full")) {
    const int full = ::open("/dev/full", O_WRONLY);
    fs::create_symlink("/dev/full", folder / "full");
    ::close(full);
    EXPECT_THROW(BlackBox box(folder / "full"), std::exception) << "it is said at once";
  }
  BlackBox box(folder / "flooded");
  box.add("base", Direction::FromDevice, "x", {1});
  EXPECT_EQ(box.failure(), "");
  EXPECT_TRUE(box.cut_short().empty());
  EXPECT_FALSE(box.admits("base", 3'000'000, Stamp{1}));
  EXPECT_TRUE(box.admits("urg", 3000, Stamp{1}));
  EXPECT_EQ(box.failure(), "") << "what is left out on purpose is no fault of the disk";
  EXPECT_THAT(box.cut_short(), testing::ElementsAre("base"));
}

TEST(BlackBox, WhatADiskNeverTakesDoesNotFillTheMemory) {
  test::TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "stuck").c_str(), 0600), 0);
  Descriptor reader(::open((folder / "stuck").c_str(), O_RDONLY | O_NONBLOCK));
  const auto handler = std::signal(SIGPIPE, SIG_IGN);
  {
    BlackBox box(folder / "stuck");
    const std::string block(1u << 20, 'x');
    for (std::size_t i = 0; i < 2 * BlackBox::kMostWaiting / block.size(); ++i)
      box.add("base", Direction::FromDevice, block, {});
    reader.close();  // the disk is gone for good
    EXPECT_TRUE(box.failed());
    EXPECT_THAT(box.failure(), testing::Not(testing::HasSubstr("free some space")));
  }
  std::signal(SIGPIPE, handler);
}

TEST(BlackBox, ATornEndIsDroppedAndOtherFilesAreRefused) {
  test::TempFolder folder;
  {
    BlackBox box(folder / "a");
    box.add("base", Direction::FromDevice, "hello", {5});
    box.add("urg", Direction::ToDevice, std::string("\0x", 2), {6});
  }
  const auto whole = read_black_box(folder / "a");
  ASSERT_EQ(whole.size(), 2u);
  EXPECT_EQ(whole[0].bytes, "hello");
  EXPECT_EQ(whole[1].device, "urg");
  EXPECT_EQ(whole[1].bytes, std::string("\0x", 2));
  for (auto size = fs::file_size(folder / "a") - 1; size > 40; --size) {
    fs::resize_file(folder / "a", size);
    EXPECT_EQ(read_black_box(folder / "a").size(), 1u) << size;
  }
  std::ofstream(folder / "b") << "something else";
  EXPECT_THROW(read_black_box(folder / "b"), InputError);
}

TEST(BlackBox, TimesThatNoDriveHasAreDamage) {
  test::TempFolder folder;
  const auto with_times = [&](const std::vector<std::int64_t>& times) {
    {
      BlackBox box(folder / "a");
      for (const std::int64_t ns : times) box.add("base", Direction::FromDevice, "x", {ns});
    }
    return read_black_box(folder / "a").size();
  };
  const std::int64_t day = 86'400'000'000'000, start = 20'000 * day, second = 1'000'000'000;
  EXPECT_EQ(with_times({}), 0u);
  EXPECT_EQ(with_times({start, start + day, start + day - 9 * second, start + 29 * day}), 4u);
  EXPECT_THROW(with_times({start, start + 31 * day}), InputError) << "once walked through in steps of 20 ms";
  EXPECT_THROW(with_times({start, start + day, start}), InputError) << "the walk begins anew each time";
  EXPECT_THROW(with_times({start, -1}), InputError);
  EXPECT_THROW(with_times({std::numeric_limits<std::int64_t>::min(), 0}), InputError);
  EXPECT_THROW(with_times({0, std::numeric_limits<std::int64_t>::max()}), InputError);
}

}  // namespace
}  // namespace rubble::robot
