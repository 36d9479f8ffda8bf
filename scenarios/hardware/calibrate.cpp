#include "scenarios/hardware/calibrate.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/words.h"
#include "robot/logs/log.h"

namespace rubble::scenarios {
namespace {

using slam::RobotSetup;

constexpr const char* kWithWheelSpeeds = "arcos";  ///< the base driver whose odometry's turn rate is the wheels'

/// How the turn that the wheels' speeds give, by the track in force, compares with the turn of the reckoned heading:
/// the firmware divides by a track of its own, which it does not tell.
class TrackRatio {
 public:
  void add(const robot::Odometry& odometry) {
    if (last_ && !last_->stalled && !odometry.stalled && odometry.stamp - last_->stamp < kLongestCycle) {
      const double turn = wrap_angle(odometry.pose.phi - last_->pose.phi);
      const double by_wheels = 0.5 * (last_->w + odometry.w) * (odometry.stamp - last_->stamp);
      turns_ += turn * turn;
      mixed_ += turn * by_wheels;
      wheels_ += by_wheels * by_wheels;
      count_ += 1.0;
    }
    last_ = odometry;
  }
  /// Nothing when the log has no wheel speeds.
  bool is_known() const { return count_ > 10.0 && mixed_ > 0.0; }
  double value() const { return mixed_ / turns_; }
  double sigma() const {
    return std::sqrt(std::max(0.0, wheels_ - mixed_ * mixed_ / turns_) / (count_ - 1.0) / turns_);
  }

 private:
  static constexpr double kLongestCycle = 0.25;  ///< across a longer gap speeds say too little [s]
  std::optional<robot::Odometry> last_;
  double turns_ = 0.0, mixed_ = 0.0, wheels_ = 0.0, count_ = 0.0;
};

struct Estimate {
  slam::Calibration calibration;
  TrackRatio track;
  double track_in_force = 0.0;  ///< [m]
};

Estimate estimate(const std::string& path) {
  robot::ReplayRobot log(path);
  const robot::RobotModel& model = log.model();
  RobotSetup taken_for;
  taken_for.T_base_laser = {model.T_base_laser.x, model.T_base_laser.y, model.T_base_laser.yaw};
  slam::Calibrator calibrator;
  Estimate estimate;
  while (const auto inputs = log.read()) {
    calibrator.add(*inputs);
    for (const robot::Odometry& odometry : inputs->odometry) estimate.track.add(odometry);
  }
  estimate.calibration = calibrator.calibrate(taken_for, model.accelerometer_mount);
  estimate.track_in_force = model.effective_track;
  return estimate;
}

/// To a millionth, a hundredth of what the best drive tells (m, s, deg, or no unit): more digits would only pretend.
double to_millionth(double value) { return std::round(1e6 * value) / 1e6; }

/// What was found, as it is written.
RobotFile rounded(RobotFile file) {
  robot::RealRobotSettings& robot = file.robot;
  for (double* value : {&robot.base.distance_scale, &robot.base.turn_scale, &file.lidar.delay, &robot.levelling.x.zero,
                        &robot.levelling.y.zero})
    *value = to_millionth(*value);
  for (robot::RobotModel* model : {&file.settings.robot, &robot.model}) {
    model->T_base_laser.x = to_millionth(model->T_base_laser.x);
    model->T_base_laser.y = to_millionth(model->T_base_laser.y);
    model->T_base_laser.yaw = deg_to_rad(to_millionth(rad_to_deg(model->T_base_laser.yaw)));
    model->effective_track = to_millionth(model->effective_track);
  }
  return file;
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
  piloted.pilot_trouble = [&pilot] { return pilot.trouble(); };
  RunReport report = drive(file, piloted);
  if (report.failure.empty()) report.failure = pilot.trouble();
  return report;
}

CalibratedRobot calibrate_from_log(const std::string& log, const RobotFile& in_force, const RobotFile& file) {
  CalibratedRobot robot;
  const Estimate estimated = estimate(log);
  robot.calibration = estimated.calibration;
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
  // Only of the firmware whose wheel speeds our driver reads it is known what its turn rate is made of.
  if (in_force.robot.base_driver != kWithWheelSpeeds || !estimated.track.is_known()) return robot;
  const double firmware_track = estimated.track_in_force * estimated.track.value();
  for (robot::RobotModel* model : {&to.settings.robot, &to.robot.model}) model->effective_track = firmware_track;
  robot.effective_track = firmware_track * now.distance_scale / now.turn_scale;
  robot.effective_track_sigma =
      robot.effective_track * std::hypot(robot.calibration.sigma.turn_scale / found.turn_scale,
                                         robot.calibration.sigma.distance_scale / found.distance_scale,
                                         estimated.track.sigma() / estimated.track.value());
  return robot;
}

std::string calibrated_yaml(const CalibratedRobot& robot, const std::string& log) {
  const slam::Calibration& c = robot.calibration;
  const RobotSetup& sigma = c.sigma;
  std::string text = "# Calibrated by rubble calibrate from " + one_line(log) + "\n";
  text += line("# %d scans over %.1f m and %.0f deg; standard deviations:\n", c.scans, c.driven, rad_to_deg(c.turned));
  text += line("# distance_scale %.4f, turn_scale %.4f\n", sigma.distance_scale, sigma.turn_scale);
  text += std::isnan(robot.effective_track)
              ? "# effective track: not known, the log has no wheel speeds\n"
              : line("# effective track %.4f +- %.4f m\n", robot.effective_track, robot.effective_track_sigma);
  text += line("# laser: x %.1f mm, y %.1f mm, yaw %.2f deg, delay %.1f ms\n", 1e3 * sigma.T_base_laser.x,
               1e3 * sigma.T_base_laser.y, rad_to_deg(sigma.T_base_laser.phi), 1e3 * sigma.delay);
  if (c.level)
    text += line("# accelerometer: pitch %.2f deg, roll %.2f deg\n", rad_to_deg(c.level->pitch_sigma),
                 rad_to_deg(c.level->roll_sigma));
  return text + robot_file_yaml(rounded(robot.file));
}

}  // namespace rubble::scenarios
