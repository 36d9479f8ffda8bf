#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"

namespace CLI {
class App;
}

namespace rubble::app {

struct DriveArguments {
  std::string robot;
  std::string urg, base, levelling;  ///< ports that replace those of the robot file
  std::optional<double> time_limit;
  std::string heartbeat;
  bool teleop = false;
  bool map_only = false;
  CommonOptions common;
};

struct EmulateArguments {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string urg, base, levelling;
  std::vector<std::string> faults;  ///< NAME@SECONDS
  std::string odometry_start;       ///< X,Y,DEG
  double time_limit = 0.0;
  std::string truth;
  std::vector<scenarios::Override> overrides;
};

int drive(const DriveArguments& arguments);
int emulate(const EmulateArguments& arguments);

/// The subcommands about real robots and their devices: drive, emulate. Kept apart from main.cpp's.
class HardwareCommands {
 public:
  explicit HardwareCommands(CLI::App& app);
  ~HardwareCommands();
  /// The exit code when one of them was chosen.
  std::optional<int> run();

 private:
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace rubble::app
