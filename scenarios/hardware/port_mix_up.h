#pragma once

#include <functional>
#include <string>
#include <vector>

#include "robot/drivers/probe/probe.h"

namespace rubble::scenarios {

/// Where a device of the robot is looked for.
struct DevicePort {
  robot::DeviceKind kind = robot::DeviceKind::Scanner;
  std::string name;  ///< "urg", "base" or "levelling"
  std::string port;
};

/// Asks at the ports of `silent` devices who is there: one line for each at which a device of another kind answers. One
/// silent device alone is not asked for: ports are mixed up in pairs. Takes some seconds for each port, on a serial
/// line up to 20; `interrupted` (may be empty) is asked between two of them.
std::vector<std::string> port_mix_up(const std::vector<DevicePort>& silent, const std::function<bool()>& interrupted);

}  // namespace rubble::scenarios
