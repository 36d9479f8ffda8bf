#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "robot/drivers/probe/probe.h"

namespace rubble::robot {
namespace {

constexpr double kWide = 2.0;  // a character is about twice as high as wide

}  // namespace

std::string scan_picture(const LaserScan& scan, double radius, int rows) {
  const int columns = static_cast<int>(kWide * rows) + 1;
  const double pitch = 2.0 * radius / rows;
  std::vector<std::string> lines(static_cast<std::size_t>(rows), std::string(static_cast<std::size_t>(columns), ' '));
  // Forward is up, left is left.
  const auto mark = [&](double range, double bearing, char sign) {
    const int row = static_cast<int>(std::floor((radius - range * std::cos(bearing)) / pitch));
    const int column = static_cast<int>(std::lround((radius - range * std::sin(bearing)) / pitch * kWide));
    if (row < 0 || row >= rows || column < 0 || column >= columns) return;
    char& place = lines[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    if (place != '#') place = sign;
  };
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = static_cast<double>(scan.ranges[i]);
    if (std::isnan(range)) continue;
    const double seen = std::min(range, radius * 1.5);
    for (double r = 0.5 * pitch; r < seen; r += 0.5 * pitch) mark(r, scan.bearing(i), '.');
  }
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (std::isfinite(scan.ranges[i])) mark(static_cast<double>(scan.ranges[i]), scan.bearing(i), '#');
  lines[static_cast<std::size_t>(rows / 2)][static_cast<std::size_t>(columns / 2)] = '^';
  std::string picture;
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    picture += line + "\n";
  }
  return picture;
}

std::string scan_summary(const LaserScan& scan) {
  std::size_t measured = 0, unknown = 0, nearest = 0;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (std::isnan(scan.ranges[i])) ++unknown;
    if (!std::isfinite(scan.ranges[i])) continue;
    if (measured == 0 || scan.ranges[i] < scan.ranges[nearest]) nearest = i;
    ++measured;
  }
  char line[160];
  if (measured == 0) {
    std::snprintf(line, sizeof line, "%zu beams, none measured: is the window covered?", scan.ranges.size());
  } else {
    std::snprintf(line, sizeof line, "%zu beams, %zu measured, %zu without a measurement; nearest %.3f m at %.1f deg",
                  scan.ranges.size(), measured, unknown, static_cast<double>(scan.ranges[nearest]),
                  rad_to_deg(scan.bearing(nearest)));
  }
  return line;
}

}  // namespace rubble::robot
