#include "robot/drivers/probe/probe.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <system_error>

#include "base/angle.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/port.h"
#include "robot/drivers/scip/scip_link.h"
#include "robot/drivers/scip/scip_scan.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

constexpr double kFirstScan = 1.0;  // a scanner sends its first one within [s]

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
  found.kind = "laser scanner";
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

/// Every kind of device that can be told apart; the first one that answers has it.
using Probe = std::optional<FoundDevice> (*)(const std::string& word);
constexpr Probe kProbes[] = {probe_scanner};

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
