#include "base/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "base/angle.h"
#include "base/error.h"

namespace rubble {

using mrpt::math::TPose2D;

TPose2D interpolate(const TPose2D& a, const TPose2D& b, double u) {
  return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y), wrap_angle(a.phi + u * wrap_angle(b.phi - a.phi))};
}

std::optional<TPose2D> pose_at(const Trajectory& trajectory, Stamp stamp) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& p, Stamp s) { return p.stamp < s; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  return interpolate(before->pose, after->pose, (stamp - before->stamp) / (after->stamp - before->stamp));
}

std::string tum_line(const StampedPose& stamped) {
  char line[160];
  const double half = 0.5 * wrap_angle(stamped.pose.phi);
  const long long seconds = static_cast<long long>(stamped.stamp.ns / 1000000000);
  const long long nanos = static_cast<long long>(stamped.stamp.ns % 1000000000);
  std::snprintf(line, sizeof line, "%lld.%09lld %.6f %.6f 0.000000 0.000000 0.000000 %.9f %.9f", seconds, nanos,
                stamped.pose.x, stamped.pose.y, std::sin(half), std::cos(half));
  return line;
}

void write_tum(const std::string& path, const Trajectory& trajectory) {
  std::ofstream file(path);
  for (const auto& stamped : trajectory) file << tum_line(stamped) << '\n';
  file.flush();
  if (!file) throw RunError(path + ": cannot be written; check the folder and the free space");
}

Trajectory read_tum(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be opened; give the path of a TUM trajectory (time x y z qx qy qz qw)");
  Trajectory trajectory;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    if (text.empty() || text[0] == '#' || text == "\r") continue;
    std::istringstream fields(text);
    long double t = 0;  // a Unix time with nanoseconds needs more than 53 bits
    double x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1;
    if (!(fields >> t >> x >> y >> z >> qx >> qy >> qz >> qw) || !std::isfinite(x + y + qx + qy + qz + qw))
      throw InputError(at(path, line, 1, "needs 8 numbers 'time x y z qx qy qz qw'"));
    const double yaw = std::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz));
    const Stamp stamp{static_cast<std::int64_t>(std::llround(t * 1e9L))};
    if (!trajectory.empty() && stamp <= trajectory.back().stamp)
      throw InputError(at(path, line, 1, "the time does not increase; sort the file by time"));
    trajectory.push_back({stamp, {x, y, yaw}});
  }
  return trajectory;
}

}  // namespace rubble
