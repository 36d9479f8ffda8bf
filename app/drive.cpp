#include "scenarios/hardware/drive.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/keyboard.h"
#include "app/scenario_options.h"
#include "app/terminal.h"
#include "base/angle.h"

namespace rubble::app {
namespace {

constexpr const char* kPort = "/dev/ttyUSB0, pty:PATH or tcp:HOST:PORT";

struct DriveArguments {
  std::string robot;
  std::string urg, base, levelling;  ///< ports that replace those of the robot file
  std::optional<double> time_limit;
  std::string heartbeat;
  bool teleop = false;
  bool map_only = false;
  RunFolderOptions folder;
};

constexpr double kTeleopSpeed = 0.3;  ///< [m/s]
constexpr double kTeleopTurn = 0.6;   ///< [rad/s]

volatile std::sig_atomic_t emergency_signalled = 0;

void on_emergency(int /*signal*/) { emergency_signalled = 1; }

/// The robot file with what the command line says instead.
scenarios::RobotFile robot_file(const DriveArguments& arguments) {
  auto overrides = arguments.folder.overrides();
  if (!arguments.urg.empty()) overrides.emplace_back("devices.urg.port", arguments.urg);
  if (!arguments.base.empty()) overrides.emplace_back("devices.base.port", arguments.base);
  if (arguments.levelling == "none") {
    overrides.emplace_back("devices.levelling.driver", "none");
  } else if (!arguments.levelling.empty()) {
    overrides.emplace_back("devices.levelling.port", arguments.levelling);
  }
  if (arguments.time_limit) overrides.emplace_back("time_limit_s", std::to_string(*arguments.time_limit));
  scenarios::RobotFile file = scenarios::load_robot_file(find_robot(arguments.robot), overrides);
  permit_command(arguments.folder.mapper, overrides, file.settings);
  file.robot.heartbeat = arguments.heartbeat;
  return file;
}

void print_status(const scenarios::DriveStatus& s) {
  std::fprintf(
      stderr,
      "%6.0f s  %-10s  x %6.2f y %6.2f m %4.0f deg  %5.1f m2  %4.1f V  motors %-3s  scans %4.1f odometry %4.1f "
      "levelling %4.1f /s\n",
      s.seconds, s.state.c_str(), s.T_map_base.x, s.T_map_base.y, rad_to_deg(s.T_map_base.phi), s.known_m2,
      s.robot.battery, s.robot.motors_on ? "on" : "off", s.scans_per_s, s.odometry_per_s, s.accelerations_per_s);
}

int drive(const DriveArguments& arguments) {
  const scenarios::RobotFile file = robot_file(arguments);
  catch_interrupts();
  std::signal(SIGUSR1, on_emergency);
  Keyboard keyboard;
  scenarios::DriveOptions options;
  options.mode = arguments.teleop     ? scenarios::DriveMode::Teleoperate
                 : arguments.map_only ? scenarios::DriveMode::MapOnly
                                      : scenarios::DriveMode::Explore;
  options.out = arguments.folder.out;
  options.replace = arguments.folder.force;
  options.interrupted = [&] { return interrupted() || keyboard.quit(); };
  options.emergency = [&] { return emergency_signalled != 0 || (!arguments.teleop && keyboard.pressed()); };
  options.keys = [&] { return keyboard.drive(kTeleopSpeed, kTeleopTurn); };
  options.each_second = print_status;
  options.tell = [](const std::string& line) { std::fprintf(stderr, "rubble: %s\n", line.c_str()); };
  const scenarios::RunReport report = scenarios::drive(file, options);
  const int code = show(report);
  std::printf("%-30s %.1f ms, 99 %% below %.1f ms\n", "answer to a scan",
              report.score["answer_ms_median"].get<double>(), report.score["answer_ms_99"].get<double>());
  std::printf("%-30s %.1f %% of one core\n", "computing", 100.0 * report.score["cpu_share"].get<double>());
  return code;
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
            o.argument("robot", a->robot, "Robot file, or the name of a shipped one (default: pioneer_urg)",
                       Options::Need::Optional);
            o.text("--urg", a->urg, std::string("Port of the laser scanner; ") + kPort);
            o.text("--base", a->base, std::string("Port of the base; ") + kPort);
            o.text("--levelling", a->levelling, std::string("Port of the levelling unit, or 'none'; ") + kPort);
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
