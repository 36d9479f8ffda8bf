#include "scenarios/hardware/calibrate.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "base/angle.h"
#include "base/error.h"
#include "robot/drivers/pioneer.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/hardware_units.h"
#include "robot/logs/log.h"
#include "scenarios/run/run.h"
#include "tests/support/sim_arena.h"
#include "tests/support/source_dir.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

arenas::Arena furnished_room() {
  arenas::Arena arena = sim::test::room(-1.5, -1.5, 2.5, 2.5);
  sim::test::add_wall(arena, 1.9, -0.6, 2.3, -0.2);
  sim::test::add_wall(arena, -1.2, 1.8, -0.7, 2.2);
  return arena;
}

/// A folder that goes away again.
class Scratch {
 public:
  Scratch() : path_((fs::temp_directory_path() / "rubble-calibrate-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) throw std::runtime_error("no temporary folder");
  }
  ~Scratch() { fs::remove_all(path_); }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

struct Driven {
  std::string trouble;
  double reckoned = 0.0;  ///< turn by the wheels, to and fro [rad]
  double turned = 0.0;    ///< in truth [rad]
  double lag = 0.0;       ///< of the body behind its wheels [s]
};

/// How late the true heading follows that of the wheels: the body of the simulated robot does so by half a step of the
/// physics, which the scanner sees as a delay of its own. By least squares, truth = a wheels - lag rate + b.
class Lag {
 public:
  void add(double wheels, double truth, double rate) {
    const Eigen::Vector3d row(wheels, -rate, 1.0);
    N_ += row * row.transpose();
    b_ += truth * row;
  }
  double value() const { return N_.ldlt().solve(b_)[1]; }

 private:
  Eigen::Matrix3d N_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b_ = Eigen::Vector3d::Zero();
};

/// Lets the pilot drive a simulated robot, recorded as `rubble calibrate` does.
Driven drive_simulated(const arenas::Arena& arena, const robot::RobotModel& model, std::uint64_t seed,
                       const std::string& log) {
  sim::SimRobot robot(arena, model, {}, seed);
  robot::RecordingRobot recorded(robot, log, "");
  CalibrationDrive pilot(model, {});
  Driven driven;
  std::optional<mrpt::math::TPose2D> last;
  std::optional<mrpt::math::TPose2D> last_truth;
  Lag lag;
  double wheels = 0.0;
  double heading = 0.0;
  while (auto inputs = recorded.read()) {
    const mrpt::math::TPose2D truth = robot.truth().back().pose;
    if (last_truth) driven.turned += std::abs(wrap_angle(truth.phi - last_truth->phi));
    if (last_truth) heading += wrap_angle(truth.phi - last_truth->phi);
    last_truth = truth;
    for (const robot::Odometry& odometry : inputs->odometry) {
      if (last) driven.reckoned += std::abs(wrap_angle(odometry.pose.phi - last->phi));
      if (last) wheels += wrap_angle(odometry.pose.phi - last->phi);
      last = odometry.pose;
      if (odometry.stamp == robot.truth().back().stamp) lag.add(wheels, heading, odometry.w);
    }
    const auto wanted = pilot.next(*inputs, truth.phi);
    if (!wanted) break;
    recorded.command({*wanted, {}});
  }
  driven.trouble = pilot.trouble();
  driven.lag = lag.value();
  return driven;
}

struct TrueZero {
  double pitch = 0.0, roll = 0.0;  ///< [rad]
};

/// What the simulated part, calibrated with an error of its own (0.11 deg, one sigma), shows on a level floor: the mean
/// over two minutes at rest, in which the noise goes down to a thousandth of a degree.
TrueZero true_zero(const robot::RobotModel& model, std::uint64_t seed) {
  sim::SimRobot robot(sim::test::flat_floor(-2.0, -2.0, 2.0, 2.0), model, {}, seed);
  double x = 0.0, y = 0.0, count = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const auto inputs = robot.read();
    for (const robot::Acceleration& a : inputs->accelerations) {
      x += a.x;
      y += a.y;
      count += 1.0;
    }
  }
  return {std::asin(x / count / robot::kGravity), std::asin(y / count / robot::kGravity)};
}

RobotFile shipped() { return load_robot_file(std::string(RUBBLE_SOURCE_DIR) + "/robots/pioneer_urg.yaml"); }

TEST(Calibrate, ASimulatedRobotsTrueNumbersComeBack) {
  const Scratch scratch;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RobotFile file = shipped();
    robot::RobotModel model = file.settings.robot;
    model.effective_track = seed == 1 ? 0.55 : 0.62;  // what this robot's firmware divides by
    const std::string log = scratch.file(std::to_string(seed) + ".rlog");
    const Driven driven = drive_simulated(furnished_room(), model, seed, log);
    ASSERT_EQ(driven.trouble, "");

    // The file does not know that track; the log was recorded by a robot that does.
    const CalibratedRobot robot = calibrate_from_log(log, file, file);
    const double track = model.effective_track * driven.reckoned / driven.turned;
    std::cout << "seed " << seed << ": effective track " << robot.effective_track << " +- "
              << robot.effective_track_sigma << ", true " << track << "; laser x " << robot.setup.T_base_laser.x
              << " y " << robot.setup.T_base_laser.y << " yaw " << rad_to_deg(robot.setup.T_base_laser.phi)
              << " deg, delay " << 1e3 * robot.setup.delay << " ms, true lag " << 1e3 * driven.lag << " ms\n";
    EXPECT_NEAR(robot.effective_track / track, 1.0, 0.01);
    EXPECT_NEAR(robot.setup.distance_scale, 1.0, 0.01);
    EXPECT_NEAR(robot.setup.T_base_laser.x, model.T_base_laser.x, 0.005);
    EXPECT_NEAR(robot.setup.T_base_laser.y, 0.0, 0.005);
    EXPECT_NEAR(rad_to_deg(robot.setup.T_base_laser.phi), 0.0, 0.3);
    EXPECT_NEAR(robot.setup.delay, driven.lag, 0.002);
    EXPECT_NEAR(driven.lag, 0.0, 0.007);
    ASSERT_TRUE(robot.calibration.level);
    const TrueZero zero = true_zero(model, seed);
    EXPECT_NEAR(rad_to_deg(robot.calibration.level->pitch - zero.pitch), 0.0, 0.2);
    EXPECT_NEAR(rad_to_deg(robot.calibration.level->roll - zero.roll), 0.0, 0.2);
    EXPECT_NEAR(rad_to_deg(robot.calibration.level->slope), 0.0, 0.1);
  }
}

/// Drives that were not made for it: arcs, in which wheels slip sideways, must not shift the laser unsaid. Of forty
/// numbers whose sigmas are true one is beyond three of them in every tenth set of drives, two in every 200th, one
/// beyond four in every 400th; their squares sum to 40, to 60 and more in every 50th.
TEST(Calibrate, TheLasersPlaceFromAnExploringDriveIsAsUncertainAsItSays) {
  constexpr int kDrives = 20;
  const Scratch scratch;
  const RobotFile file = shipped();
  int within = 0, beyond = 0, numbers = 0;
  double squares = 0.0;
  for (int seed = 1; seed <= kDrives; ++seed) {
    Scenario scenario =
        load_scenario(std::string(RUBBLE_SOURCE_DIR) + "/scenarios/yellow.yaml", {{"arena.generate.columns", "3"},
                                                                                  {"arena.generate.rows", "3"},
                                                                                  {"explorer.return_home", "false"},
                                                                                  {"seed", std::to_string(seed)},
                                                                                  {"time_limit_s", "120"}});
    RunOptions options;
    options.out = scratch.file("run" + std::to_string(seed));
    run_scenario(scenario, options);
    const CalibratedRobot robot = calibrate_from_log(options.out + "/log.rlog", file, file);
    const mrpt::math::TPose2D& found = robot.setup.T_base_laser;
    const mrpt::math::TPose2D& sigma = robot.calibration.sigma.T_base_laser;
    const double x = found.x - scenario.robot.T_base_laser.x, y = found.y - scenario.robot.T_base_laser.y;
    std::cout << "seed " << seed << ": x " << 1e3 * x << " +- " << 1e3 * sigma.x << " mm, y " << 1e3 * y << " +- "
              << 1e3 * sigma.y << " mm\n";
    for (const double off : {std::abs(x) / sigma.x, std::abs(y) / sigma.y}) {
      EXPECT_LE(off, 4.0) << seed;
      beyond += off > 3.0 ? 1 : 0;
      within += off <= 1.0 ? 1 : 0;
      squares += off * off;
      ++numbers;
    }
  }
  std::cout << within << " of " << numbers << " within one sigma, " << beyond << " beyond three, mean square "
            << squares / numbers << "\n";
  EXPECT_LE(beyond, 1);
  EXPECT_LE(squares, 1.5 * numbers);
  EXPECT_GE(2 * within, numbers);
}

/// The simulated robot behind its emulated firmware, as our driver sees it: all in one thread, without lines or clocks.
class DrivenByWire : public robot::Robot {
 public:
  /// `model`: what the robot is; `said`: what its file takes it for.
  DrivenByWire(const arenas::Arena& arena, const robot::RobotModel& model, const robot::RobotModel& said,
               const robot::BaseSettings& base, std::uint64_t seed)
      : said_(said), simulated_(arena, model, {}, seed), firmware_(settings(model)), driver_(base) {
    firmware_.client_came({});
    driver_.opened({}, robot::LineKind::Tcp);
    robot::Inputs inputs;
    for (int i = 0; i < 250 && !driver_.motors_on(); ++i) {
      driver_.enable(true);
      inputs = *read();
    }
  }
  const robot::RobotModel& model() const override { return said_; }
  std::optional<robot::Inputs> read() override {
    for (int i = 0; i < 4; ++i) talk(now_ + 0.005 * i);
    simulated_.command({firmware_.motion(), {}});
    auto inputs = simulated_.read();
    if (!inputs) return std::nullopt;
    now_ = inputs->now;
    for (const robot::Odometry& odometry : inputs->odometry) {
      firmware_.measure(odometry, odometry.stamp);
      talk(odometry.stamp);
    }
    inputs->odometry = driver_.take_odometry();
    return inputs;
  }
  void command(const robot::Commands& commands) override { driver_.drive(commands.drive); }
  const Trajectory& truth() const { return simulated_.truth(); }

 private:
  static robot::ArcosEmulatorSettings settings(const robot::RobotModel& model) {
    robot::ArcosEmulatorSettings settings;
    settings.half_track = 0.5 * model.effective_track;
    return settings;
  }
  void talk(Stamp now) {
    driver_.advance(now);
    firmware_.receive(driver_.take_output(now), now);
    firmware_.advance(now);
    driver_.receive(firmware_.take_output(), now);
  }

  robot::RobotModel said_;
  sim::SimRobot simulated_;
  robot::ArcosEmulator firmware_;
  robot::Pioneer driver_;
  Stamp now_;
};

TEST(Calibrate, TheEffectiveTrackIsFoundThoughTheFirmwareDividesByAnother) {
  const Scratch scratch;
  RobotFile file = shipped();
  for (const double firmware_track : {0.5, 0.65}) {
    robot::RobotModel model = file.settings.robot;
    ASSERT_GT(std::abs(model.effective_track / firmware_track - 1.0), 0.09) << "the file says another";
    model.effective_track = firmware_track;
    const std::string log = scratch.file("wire.rlog");
    double wheels = 0.0, turned = 0.0;
    {
      DrivenByWire robot(furnished_room(), model, file.settings.robot, file.robot.base, 7);
      robot::RecordingRobot recorded(robot, log, "");
      CalibrationDrive pilot(file.settings.robot, {});
      std::optional<mrpt::math::TPose2D> last, last_truth;
      while (auto inputs = recorded.read()) {
        const mrpt::math::TPose2D truth = robot.truth().back().pose;
        if (last_truth) turned += std::abs(wrap_angle(truth.phi - last_truth->phi));
        last_truth = truth;
        for (const robot::Odometry& odometry : inputs->odometry) {
          if (last) wheels += firmware_track * std::abs(wrap_angle(odometry.pose.phi - last->phi));
          last = odometry.pose;
        }
        const auto wanted = pilot.next(*inputs, truth.phi);
        if (!wanted) break;
        recorded.command({*wanted, {}});
      }
      ASSERT_EQ(pilot.trouble(), "");
    }
    const CalibratedRobot robot = calibrate_from_log(log, file, file);
    std::cout << "firmware track " << firmware_track << " m: effective track " << robot.effective_track << " +- "
              << robot.effective_track_sigma << ", true " << wheels / turned << "\n";
    EXPECT_NEAR(robot.effective_track / (wheels / turned), 1.0, 0.01);
    EXPECT_NEAR(robot.file.settings.robot.effective_track / firmware_track, 1.0, 0.005)
        << "what the firmware divides by";
  }
}

TEST(Calibrate, WithoutWheelSpeedsTheEffectiveTrackIsNotGuessed) {
  const Scratch scratch;
  const std::string log = scratch.file("log.rlog");
  RobotFile file = shipped();
  ASSERT_EQ(drive_simulated(furnished_room(), file.settings.robot, 4, log).trouble, "");
  RobotFile own = file;
  own.robot.base_driver = "own";
  const CalibratedRobot robot = calibrate_from_log(log, own, own);
  EXPECT_TRUE(std::isnan(robot.effective_track));
  EXPECT_NE(calibrated_yaml(robot, log).find("effective track: not known"), std::string::npos);
  EXPECT_EQ(robot.file.settings.robot.effective_track, file.settings.robot.effective_track);
}

TEST(Calibrate, TheFileIsReadBackWithTheNumbersOfTheDriveAppliedToThoseInForce) {
  const Scratch scratch;
  const std::string log = scratch.file("log.rlog");
  RobotFile file = shipped();
  ASSERT_EQ(drive_simulated(furnished_room(), file.settings.robot, 4, log).trouble, "");
  RobotFile in_force = file;  // the same drive, had it been recorded under these numbers
  in_force.robot.base.distance_scale = 1.1;
  in_force.robot.base.turn_scale = 0.9;
  in_force.lidar.delay = 0.02;
  in_force.robot.levelling.x.zero = 0.52;
  in_force.robot.levelling.x.sensitivity = 0.12;
  const CalibratedRobot plain = calibrate_from_log(log, file, file);
  const CalibratedRobot robot = calibrate_from_log(log, in_force, file);
  EXPECT_NEAR(robot.setup.distance_scale, 1.1 * plain.setup.distance_scale, 1e-9);
  EXPECT_NEAR(robot.setup.turn_scale, 0.9 * plain.setup.turn_scale, 1e-9);
  EXPECT_NEAR(robot.setup.delay, 0.02 + plain.setup.delay, 1e-9);

  const std::string path = scratch.file("calibrated.yaml");
  std::ofstream(path) << calibrated_yaml(robot, log);
  std::ifstream written(path);  // no digits that no drive can tell
  std::size_t numbers = 0;
  for (std::string line; std::getline(written, line);)
    for (const char* key : {"distance_scale:", "turn_scale:", "x_m:", "y_m:", "yaw_deg:", "zero_duty:", "delay_s:"})
      if (line.find(key) != std::string::npos) {
        const std::size_t point = line.find('.');
        EXPECT_LE(point == std::string::npos ? 0U : line.size() - point - 1, 6U) << line;
        ++numbers;
      }
  EXPECT_GE(numbers, 7U) << "a key is not written";
  const RobotFile back = load_robot_file(path);
  EXPECT_NEAR(back.robot.base.distance_scale, robot.setup.distance_scale, 1e-6);
  EXPECT_NEAR(back.robot.base.turn_scale, robot.setup.turn_scale, 1e-6);
  EXPECT_NEAR(back.lidar.delay, robot.setup.delay, 1e-6);
  EXPECT_NEAR(back.settings.robot.T_base_laser.x, robot.setup.T_base_laser.x, 1e-6);
  EXPECT_NEAR(back.settings.robot.T_base_laser.y, robot.setup.T_base_laser.y, 1e-6);
  EXPECT_NEAR(back.settings.robot.T_base_laser.yaw, robot.setup.T_base_laser.phi, 1e-6);
  EXPECT_NEAR(back.robot.model.T_base_laser.yaw, robot.setup.T_base_laser.phi, 1e-6);
  EXPECT_NEAR(back.robot.levelling.x.zero, 0.52 + 0.12 * std::sin(robot.calibration.level->pitch), 1e-6);
  EXPECT_EQ(back.robot.base_port, file.robot.base_port);
}

TEST(CalibrationDrive, AWallInTheWayEndsItBeforeItIsTouched) {
  const Scratch scratch;
  arenas::Arena arena = sim::test::room(-1.5, -1.5, 2.5, 2.5);
  sim::test::add_wall(arena, 0.8, -1.0, 0.9, 1.0);
  const RobotFile file = shipped();
  const Driven driven = drive_simulated(arena, file.settings.robot, 1, scratch.file("log.rlog"));
  EXPECT_NE(driven.trouble.find("something stands in the way"), std::string::npos) << driven.trouble;
  EXPECT_NE(driven.trouble.find("1.8 x 1.8 m"), std::string::npos) << "as help and docs have it: " << driven.trouble;
  robot::ReplayRobot log(scratch.file("log.rlog"));
  double farthest = 0.0;
  while (const auto inputs = log.read())
    for (const robot::Odometry& odometry : inputs->odometry) farthest = std::max(farthest, odometry.pose.x);
  EXPECT_GT(farthest, 0.2);
  EXPECT_LT(farthest, 0.8 - 0.5 * file.settings.robot.length);
  EXPECT_THROW(calibrate_from_log(scratch.file("log.rlog"), file, file), InputError);
}

TEST(CalibrationDrive, WheelsThatDoNotFollowEndIt) {
  CalibrationDrive pilot(robot::RobotModel{}, {});
  robot::Inputs inputs;
  std::optional<robot::Drive> wanted = robot::Drive{};
  for (int tick = 0; wanted && tick < 10000; ++tick) {
    inputs.now = Stamp::from_seconds(0.02 * tick);
    inputs.odometry = {{inputs.now, {}, 0.0, 0.0, false}};
    wanted = pilot.next(inputs, 0.0);
  }
  EXPECT_FALSE(wanted);
  EXPECT_NE(pilot.trouble().find("wheels do not follow"), std::string::npos);
}

}  // namespace
}  // namespace rubble::scenarios
