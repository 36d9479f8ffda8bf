// `rubble calibrate`: finds the numbers of a robot file by driving squares and turns.
#include "scenarios/hardware/calibrate.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/mapper_choice.h"
#include "app/robots/robot_options.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/text/text_file.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  RobotOptions robot;
  std::string log;  ///< a run folder or a log; empty: drive
  std::string out = "calibrated.yaml";
  std::string folder;  ///< of the drive
  bool force = false;
  std::vector<std::string> sets;
  MapperChoice mapper;
  scenarios::CalibrationDriveConfig drive;
};

void print_setup(const scenarios::CalibratedRobot& robot) {
  const slam::RobotSetup& now = robot.setup;
  const slam::RobotSetup& sigma = robot.calibration.sigma;
  const auto row = [](const char* name, double value, double error, int digits, const char* unit) {
    std::printf("%-24s %10.*f +- %.*f %s\n", name, digits, value, digits, error, unit);
  };
  if (std::isnan(robot.effective_track)) {
    std::printf("%-24s %10s\n", "effective track", "not known: the firmware does not tell its own");
  } else {
    row("effective track", robot.effective_track, robot.effective_track_sigma, 4, "m");
  }
  row("distance scale", now.distance_scale, sigma.distance_scale, 4, "");
  row("turn scale", now.turn_scale, sigma.turn_scale, 4, "");
  row("laser x", now.T_base_laser.x, sigma.T_base_laser.x, 4, "m");
  row("laser y", now.T_base_laser.y, sigma.T_base_laser.y, 4, "m");
  row("laser yaw", rad_to_deg(now.T_base_laser.phi), rad_to_deg(sigma.T_base_laser.phi), 2, "deg");
  row("laser delay", 1e3 * now.delay, 1e3 * sigma.delay, 1, "ms");
  if (const auto& level = robot.calibration.level) {
    row("accelerometer pitch", rad_to_deg(level->pitch), rad_to_deg(level->pitch_sigma), 2, "deg off before");
    row("accelerometer roll", rad_to_deg(level->roll), rad_to_deg(level->roll_sigma), 2, "deg off before");
    if (level->slope_known) {
      std::printf("%-24s %10.2f deg\n", "slope of the floor", rad_to_deg(level->slope));
    } else {
      std::printf("%-24s %10s\n", "slope of the floor", "taken to be level: the robot did not turn enough");
    }
  } else if (robot.file.settings.robot.has_levelling_unit) {
    std::printf("%-24s %10s\n", "accelerometer", "unknown: the robot never stood still");
  }
  const slam::Calibration& c = robot.calibration;
  std::printf("%-24s %d scans, %.1f m, %.0f deg; scans and wheels differ by %.1f mm, %.2f deg (median)\n", "from",
              c.scans, c.driven, rad_to_deg(c.turned), 1e3 * c.position_error, rad_to_deg(c.turn_error));
}

/// The robot file that a recorded run was driven with, where it is one of `rubble drive` or `calibrate`.
std::string recorded_robot(const std::string& run) {
  const fs::path folder = fs::is_directory(run) ? fs::path(run) : fs::path(run).parent_path();
  const std::string file = (folder / "robot.yaml").string();
  return fs::exists(file) ? file : "";
}

/// Throws InputError when no file can be made at `path`.
void require_place(const std::string& path) {
  const fs::path folder = fs::absolute(path).parent_path();
  if (fs::is_directory(path) || !fs::is_directory(folder) || ::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(path + ": cannot be written; give --out in a folder that exists and may be written");
}

int calibrate(const CalibrateArguments& arguments) {
  if (fs::exists(arguments.out) && !arguments.force)
    throw InputError(arguments.out + ": exists already; give another --out, or --force to replace it");
  require_place(arguments.out);  // known before two minutes are driven for it
  const auto overrides = with_mapper(arguments.mapper, arguments.robot.with_ports(parse_sets(arguments.sets)));
  std::string run = arguments.log;
  scenarios::RobotFile file;
  scenarios::RobotFile in_force;
  if (!run.empty()) {
    const std::string recorded = recorded_robot(run);
    const bool named = !arguments.robot.robot.empty();
    if (recorded.empty() && !named)
      throw UsageError("--log " + run + ": there is no robot.yaml beside it; name the robot file it was driven with");
    file = scenarios::load_robot_file(named ? find_robot(arguments.robot.robot) : recorded, overrides);
    in_force = recorded.empty() ? file : scenarios::load_robot_file(recorded);
  } else {
    file = scenarios::load_robot_file(find_robot(arguments.robot.robot), overrides);
    permit_command(arguments.mapper, overrides, file.settings);
    in_force = file;
    Keyboard keyboard;
    scenarios::DriveOptions options = drive_options(keyboard, true);
    options.notice = missing_keys(keyboard, "");
    options.out = arguments.folder;
    options.replace = arguments.force;
    const scenarios::RunReport report = scenarios::calibration_drive(file, arguments.drive, options);
    print_row("ended", report.end);
    print_row("folder", report.folder);
    run = report.folder;
    if (report.interrupted) return kInterrupted;
    if (!report.failure.empty())
      throw RunError(arguments.out + ": is not written, the drive was not completed: " + report.failure);
  }
  const scenarios::CalibratedRobot robot = scenarios::calibrate_from_log(recorded_log(run), in_force, file);
  print_setup(robot);
  write_text_file(arguments.out, scenarios::calibrated_yaml(robot, run));
  print_row("written", arguments.out);
  return kOk;
}

}  // namespace

Command calibrate_command() {
  return {"calibrate", "Find wheel scales, laser mount and delay, and the accelerometer's zero of a real robot",
          "Drives a square both ways and turns on the spot, about two minutes. Needs 1.8 x 1.8 m of flat, free floor\n"
          "ahead and to the left, and walls within the scanner's range. Any key stops the robot.\n"
          "Examples:\n  rubble calibrate my_robot.yaml --out calibrated.yaml\n"
          "  rubble calibrate my_robot.yaml --log runs/latest --out calibrated.yaml",
          [](Options& o) -> Action {
            auto a = std::make_shared<CalibrateArguments>();
            a->robot.declare(o);
            o.text("--log", a->log, "Do not drive: use this run folder or log");
            o.text("--out", a->out, "Robot file to write (default: calibrated.yaml)");
            o.text("--folder", a->folder, "Run folder of the drive (default: runs/<name>-seed<N>-<number>)");
            o.flag("--force", a->force, "Replace what exists there");
            o.number("--side", a->drive.side, 0.3, 5.0, "Of the square that is driven [m]");
            o.number("--speed", a->drive.speed, 0.05, 1.0, "[m/s]");
            o.number("--turn-rate", a->drive.turn_rate, 0.1, 3.0, "[rad/s]");
            o.excludes("--log", "--folder");
            add_mapper(o, a->mapper);
            o.excludes("--log", "--mapper-command");
            add_sets(o, a->sets);
            return [a] { return calibrate(*a); };
          }};
}

}  // namespace rubble::app
