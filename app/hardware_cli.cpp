#include <CLI/CLI.hpp>

#include "app/hardware.h"
#include "base/error.h"

namespace rubble::app {
namespace {

constexpr const char* kPort = "PORT: /dev/ttyUSB0, pty:PATH or tcp:HOST:PORT";

std::vector<scenarios::Override> parse_sets(const std::vector<std::string>& sets) {
  std::vector<scenarios::Override> overrides;
  for (const auto& set : sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set " + set + ": needs the form key.key=value, for example --set robot.max_v=0.3");
    overrides.emplace_back(set.substr(0, equals), set.substr(equals + 1));
  }
  return overrides;
}

void add_sets(CLI::App& command, std::vector<std::string>& sets) {
  command.add_option("--set", sets, "Override one value: --set key.key=value (repeatable)")
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace

struct HardwareCommands::Parsed {
  CLI::App* drive = nullptr;
  CLI::App* emulate = nullptr;
  DriveArguments drive_arguments;
  EmulateArguments emulate_arguments;
  std::vector<std::string> sets;

  void add_drive(CLI::App& app);
  void add_emulate(CLI::App& app);
};

void HardwareCommands::Parsed::add_drive(CLI::App& app) {
  DriveArguments& a = drive_arguments;
  drive = app.add_subcommand("drive", "Explore and map with a real robot (or one that 'rubble emulate' plays)");
  drive->add_option("robot", a.robot, "Robot file, or the name of a shipped one (default: pioneer_urg)");
  drive->add_option("--urg", a.urg, std::string("Port of the laser scanner; ") + kPort);
  drive->add_option("--base", a.base, std::string("Port of the base; ") + kPort);
  drive->add_option("--levelling", a.levelling, std::string("Port of the levelling unit, or 'none'; ") + kPort);
  drive->add_option("--time-limit", a.time_limit, "Ends so long after the first tick with all devices [s]")
      ->check(CLI::Range(1.0, 1e6));
  drive->add_option("--heartbeat", a.heartbeat, "File or pipe that must be touched once a second, or the robot stands");
  CLI::Option* teleop = drive->add_flag("--teleop", a.teleop, "Drive by the keys: arrows or WASD held, Q ends");
  drive->add_flag("--map-only", a.map_only, "Only map; somebody else drives")->excludes(teleop);
  drive->add_option("--out", a.common.out, "Folder for the results (default: runs/NAME-seedN-NUMBER)");
  drive->add_flag("--force", a.common.force, "Replace an existing run folder");
  add_sets(*drive, sets);
  drive->footer(
      "Any key (but for --teleop) and SIGUSR1 are the emergency stop. Ctrl-C stops and ends with the folder complete.\n"
      "Examples:\n  rubble drive\n"
      "  rubble drive my_robot.yaml --urg /dev/ttyACM1 --set robot.max_v=0.3\n"
      "  rubble drive --urg tcp:127.0.0.1:10940 --base tcp:127.0.0.1:8101 --levelling tcp:127.0.0.1:8102");
}

void HardwareCommands::Parsed::add_emulate(CLI::App& app) {
  EmulateArguments& a = emulate_arguments;
  emulate = app.add_subcommand("emulate", "Play the devices of a simulated robot in real time");
  emulate->add_option("scenario", a.scenario, "Scenario file, or the name of a shipped one (default: yellow)");
  emulate->add_option("--seed", a.seed, "Seed of every random choice");
  emulate->add_option("--urg", a.urg, "Offer the laser scanner there: tcp:HOST:PORT or pty:PATH");
  emulate->add_option("--base", a.base, "Offer the base there");
  emulate->add_option("--levelling", a.levelling, "Offer the levelling unit there");
  emulate->add_option("--fault", a.faults, "NAME@SECONDS: let something go wrong (repeatable); docs/hardware.md")
      ->allow_extra_args(false)
      ->take_all();
  emulate->add_option("--odometry-start", a.odometry_start, "X,Y,DEG: where the base's dead reckoning begins [m, deg]");
  emulate->add_option("--time-limit", a.time_limit, "Ends after so long (default: Ctrl-C ends it) [s]")
      ->check(CLI::Range(0.0, 1e6));
  emulate->add_option("--truth", a.truth, "Write the true trajectory to this .tum file");
  add_sets(*emulate, sets);
  emulate->footer(
      "Example:\n  rubble emulate yellow --urg tcp:127.0.0.1:10940 --base tcp:127.0.0.1:8101 "
      "--levelling tcp:127.0.0.1:8102");
}

HardwareCommands::HardwareCommands(CLI::App& app) : parsed_(std::make_unique<Parsed>()) {
  parsed_->add_drive(app);
  parsed_->add_emulate(app);
}

HardwareCommands::~HardwareCommands() = default;

std::optional<int> HardwareCommands::run() {
  Parsed& p = *parsed_;
  if (*p.drive) {
    p.drive_arguments.common.overrides = parse_sets(p.sets);
    return drive(p.drive_arguments);
  }
  if (*p.emulate) {
    p.emulate_arguments.overrides = parse_sets(p.sets);
    return emulate(p.emulate_arguments);
  }
  return std::nullopt;
}

}  // namespace rubble::app
