#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/measurements.h"

namespace rubble::robot {

enum class DeviceKind { Scanner, Base, Levelling };

/// A device that answered on a port.
struct FoundDevice {
  DeviceKind kind = DeviceKind::Scanner;
  std::string called;                                      ///< for people: "laser scanner"
  std::vector<std::pair<std::string, std::string>> facts;  ///< what it says of itself, for people
  std::optional<LaserScan> scan;                           ///< of a scanner: what it sees now
};

/// Asks the device at the port who it is, in the language of every kind that is known; nothing when it answers none.
/// Nothing moves by that. Throws InputError on a bad word, DeviceLost when the port cannot be opened.
std::optional<FoundDevice> probe_port(const std::string& word);

/// The serial lines of this machine that may have a device of a robot: USB adapters and USB devices, by the names that
/// stay the same (/dev/serial/by-id) where there are such.
std::vector<std::string> serial_lines(const std::string& dev_folder = "/dev");

/// The scan seen from above, `rows` lines of text: `^` the scanner looking up, `#` what it hit, `.` what it saw
/// through, the nearest `radius` [m] around it.
std::string scan_picture(const LaserScan& scan, double radius, int rows);

/// One line about a scan: beams measured, without echo, nearest thing.
std::string scan_summary(const LaserScan& scan);

}  // namespace rubble::robot
