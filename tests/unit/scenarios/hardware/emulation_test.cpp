// The emulated base over its port, in real time: what a client is told of its limits is what it gets. Judged by the
// simulator's own track, so that a busy machine delays but does not decide.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <sstream>
#include <thread>

#include "robot/drivers/host_clock.h"
#include "robot/drivers/port.h"
#include "robot/protocols/arcos_commands.h"
#include "robot/protocols/arcos_packet.h"
#include "robot/protocols/arcos_reports.h"
#include "scenarios/hardware/emulation.h"
#include "tests/support/source_dir.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using namespace robot::arcos;

/// `rubble emulate` with a base in a flat room, and a client that says what it likes.
class EmulatedBase {
 public:
  explicit EmulatedBase(double max_v) {
    std::string name = (fs::temp_directory_path() / "emulationXXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    Scenario scenario;
    scenario.arena_file = std::string(RUBBLE_SOURCE_DIR) + "/arenas/shipped/flat_room.yaml";
    scenario.robot.max_v = max_v;
    EmulateOptions options;
    options.base = "tcp:127.0.0.1:0";
    options.truth = truth_file();
    std::promise<std::string> word;
    options.ready = [&](const std::vector<std::string>& ports) { word.set_value(ports.front().substr(5)); };
    options.interrupted = [this] { return ending_.load(); };
    options.warn = [this](const std::string& line) { warned.push_back(line); };
    auto opened = word.get_future();
    thread_ = std::thread([scenario, options] { emulate(scenario, options); });
    port_ = robot::open_port(opened.get());
    for (const Command number : {kSync0, kSync1, kSync2}) say(command(number), 0.15);
    say(command(kOpen, 1), 0.05);
    say(command(kConfig, 1), 0.5);
  }
  ~EmulatedBase() {
    end();
    fs::remove_all(folder_);
  }
  void end() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }

  /// Sends and listens for so long; the pulse goes on.
  void say(const std::string& packet, double seconds) {
    const Stamp end = robot::host_now() + seconds;
    send(packet);
    for (Stamp pulse = robot::host_now(); robot::host_now() < end;) {
      std::array<std::uint8_t, 1024> bytes;
      const auto [size, now] = port_->read(bytes.data(), bytes.size(), 0.02);
      parser_.feed({reinterpret_cast<const char*>(bytes.data()), size});
      while (const auto payload = parser_.next())
        if (const auto configuration = parse_configuration(*payload)) told = *configuration;
      if (now - pulse < 0.5) continue;
      pulse = now;
      send(command(kPulse));
    }
  }

  /// Speed and its change in the track, over 0.1 s each.
  struct Track {
    double fastest = 0.0, hardest = 0.0;
  };
  Track track() {
    end();
    std::ifstream in(truth_file());
    std::vector<std::array<double, 3>> rows;
    for (std::string line; std::getline(in, line);) {
      std::array<double, 3> row{};
      if (std::istringstream(line) >> row[0] >> row[1] >> row[2]) rows.push_back(row);
    }
    Track track;
    double before = 0.0;
    constexpr std::size_t kSpan = 10;
    for (std::size_t i = kSpan; i < rows.size(); i += kSpan) {
      const auto& [t0, x0, y0] = rows[i - kSpan];
      const auto& [t1, x1, y1] = rows[i];
      const double v = std::hypot(x1 - x0, y1 - y0) / (t1 - t0);
      track.fastest = std::max(track.fastest, v);
      track.hardest = std::max(track.hardest, (before - v) / (t1 - t0));
      before = v;
    }
    return track;
  }

  /// Where the robot is at the end.
  mrpt::math::TPoint2D place() {
    end();
    std::ifstream in(truth_file());
    double t = 0.0, x = 0.0, y = 0.0;
    for (std::string line; std::getline(in, line);) std::istringstream(line) >> t >> x >> y;
    return {x, y};
  }

  Configuration told;
  std::vector<std::string> warned;  ///< to be read after end()

 private:
  std::string truth_file() const { return (folder_ / "truth.tum").string(); }
  void send(const std::string& packet) {
    port_->write(reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size(), robot::host_now());
  }

  fs::path folder_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
  std::unique_ptr<robot::Port> port_;
  PacketParser parser_;
};

struct Stop {
  const char* name;
  std::string packet;
  bool hard;
};

class EmulatedStop : public testing::TestWithParam<Stop> {};

TEST_P(EmulatedStop, IsAsHardAsItShallBe) {
  EmulatedBase base(0.5);
  base.say(command(kEnable, 1), 0.1);
  base.say(command(kVelocity, 500), 2.0);
  base.say(GetParam().packet, 0.8);
  const EmulatedBase::Track track = base.track();
  ASSERT_GT(track.fastest, 0.4);
  if (GetParam().hard) {
    EXPECT_GT(track.hardest, 1.5) << "[m/s^2]";
  } else {
    EXPECT_LT(track.hardest, 0.6) << "[m/s^2]";
  }
}

INSTANTIATE_TEST_SUITE_P(All, EmulatedStop,
                         testing::Values(Stop{"Stop", command(kStop), false},
                                         Stop{"EmergencyStop", command(kEmergencyStop), true},
                                         Stop{"MotorsOff", command(kEnable, 0), true}),
                         [](const auto& info) { return info.param.name; });

TEST(EmulatedBase, ItsConfigurationTellsTheLimitsThatHold) {
  EmulatedBase base(0.4);
  EXPECT_EQ(base.told.top_speed, 400);
  EXPECT_EQ(base.told.max_speed, 400);
  EXPECT_EQ(base.told.top_accel, 300);
  EXPECT_EQ(base.told.top_turn_rate, 100);
  EXPECT_EQ(base.told.top_turn_accel, 100);
  base.say(command(kEnable, 1), 0.1);
  base.say(command(kSetSpeed, 1200), 0.02);
  base.say(command(kSetAcceleration, 2000), 0.02);
  base.say(command(kVelocity, 1000), 2.2);
  const EmulatedBase::Track track = base.track();
  EXPECT_NEAR(track.fastest, 1e-3 * base.told.top_speed, 0.03);
}

TEST(EmulatedBase, ThePoseCanBeSetOnTheFloorOnlyAndWhoAsksForAnotherIsTold) {
  EmulatedBase base(0.4);
  base.say(sim_set_pose(1500, 600, 0), 0.2);
  base.say(sim_set_pose(900'000, 0, 0), 0.2);
  const mrpt::math::TPoint2D place = base.place();
  EXPECT_NEAR(place.x, 1.5, 0.01);
  EXPECT_NEAR(place.y, 0.6, 0.01);
  ASSERT_EQ(base.warned.size(), 1u);
  EXPECT_NE(base.warned[0].find("x 900.00"), std::string::npos) << base.warned[0];
}

}  // namespace
}  // namespace rubble::scenarios
