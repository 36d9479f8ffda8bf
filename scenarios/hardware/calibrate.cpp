#include "scenarios/hardware/calibrate.h"

#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "base/error.h"
#include "robot/logs/log.h"

namespace rubble::scenarios {
namespace {

using slam::RobotSetup;

slam::Calibration estimate(const std::string& path) {
  robot::ReplayRobot log(path);
  const robot::RobotModel& model = log.model();
  RobotSetup taken_for;
  taken_for.T_base_laser = {model.T_base_laser.x, model.T_base_laser.y, model.T_base_laser.yaw};
  slam::Calibrator calibrator;
  while (const auto inputs = log.read()) calibrator.add(*inputs);
  return calibrator.calibrate(taken_for, model.accelerometer_mount);
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

RunReport calibration_drive(const RobotFile& file, const CalibrationDriveConfig& config, const DriveOptions& options) {
  CalibrationDrive pilot(file.settings.robot, config);
  DriveOptions piloted = options;
  piloted.mode = DriveMode::Calibrate;
  piloted.pilot = [&pilot](const robot::Inputs& inputs, const mrpt::math::TPose2D& T_map_base) {
    return pilot.next(inputs, T_map_base.phi);
  };
  RunReport report = drive(file, piloted);
  if (report.failure.empty()) report.failure = pilot.trouble();
  return report;
}

CalibratedRobot calibrate_from_log(const std::string& log, const RobotFile& in_force, const RobotFile& file) {
  CalibratedRobot robot;
  robot.calibration = estimate(log);
  if (!robot.calibration.refusal.empty())
    throw InputError(log + ": no calibration comes of it: " + robot.calibration.refusal);
  const RobotSetup& found = robot.calibration.setup;
  RobotSetup& now = robot.setup;
  now = found;
  now.distance_scale *= in_force.robot.base.distance_scale;
  now.turn_scale *= in_force.robot.base.turn_scale;
  now.delay += in_force.lidar.delay;

  robot.file = file;
  RobotFile& to = robot.file;
  to.robot.base.distance_scale = now.distance_scale;
  to.robot.base.turn_scale = now.turn_scale;
  to.lidar.delay = now.delay;
  for (mrpt::math::TPose3D* mount : {&to.settings.robot.T_base_laser, &to.robot.model.T_base_laser}) {
    mount->x = now.T_base_laser.x;
    mount->y = now.T_base_laser.y;
    mount->yaw = now.T_base_laser.phi;
  }
  if (const auto& level = robot.calibration.level) {
    const auto& before = in_force.robot.levelling;
    to.robot.levelling.x.zero = before.x.zero + std::sin(level->pitch) * before.x.sensitivity;
    to.robot.levelling.y.zero = before.y.zero + std::sin(level->roll) * before.y.sensitivity;
  }
  robot.effective_track = file.settings.robot.effective_track * now.distance_scale / now.turn_scale;
  robot.effective_track_sigma =
      robot.effective_track * std::hypot(robot.calibration.sigma.turn_scale / found.turn_scale,
                                         robot.calibration.sigma.distance_scale / found.distance_scale);
  return robot;
}

std::string calibrated_yaml(const CalibratedRobot& robot, const std::string& log) {
  const slam::Calibration& c = robot.calibration;
  const RobotSetup& sigma = c.sigma;
  std::string text = "# Calibrated by rubble calibrate from " + log + "\n";
  text += line("# %d scans over %.1f m and %.0f deg; standard deviations:\n", c.scans, c.driven, rad_to_deg(c.turned));
  text += line("# distance_scale %.4f, turn_scale %.4f (effective track %.4f +- %.4f m)\n", sigma.distance_scale,
               sigma.turn_scale, robot.effective_track, robot.effective_track_sigma);
  text += line("# laser: x %.1f mm, y %.1f mm, yaw %.2f deg, delay %.1f ms\n", 1e3 * sigma.T_base_laser.x,
               1e3 * sigma.T_base_laser.y, rad_to_deg(sigma.T_base_laser.phi), 1e3 * sigma.delay);
  if (c.level)
    text += line("# accelerometer: pitch %.2f deg, roll %.2f deg\n", rad_to_deg(c.level->pitch_sigma),
                 rad_to_deg(c.level->roll_sigma));
  return text + robot_file_yaml(robot.file);
}

}  // namespace rubble::scenarios
