// A mapper in one C++ file, nothing but the standard library:
//   c++ -O2 -o mapper examples/cpp_mapper/mapper.cpp
//   rubble run --mapper-command ./mapper
// It trusts the odometry: each scan is drawn where dead reckoning says it was seen. docs/mapper_protocol.md describes
// what goes over stdin and stdout; what it prints to stderr ends up in mapper.log of the run folder.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Pose {
  double x = 0.0, y = 0.0, phi = 0.0;  // [m], [m], [rad]
};

/// Pose b, given in the frame of pose a, in the frame of a's parent.
Pose compose(const Pose& a, const Pose& b) {
  const double c = std::cos(a.phi), s = std::sin(a.phi);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, std::remainder(a.phi + b.phi, 2.0 * M_PI)};
}

Pose inverse(const Pose& a) {
  const double c = std::cos(a.phi), s = std::sin(a.phi);
  return {-c * a.x - s * a.y, s * a.x - c * a.y, -a.phi};
}

/// Turns a direction in the plane of the scan into one in the base frame, as seen from above: a laser that hangs upside
/// down sees left and right exchanged.
struct Mount {
  double ahead_x, ahead_y, left_x, left_y;

  Mount(double roll, double pitch, double yaw)
      : ahead_x(std::cos(yaw) * std::cos(pitch)),
        ahead_y(std::sin(yaw) * std::cos(pitch)),
        left_x(std::cos(yaw) * std::sin(pitch) * std::sin(roll) - std::sin(yaw) * std::cos(roll)),
        left_y(std::sin(yaw) * std::sin(pitch) * std::sin(roll) + std::cos(yaw) * std::cos(roll)) {}
};

/// Counts of sightings and of hits a cell.
struct Grid {
  static constexpr int kSide = 800;            // cells
  static constexpr double kResolution = 0.05;  // [m]
  std::vector<int> seen = std::vector<int>(kSide * kSide), hit = seen;

  static int cell(double metres) { return static_cast<int>(std::floor(metres / kResolution)) + kSide / 2; }
  void count(double x, double y, bool occupied) {
    const int column = cell(x), row = cell(y);
    if (column < 0 || row < 0 || column >= kSide || row >= kSide) return;
    const auto index = static_cast<std::size_t>(row * kSide + column);
    ++seen[index];
    hit[index] += occupied ? 1 : 0;
  }
  /// The whole map as the protocol wants it: the southernmost row first.
  void print() const {
    std::printf("map %d %d %g %g %g\n", kSide, kSide, kResolution, -0.5 * kSide * kResolution,
                -0.5 * kSide * kResolution);
    std::string row(kSide, '?');
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const auto index = static_cast<std::size_t>(y * kSide + x);
        row[static_cast<std::size_t>(x)] = seen[index] == 0 ? '?' : 3 * hit[index] >= seen[index] ? '#' : '.';
      }
      std::printf("%s\n", row.c_str());
    }
  }
};

/// The next number of a line; strtod also reads inf and nan, which operator>> does not.
double number(std::istringstream& words) {
  std::string word;
  words >> word;
  return std::strtod(word.c_str(), nullptr);
}

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  std::string line, key;
  std::map<std::string, double> header;
  while (std::getline(std::cin, line) && line != "start") {
    std::istringstream words(line);
    words >> key;
    header[key] = number(words);
  }
  if (header["rubble-mapper"] != 1.0) {
    std::fprintf(stderr, "this mapper speaks version 1 of rubble-mapper\n");
    return 1;
  }
  std::printf("ready 1\n");
  std::fflush(stdout);

  const Pose p_base_laser{header["laser.x_m"], header["laser.y_m"], 0.0};
  const Mount mount(header["laser.roll_rad"], header["laser.pitch_rad"], header["laser.yaw_rad"]);
  Grid grid;
  Pose T_odom_first, pose, drawn;
  bool has_odometry = false, changed = false;
  long mapped = 0;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    words >> key;
    if (key == "odometry") {
      number(words);  // the stamp
      Pose odometry;
      odometry.x = number(words);
      odometry.y = number(words);
      odometry.phi = number(words);
      if (!has_odometry) T_odom_first = odometry;
      has_odometry = true;
      pose = compose(inverse(T_odom_first), odometry);
    } else if (key == "scan") {
      const bool moved = std::hypot(pose.x - drawn.x, pose.y - drawn.y) > 0.1 ||
                         std::abs(std::remainder(pose.phi - drawn.phi, 2.0 * M_PI)) > 0.1;
      if (!moved && mapped > 4) continue;
      number(words);  // the stamp
      const double angle_min = number(words), angle_step = number(words);
      number(words);  // the time between two beams
      const double range_min = number(words), range_max = number(words);
      const int beams = static_cast<int>(number(words));
      const Pose laser = compose(pose, p_base_laser);  // its place; headed as the base
      const double c = std::cos(laser.phi), s = std::sin(laser.phi);
      for (int beam = 0; beam < beams; ++beam) {
        const double range = number(words);
        if (!(range >= range_min && range <= range_max)) continue;  // nothing in range, or no measurement
        const double ahead = std::cos(angle_min + beam * angle_step), left = std::sin(angle_min + beam * angle_step);
        const double x = ahead * mount.ahead_x + left * mount.left_x, y = ahead * mount.ahead_y + left * mount.left_y;
        const double dx = c * x - s * y, dy = s * x + c * y;
        for (double r = 0.0; r < range - Grid::kResolution; r += Grid::kResolution)
          grid.count(laser.x + r * dx, laser.y + r * dy, false);
        for (int i = 0; i < 4; ++i) grid.count(laser.x + range * dx, laser.y + range * dy, true);
      }
      drawn = pose;
      ++mapped;
      changed = true;
    } else if (key == "end") {
      std::printf("pose %.9g %.9g %.9g\nmapped %ld\n", pose.x, pose.y, pose.phi, mapped);
      if (changed) grid.print();
      changed = false;
      std::printf("end\n");
      std::fflush(stdout);
    }
  }
}
