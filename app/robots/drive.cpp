#include "scenarios/hardware/drive.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/robots/keyboard.h"
#include "app/robots/robot_options.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/error.h"

namespace rubble::app {
namespace {

struct DriveArguments {
  RobotOptions robot;
  std::optional<double> time_limit;
  std::string heartbeat;
  bool teleop = false;
  bool map_only = false;
  RunFolderOptions folder;
};

constexpr double kTeleopSpeed = 0.3;  ///< [m/s]
constexpr double kTeleopTurn = 0.6;   ///< [rad/s]

/// Whoever touches it may make it later, but not its folder.
void require_place_for_heartbeat(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (path.empty() || folder.empty() || std::filesystem::is_directory(folder, error)) return;
  throw InputError("--heartbeat " + path + ": there is no folder " + folder.string() +
                   " in which it could be touched; give a file or pipe in one that exists");
}

/// The robot file with what the command line says instead.
scenarios::RobotFile robot_file(const DriveArguments& arguments) {
  require_place_for_heartbeat(arguments.heartbeat);
  auto overrides = arguments.robot.with_ports(arguments.folder.overrides());
  if (arguments.time_limit) overrides.emplace_back("time_limit_s", std::to_string(*arguments.time_limit));
  scenarios::RobotFile file = scenarios::load_robot_file(find_robot(arguments.robot.robot), overrides);
  permit_command(arguments.folder.mapper, overrides, file.settings);
  file.robot.heartbeat = arguments.heartbeat;
  return file;
}

int drive(const DriveArguments& arguments) {
  const scenarios::RobotFile file = robot_file(arguments);
  Keyboard keyboard;
  if (arguments.teleop && !keyboard.active())
    throw UsageError("--teleop: there is no terminal whose keys could be held; start it at one, or use --map-only");
  scenarios::DriveOptions options = drive_options(keyboard, !arguments.teleop);
  options.mode = arguments.teleop     ? scenarios::DriveMode::Teleoperate
                 : arguments.map_only ? scenarios::DriveMode::MapOnly
                                      : scenarios::DriveMode::Explore;
  if (!arguments.map_only)
    options.notice = missing_keys(keyboard, arguments.heartbeat.empty()
                                                ? ", and --heartbeat FILE would when nobody touches FILE any more"
                                                : ", and so does a heartbeat that ends");
  options.out = arguments.folder.out;
  options.replace = arguments.folder.force;
  options.keys = [&] { return keyboard.drive(kTeleopSpeed, kTeleopTurn); };
  const scenarios::RunReport report = scenarios::drive(file, options);
  const auto covered = report.score->find("sim_s");
  if (!report.failure.empty() && covered != report.score->end() && covered->is_number() && *covered == 0.0) {
    // It never began: there is nothing to show but why.
    print_row("folder", report.folder + " (nothing is mapped; devices.bytes holds what was said)");
    tell(report.failure);
    return kFailed;
  }
  return show(report);
}

}  // namespace

Command drive_command() {
  return {"drive", "Explore and map with a real robot (or one that 'rubble emulate' plays)",
          "Any key (but for --teleop) and SIGUSR1 are the emergency stop. Ctrl-C stops and ends with the folder "
          "complete.\n"
          "Examples:\n  rubble drive\n"
          "  rubble drive my_robot.yaml --urg /dev/ttyACM1 --set robot.max_v=0.3\n"
          "  rubble drive --urg tcp:127.0.0.1:10940 --base tcp:127.0.0.1:8101 --levelling tcp:127.0.0.1:8102",
          [](Options& o) -> Action {
            auto a = std::make_shared<DriveArguments>();
            a->robot.declare(o);
            o.number("--time-limit", a->time_limit, 1.0, 1e6, "Ends so long after the first tick with all devices [s]");
            o.text("--heartbeat", a->heartbeat, "File or pipe that must be touched once a second, or the robot stands");
            o.flag("--teleop", a->teleop, "Drive by the keys: arrows or WASD held, Q ends");
            o.flag("--map-only", a->map_only, "Only map; somebody else drives");
            o.excludes("--map-only", "--teleop");
            a->folder.declare(o);
            return [a] { return drive(*a); };
          }};
}

}  // namespace rubble::app
