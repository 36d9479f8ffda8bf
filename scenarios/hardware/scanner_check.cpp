#include "scenarios/hardware/scanner_check.h"

#include <cctype>
#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "base/text/words.h"

namespace rubble::scenarios {
namespace {

using robot::LaserModel;

/// Drivers and firmwares disagree by a beam or two about where a scan ends.
constexpr double kBeams = 0.02;               ///< share
const double kBearing = deg_to_rad(2.0);      ///< of the first and the last beam
constexpr double kRange = 0.05, kTurn = 0.1;  ///< shares

/// The scanner of laser_names() that calls itself so; "URG-04LX-UG01" is no "URG-04LX". Empty: none of them.
std::string known_name(const std::string& told) {
  for (const std::string& name : robot::laser_names()) {
    const auto at = told.find(name);
    if (name == robot::kGenericLaser || at == std::string::npos) continue;
    const char next = at + name.size() < told.size() ? told[at + name.size()] : ' ';
    if (std::isalnum(static_cast<unsigned char>(next)) == 0 && next != '-') return name;
  }
  return "";
}

bool has_other_geometry(const LaserModel& found, const LaserModel& file) {
  const auto last = [](const LaserModel& laser) { return laser.angle_min + laser.field_of_view(); };
  return std::abs(found.beams - file.beams) > kBeams * file.beams ||
         std::abs(found.angle_min - file.angle_min) > kBearing || std::abs(last(found) - last(file)) > kBearing ||
         found.range_max < (1.0 - kRange) * file.range_max ||
         std::abs(found.scan_period - file.scan_period) > kTurn * file.scan_period;
}

std::string text_of(const LaserModel& laser) {
  char text[120];
  std::snprintf(text, sizeof text, "%d beams over %.0f deg up to %.3g m, %.3g turns a second", laser.beams,
                rad_to_deg(laser.field_of_view()), laser.range_max, 1.0 / laser.scan_period);
  return text;
}

std::string remedy(const std::string& known, const LaserModel& found, const LaserModel& file) {
  if (!known.empty() && known != file.name) return "give --set robot.laser.model=" + known;
  if (known == file.name && !known.empty()) return "correct the numbers under robot.laser";
  char text[200];
  std::snprintf(text, sizeof text,
                "give model: generic, beams: %d, field_of_view_deg: %.4g, scan_period_s: %.3g and max_range_m: %.3g "
                "under robot.laser",
                found.beams, rad_to_deg(found.field_of_view()), found.scan_period, found.range_max);
  return text;
}

}  // namespace

std::string scanner_mismatch(const robot::ScannerInfo& found, const LaserModel& file) {
  if (found.model.empty()) return "";
  const std::string known = known_name(found.model);
  const bool other_name = !known.empty() && known != file.name && file.name != robot::kGenericLaser;
  if (!other_name && !has_other_geometry(found.laser, file)) return "";
  const std::string name = known.empty() ? one_line(found.model) : known;
  return "it is a " + name + " (" + text_of(found.laser) + "), but the robot file is of a " + file.name + " (" +
         text_of(file) + "), so the map will be poorer; " + remedy(known, found.laser, file) + ", or change the file";
}

}  // namespace rubble::scenarios
