#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/robots/keyboard.h"
#include "scenarios/hardware/drive.h"
#include "scenarios/hardware/robot_file.h"

namespace rubble::app {

/// Which robot, and where its devices are: what the commands that drive one share.
struct RobotOptions {
  std::string robot;
  std::string urg, base, levelling;  ///< ports that replace those of the robot file, where given
  std::function<bool(const std::string& option)> given = [](const std::string&) { return false; };

  void declare(Options& options);
  /// `overrides` and the ports given, in the words of a robot file.
  std::vector<scenarios::Override> with_ports(std::vector<scenarios::Override> overrides) const;
};

/// What every drive of a real robot does: Ctrl-C ends it, SIGUSR1 and (where `keys_stop`) any key stop it for good, the
/// terminal shows how it goes. `keyboard` must outlive the drive.
scenarios::DriveOptions drive_options(Keyboard& keyboard, bool keys_stop);

/// Where there is no terminal: one line that no key stops the robot, and what does; else empty. `more`: what does
/// besides.
std::string missing_keys(const Keyboard& keyboard, const std::string& more);

}  // namespace rubble::app
