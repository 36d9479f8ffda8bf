// `rubble devices`: who answers at the ports, and what a scanner sees.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "app/terminal.h"
#include "base/error.h"
#include "robot/drivers/port.h"
#include "robot/drivers/probe/probe.h"

namespace rubble::app {
namespace {

constexpr int kPictureRows = 25;
constexpr int kLabels = 16;

void print(const std::string& port, const robot::FoundDevice& found, double radius) {
  print_line(port + ": " + found.called);
  for (const auto& [name, value] : found.facts) print_row("  " + name, value, kLabels);
  if (!found.scan) return;
  print_row("  scan", robot::scan_summary(*found.scan), kLabels);
  std::printf("%s", robot::scan_picture(*found.scan, radius, kPictureRows).c_str());
}

/// Whether a device that is known answered there. A port that is none is told of like one where nobody answers: the
/// next is asked all the same.
bool ask(const std::string& port, double radius, bool only) {
  try {
    const auto found = robot::probe_port(port);
    if (!found) {
      print_line(port + ": no device that rubble knows answers");
      return false;
    }
    print(port, *found, radius);
    return true;
  } catch (const robot::DeviceLost& lost) {
    print_line(lost.what());
    return false;
  } catch (const InputError& none) {
    if (only) throw;
    print_line(none.what());
    return false;
  }
}

struct DevicesArguments {
  std::vector<std::string> ports;  ///< empty: all serial lines of this machine
  double radius = 4.0;             ///< of the picture of a scan [m]
};

int devices(const DevicesArguments& arguments) {
  for (const std::string& port : arguments.ports) robot::check_port_word(port);
  const std::vector<std::string> ports = arguments.ports.empty() ? robot::serial_lines() : arguments.ports;
  if (ports.empty())
    throw RunError(
        "no USB serial line is plugged in; plug the devices in, or name their ports: rubble devices tcp:HOST:PORT");
  std::size_t known = 0;
  for (const std::string& port : ports) {
    known += ask(port, arguments.radius, ports.size() == 1) ? 1 : 0;
    std::fflush(stdout);
  }
  return known > 0 ? kOk : kFailed;
}

}  // namespace

Command devices_command() {
  return {"devices", "Find the robot's devices and tell what they are and see",
          "Examples:\n  rubble devices\n  rubble devices /dev/ttyACM0 tcp:127.0.0.1:10940", [](Options& o) -> Action {
            auto a = std::make_shared<DevicesArguments>();
            o.arguments("ports", a->ports,
                        "Ports to ask: /dev/ttyUSB0, pty:PATH or tcp:HOST:PORT (default: all USB serial lines)",
                        Options::Need::Optional);
            o.number("--radius", a->radius, 0.1, 100.0, "How much a scan's picture shows [m]");
            return [a] { return devices(*a); };
          }};
}

}  // namespace rubble::app
