// A drive whose base does something else than it is told: what is told of it, on the way and at the end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "robot/drivers/host_clock.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/device_server.h"
#include "scenarios/hardware/drive.h"
#include "scenarios/hardware/emulation.h"
#include "tests/support/base_files.h"
#include "tests/support/source_dir.h"

namespace rubble::scenarios {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// An emulated Pioneer that may hear nothing, or say nothing.
class ListenedTo : public robot::EmulatedDevice {
 public:
  void client_came(Stamp now) override { base.client_came(now); }
  void client_left(Stamp now) override { base.client_left(now); }
  void receive(std::string_view bytes, Stamp now) override {
    heard.append(bytes);
    if (!deaf) base.receive(bytes, now);
  }
  void advance(Stamp now) override { base.advance(now); }
  std::string take_output() override {
    const std::string said = base.take_output();
    return mute ? "" : said;
  }

  robot::ArcosEmulator base{robot::ArcosEmulatorSettings{}};
  std::string heard;  ///< all that ever came
  bool deaf = false, mute = false;
};

/// A port that nobody listens at, and no other test drives with: two programs may not use one device.
std::string left_port() {
  ListenedTo nobody;
  return robot::DeviceServer("tcp:127.0.0.1:0", nobody, 1).port();
}

/// Scanner and base of a robot in a flat room, which is driven by hand; it has no levelling unit. The scanner stands
/// still whatever the wheels do.
class EmulatedDrive {
 public:
  explicit EmulatedDrive(bool with_scanner = true) {
    if (with_scanner) start_scanner();
    world_ = std::thread([this] { turn(); });
    options.mode = DriveMode::Teleoperate;
    options.out = folder_ / "drive";
    options.keys = [] { return robot::Drive{0.2, 0.0}; };
    options.interrupted = [this] { return ending.load() || robot::host_now() > latest_; };
    options.tell = [this](const std::string& line) {
      const std::lock_guard<std::mutex> lock(mutex_);
      told_.push_back(line);
      told_at_.push_back(robot::host_now());
    };
    options.each_second = [this](const DriveStatus& status) {
      state = status.state;
      if (each_second) each_second(status);
    };
  }
  ~EmulatedDrive() {
    closing_ = true;
    world_.join();
    if (scanner_.joinable()) scanner_.join();
  }

  RunReport run() {
    RobotFile file = load_robot_file(std::string(RUBBLE_SOURCE_DIR) + "/robots/pioneer_urg.yaml",
                                     {{"devices.urg.port", urg_},
                                      {"devices.base.port", server.port()},
                                      {"devices.levelling.driver", "none"},
                                      {"safety.start_s", "6"}});
    return drive(file, options);
  }
  /// The same in a thread of its own.
  std::future<RunReport> start() {
    return std::async(std::launch::async, [this] { return run(); });
  }
  std::vector<std::string> told() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return told_;
  }
  /// When a line with this was told first; never: it was not.
  Stamp told_at(const std::string& part) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < told_.size(); ++i)
      if (told_[i].find(part) != std::string::npos) return told_at_[i];
    return Stamp::never();
  }
  bool comes_true(const std::function<bool()>& law, double seconds = 30.0) const {
    for (const Stamp end = robot::host_now() + seconds; robot::host_now() < end;) {
      if (law()) return true;
      robot::sleep_until(robot::host_now() + 0.02);
    }
    return law();
  }
  bool drives() {
    return comes_true([this] { return speed > 0.1; });
  }

  ListenedTo device;
  robot::DeviceServer server{"tcp:127.0.0.1:0", device, 1};
  DriveOptions options;
  std::function<void(const DriveStatus&)> each_second;
  std::string state;  ///< as it was shown last; to be read after the drive
  std::atomic<bool> ending{false};
  std::atomic<double> speed{0.0};
  std::atomic<double> driven_by_others{0.0};  ///< the wheels go so fast whatever they are told, if not 0 [m/s]

 private:
  void start_scanner() {
    Scenario scenario;
    scenario.arena_file = std::string(RUBBLE_SOURCE_DIR) + "/arenas/shipped/flat_room.yaml";
    EmulateOptions emulated;
    emulated.urg = "tcp:127.0.0.1:0";
    std::promise<std::string> word;
    emulated.ready = [&](const std::vector<std::string>& ports) { word.set_value(ports.front().substr(4)); };
    emulated.interrupted = [this] { return closing_.load(); };
    auto opened = word.get_future();
    scanner_ = std::thread([scenario, emulated] { emulate(scenario, emulated); });
    urg_ = opened.get();
  }
  void turn() {
    mrpt::math::TPose2D pose;
    const Stamp start = robot::host_now();
    for (int i = 0; !closing_; ++i) {
      const Stamp now = start + 0.01 * i;
      robot::sleep_until(now);
      robot::Drive motion;
      server.with([&] { motion = device.base.motion(); });
      if (driven_by_others != 0.0) motion = {driven_by_others, 0.0};
      pose.phi += motion.w * 0.01;
      pose.x += motion.v * std::cos(pose.phi) * 0.01;
      pose.y += motion.v * std::sin(pose.phi) * 0.01;
      speed = motion.v;
      if (i % 10 == 0) server.with([&] { device.base.measure({now, pose, motion.v, motion.w, false}, now); });
    }
  }

  test::TempFolder folder_;
  std::string urg_ = left_port();  // nobody is there
  const Stamp latest_ = robot::host_now() + 90.0;
  std::atomic<bool> closing_{false};
  mutable std::mutex mutex_;
  std::vector<std::string> told_;
  std::vector<Stamp> told_at_;
  std::thread scanner_, world_;
};

std::size_t count(const std::vector<std::string>& lines, const std::string& part) {
  return static_cast<std::size_t>(std::count_if(
      lines.begin(), lines.end(), [&](const auto& line) { return line.find(part) != std::string::npos; }));
}

/// Its report of motors off comes late, but it comes.
TEST(EmulatedDriveEnds, ABaseBehindALateLineThatStoppedIsNotCalledUntold) {
  EmulatedDrive robot;
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot.server.slow_down(30.0);
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "s late") > 0; }));
  robot.ending = true;
  driven.get();
  EXPECT_THAT(robot.told(), Not(Contains(HasSubstr("has not told that it stopped"))));
  EXPECT_THAT(robot.told(), Not(Contains(HasSubstr("motors stay on"))));
}

TEST(EmulatedDriveEnds, AnErrorThatLeavesTheDriveStopsTheBaseAndSaysWhatItDoes) {
  for (const bool deaf : {true, false}) {
    SCOPED_TRACE(deaf);
    EmulatedDrive robot;
    robot.each_second = [&](const DriveStatus&) {
      if (robot.speed < 0.1) return;
      robot.server.with([&] { robot.device.deaf = deaf; });
      throw RunError("the disk is full");
    };
    EXPECT_THROW(robot.run(), RunError);
    EXPECT_EQ(count(robot.told(), "motors stay on though switched off"), deaf ? 1u : 0u);
    EXPECT_THAT(robot.told(), Not(Contains(HasSubstr("has not told"))));
  }
}

/// Nothing was wrong up to then; that nobody knows whether it stands is a device that was lost.
TEST(EmulatedDriveEnds, ABaseThatIsSilentAtTheVeryEndIsAFailureAndTheMapIsSaved) {
  for (const bool silent : {true, false}) {
    EmulatedDrive robot;
    std::atomic<bool> over{false};
    robot.options.mode = DriveMode::Calibrate;
    robot.options.pilot = [&](const robot::Inputs&, const mrpt::math::TPose2D&) -> std::optional<robot::Drive> {
      if (!over) return robot::Drive{0.0, 0.0};
      if (silent) robot.server.with([&] { robot.device.mute = robot.device.deaf = true; });
      return std::nullopt;
    };
    auto driven = robot.start();
    robot.comes_true([&] { return count(robot.told(), "base: reports") > 0; });
    robot::sleep_until(robot::host_now() + 3.0);
    over = true;
    const RunReport report = driven.get();
    EXPECT_EQ(report.failure, silent ? "base: has not told that it stopped; see that it stands" : "");
    EXPECT_EQ(count(robot.told(), "has not told"), 0u) << "the end of the program says it";
    EXPECT_FALSE(report.interrupted);
    EXPECT_TRUE(std::filesystem::exists(report.folder + "/map.tif"));
    EXPECT_FALSE(std::filesystem::exists(report.folder + "/.partial"));
  }
}

/// Its last line comes right behind another, and when nothing is read any more.
TEST(EmulatedDriveEnds, TheLastLineOfStateTellsTheRatesOfTheDrive) {
  EmulatedDrive robot;
  double scans = 0.0, odometry = 0.0;
  robot.each_second = [&](const DriveStatus& status) {
    scans = status.scans_per_s;
    odometry = status.odometry_per_s;
  };
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot::sleep_until(robot::host_now() + 3.1);
  robot.ending = true;
  driven.get();
  EXPECT_NEAR(scans, 10.0, 2.0);
  EXPECT_NEAR(odometry, 10.0, 2.0);
}

TEST(EmulatedDriveEnds, WheelsThatTurnThoughTheMotorsAreOffAreTold) {
  EmulatedDrive robot;
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot.driven_by_others = 0.2;  // down a slope
  robot.ending = true;
  driven.get();
  EXPECT_THAT(robot.told(), Contains(HasSubstr("its motors are off, but its wheels turn")));
}

/// The second Ctrl-C, while the end waits for a base that does not obey.
TEST(EmulatedDriveEnds, WhoInsistsLeavesAtOnceAlsoWhileTheBaseIsWaitedFor) {
  EmulatedDrive robot;
  std::atomic<bool> left{false};
  std::atomic<int> asked{0};  // since the first one: fifty times a second, so the drive itself is over by then
  robot.options.insisted = [&] { return robot.ending && ++asked > 20; };
  robot.options.left = [&] { left = true; };
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot.server.with([&] { robot.device.deaf = true; });
  robot.ending = true;
  driven.get();
  EXPECT_TRUE(left);
}

TEST(EmulatedDriveEnds, ABaseThatWasNeverReachedIsNotAskedWhetherItStands) {
  EmulatedDrive robot;
  robot.server.with([&] { robot.device.mute = true; });
  const RunReport report = robot.run();
  EXPECT_THAT(report.failure, HasSubstr("base: has not reported yet"));
  EXPECT_THAT(robot.told(), Not(Contains(HasSubstr("stopped; see that it stands"))));
}

/// It has reported, so it is where it belongs: to be asked who it is would open it anew, or take it from who has it.
TEST(EmulatedDriveThatNeverBegins, ABaseThatFellSilentIsNotAskedWhoItIs) {
  EmulatedDrive robot(false);
  auto driven = robot.start();
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "base: reports") > 0; }));
  robot.server.with([&] { robot.device.mute = true; });
  const RunReport report = driven.get();
  EXPECT_THAT(report.failure, HasSubstr("urg: has not reported yet"));
  EXPECT_THAT(report.failure, HasSubstr("base: "));
  std::string heard;
  robot.server.with([&] { heard = robot.device.heard; });
  EXPECT_EQ(heard.find("QT\n"), std::string::npos) << "it was asked whether it is a scanner";
  EXPECT_EQ(heard.find("$V"), std::string::npos) << "it was asked whether it is a levelling unit";
}

/// Something else was told of it just before.
TEST(EmulatedDriveThatNeverBegins, ABaseThatMovesIsNamedAtOnceAndTheEndDoesNotSendToTheCables) {
  EmulatedDrive robot;
  robot.driven_by_others = 0.25;
  robot.server.with([&] { robot.device.mute = true; });
  auto driven = robot.start();
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "base: has not reported yet") > 0; }));
  robot.server.with([&] { robot.device.mute = false; });
  const RunReport report = driven.get();
  EXPECT_NE(robot.told_at("moves though nobody here drives it"), Stamp::never());
  EXPECT_THAT(report.failure, HasSubstr("see who moves it"));
  EXPECT_THAT(report.failure, Not(HasSubstr("cables")));
}

TEST(EmulatedDriveThatNeverBegins, ABaseThatMovesWhenTheOperatorEndsItIsToldToGoOn) {
  EmulatedDrive robot(false);
  robot.driven_by_others = 0.25;
  auto driven = robot.start();
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "moves though nobody here drives it") > 0; }))
      << testing::PrintToString(robot.told());
  robot.ending = true;
  driven.get();
  EXPECT_THAT(robot.told().back(), HasSubstr("base: moves though nobody here has driven it, and may go on"));
}

TEST(EmulatedDriveThatIsHeld, WhereItIsPushedToShows) {
  EmulatedDrive robot;
  std::vector<double> places;  // while it is held
  robot.each_second = [&](const DriveStatus& status) {
    if (status.state == "held") places.push_back(status.T_map_base.x);
  };
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot.server.with([&] { robot.device.base.fail(robot::DeviceFault::Button, robot::host_now()); });
  robot.driven_by_others = 0.2;
  EXPECT_TRUE(robot.comes_true([&] { return count(robot.told(), "base: moves though it is held") > 0; }));
  robot::sleep_until(robot::host_now() + 3.0);
  robot.ending = true;
  driven.get();
  ASSERT_GE(places.size(), 3u);
  EXPECT_GT(places.back() - places.front(), 0.2);
}

/// Something else is said of it meanwhile, and is over again.
TEST(EmulatedDriveThatIsHeld, ThatItIsWatchedIsToldOnce) {
  EmulatedDrive robot;
  std::atomic<bool> rearm{false};
  robot.options.rearm = [&] { return rearm.exchange(false); };
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot.driven_by_others = -0.25;
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "base: held") > 0; }));
  robot.driven_by_others = 0.001;  // it stands
  robot::sleep_until(robot::host_now() + 1.5);
  rearm = true;
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "let go again") > 0; }))
      << testing::PrintToString(robot.told());
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "reports, but does not obey") > 0; }));
  robot.driven_by_others = 0.0;
  robot.comes_true([&] { return count(robot.told(), "obeys again") > 0; }, 8.0);
  robot.ending = true;
  driven.get();
  EXPECT_EQ(count(robot.told(), "let go again"), 1u) << testing::PrintToString(robot.told());
  EXPECT_EQ(count(robot.told(), "is let go"), 0u) << "the same said twice: " << testing::PrintToString(robot.told());
}

TEST(EmulatedDriveThatIsHeld, EachReasonIsToldOnceAndTheStateIsHeldToTheEnd) {
  EmulatedDrive robot;
  auto driven = robot.start();
  ASSERT_TRUE(robot.drives());
  robot.driven_by_others = -0.25;
  robot.server.with([&] { robot.device.deaf = true; });
  ASSERT_TRUE(robot.comes_true([&] { return count(robot.told(), "is left to its watchdog") > 0; }));
  robot.ending = true;
  driven.get();
  EXPECT_EQ(count(robot.told(), "does not obey: moves"), 1u);
  EXPECT_EQ(count(robot.told(), "is left to its watchdog"), 1u);
  EXPECT_EQ(robot.state, "held");
  EXPECT_THAT(robot.told().back(), HasSubstr("motors stay on though switched off")) << "the end says what it knows";
}

}  // namespace
}  // namespace rubble::scenarios
