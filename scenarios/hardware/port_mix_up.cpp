#include "scenarios/hardware/port_mix_up.h"

#include "base/error.h"
#include "robot/drivers/port.h"

namespace rubble::scenarios {
std::vector<std::string> port_mix_up(const std::vector<DevicePort>& silent, const std::function<bool()>& interrupted) {
  std::vector<std::string> lines;
  if (silent.size() < 2) return lines;
  for (const DevicePort& device : silent) {
    if (device.port.empty()) continue;
    if (interrupted && interrupted()) break;
    try {
      const auto found = robot::probe_port(device.port);
      if (!found || found->kind == device.kind) continue;
      lines.push_back(device.name + ": at its port " + device.port + " a " + found->called +
                      " answers; are the ports mixed up?");
    } catch (const RunError&) {
      continue;  // nobody can be asked there
    }
  }
  return lines;
}

}  // namespace rubble::scenarios
