#include "robot/drivers/probe/probe.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <system_error>

#include "base/angle.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/levelling_unit.h"
#include "robot/drivers/pioneer.h"
#include "robot/drivers/port.h"
#include "robot/drivers/port_word.h"
#include "robot/drivers/scip/scip_link.h"
#include "robot/drivers/scip/scip_scan.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

constexpr double kFirstScan = 1.0;            // a scanner sends its first one within [s]
constexpr double kTurn = 0.01;                // a driver is asked what to send so often [s]
constexpr double kLevellingPatience = 1.5;    // asked to identify itself a few times [s]
constexpr double kBasePatience = 3.0;         // over TCP there is but one bit rate [s]
constexpr double kSerialBasePatience = 12.0;  // each bit rate takes a second or two [s]

std::string text(const char* format, double a, double b = 0.0) {
  char line[128];
  std::snprintf(line, sizeof line, format, a, b);
  return line;
}

/// A Hokuyo scanner; it is left as it was found but for the protocol: the switch to SCIP 2.0 holds until power-off.
std::optional<FoundDevice> probe_scanner(const std::string& word) {
  scip::Link link(open_port(word));
  if (!link.knock()) return std::nullopt;
  FoundDevice found;
  found.kind = DeviceKind::Scanner;
  found.called = "laser scanner";
  try {
    link.shake_hands(false);
    const ScannerInfo& info = link.info();
    const LaserModel& laser = info.laser;
    const double last = laser.angle_min + laser.field_of_view();
    found.facts = {{"model", info.model},
                   {"firmware", info.firmware},
                   {"serial number", info.serial},
                   {"protocol", info.protocol},
                   {"ranges", text("%.2f to %.2f m", laser.range_min, laser.range_max)},
                   {"beams", std::to_string(laser.beams) +
                                 text(" from %.2f to %.2f deg", rad_to_deg(laser.angle_min), rad_to_deg(last))},
                   {"turns", text("%.1f a second", 1.0 / laser.scan_period)}};
    const std::string state = link.state();
    if (!state.empty()) found.facts.emplace_back("state", state);
    link.start();
    if (const auto sweep = link.next_sweep(kFirstScan)) {
      const Stamp turn = link.begun() - laser.scan_period;
      found.scan = scip::scan_of(*sweep, link.geometry(), {laser.range_max, false}, turn);
    } else {
      found.facts.emplace_back("trouble", "no scan came within a second");
    }
    link.stop();
  } catch (const scip::Refused& trouble) {
    found.facts.emplace_back("trouble", trouble.what());
  }
  return found;
}

/// Lets a device's driver and the device talk until the driver is ready; false: it did not come to that in time.
bool becomes_ready(Device& device, const std::string& word, double patience) {
  const auto port = open_port(word);
  const auto send = [&](const std::string& bytes) {
    if (!bytes.empty()) port->write(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), host_now());
  };
  const Stamp end = host_now() + patience;
  device.opened(port->opened(), port->kind());
  int baud = 0;
  while (!device.ready() && host_now() < end) {
    std::array<std::uint8_t, 1024> bytes;
    const auto [got, now] = port->read(bytes.data(), bytes.size(), kTurn);
    if (got > 0) device.receive({reinterpret_cast<const char*>(bytes.data()), got}, now);
    device.advance(now);
    const std::string out = device.take_output(now);
    if (port->is_serial() && device.baud() > 0 && device.baud() != baud) port->set_baud(baud = device.baud());
    send(out);
  }
  for (const std::string& packet : device.farewell()) {
    send(packet);
    sleep_until(host_now() + Device::kPause);
  }
  return device.ready();
}

/// The unit that levels the scanner; its servos stay where they are.
std::optional<FoundDevice> probe_levelling(const std::string& word) {
  LevellingUnitSettings settings;
  settings.passive = true;
  LevellingUnit unit(settings);
  if (!becomes_ready(unit, word, kLevellingPatience)) return std::nullopt;
  const LevellingIdentity& said = unit.identity();
  FoundDevice found;
  found.kind = DeviceKind::Levelling;
  found.called = "levelling unit";
  found.facts = {{"model", said.model},
                 {"sensor", said.sensor},
                 {"reports", std::to_string(said.rate) + " a second"},
                 {"servo pulses", std::to_string(said.us_min) + " to " + std::to_string(said.us_max) + " us"}};
  const auto felt = unit.take_accelerations();
  if (!felt.empty())
    found.facts.emplace_back("feels", text("%.2f m/s^2 forward, %.2f m/s^2 left", felt.back().x, felt.back().y));
  return found;
}

/// A Pioneer or one of its kin; its motors stay off, its own odometry is set to zero.
std::optional<FoundDevice> probe_base(const std::string& word) {
  BaseSettings settings;
  settings.passive = true;
  Pioneer base(settings);
  const bool is_tcp = parse_port_word(word).kind == PortKind::Tcp;
  if (!becomes_ready(base, word, is_tcp ? kBasePatience : kSerialBasePatience)) return std::nullopt;
  FoundDevice found;
  found.kind = DeviceKind::Base;
  found.called = "robot base (ARCOS)";
  found.facts = {{"name", base.identity().name},
                 {"type", base.identity().type + " " + base.identity().subclass},
                 {"firmware", base.configured() ? base.configuration().firmware : "not told"},
                 {"serial number", base.configured() ? base.configuration().serial : "not told"},
                 {"battery", text("%.1f V", base.battery())}};
  if (base.emergency_button()) found.facts.emplace_back("trouble", "the emergency button is pressed");
  return found;
}

/// Every kind of device that can be told apart; the first one that answers has it.
using Probe = std::optional<FoundDevice> (*)(const std::string& word);
constexpr Probe kProbes[] = {probe_scanner, probe_levelling, probe_base};

}  // namespace

std::optional<FoundDevice> probe_port(const std::string& word) {
  for (const Probe probe : kProbes)
    if (auto found = probe(word)) return found;
  return std::nullopt;
}

std::vector<std::string> serial_lines(const std::string& dev_folder) {
  std::vector<std::string> lines;
  std::set<std::string> seen;
  const auto add = [&](const fs::path& path) {
    std::error_code error;
    if (seen.insert(fs::canonical(path, error).string()).second) lines.push_back(path.string());
  };
  const auto add_all = [&](const fs::path& folder, const auto& wanted) {
    std::vector<fs::path> paths;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (wanted(entry.path().filename().string())) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const fs::path& path : paths) add(path);
  };
  add_all(fs::path(dev_folder) / "serial" / "by-id", [](const std::string&) { return true; });
  add_all(dev_folder,
          [](const std::string& name) { return name.rfind("ttyUSB", 0) == 0 || name.rfind("ttyACM", 0) == 0; });
  return lines;
}

}  // namespace rubble::robot
