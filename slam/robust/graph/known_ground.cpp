#include "slam/robust/graph/known_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kTurnWeight = 0.3;     ///< [m] that a key frame may be farther off for looking 1 rad less aside
constexpr double kKnownDistance = 0.6;  ///< ground is known within this of an old key frame [m] ...
constexpr double kKnownTurn = 0.5;      ///< ... looking the same way [rad] ...
constexpr double kKnownPath = 6.0;      ///< ... to which the graph leads so directly, though the drive was longer [m]

}  // namespace

int closest_frame(const KeyFrames& frames, const TPose2D& T_map_base) {
  int closest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j < frames.size(); ++j) {
    const TPose2D& old = frames.pose(j);
    const double off = length(T_map_base.x - old.x, T_map_base.y - old.y) +
                       kTurnWeight * std::abs(wrap_angle(T_map_base.phi - old.phi));
    if (off >= least) continue;
    least = off;
    closest = j;
  }
  return closest;
}

std::vector<int> frames_around(const KeyFrames& frames, int here, double distance, int most) {
  std::vector<std::pair<double, int>> close;
  for (int j = 0; j < frames.size(); ++j) {
    const double away = length(frames.pose(j).x - frames.pose(here).x, frames.pose(j).y - frames.pose(here).y);
    if (away <= distance) close.emplace_back(j == here ? -1.0 : away, j);
  }
  std::sort(close.begin(), close.end());
  if (close.size() > static_cast<std::size_t>(most)) close.resize(static_cast<std::size_t>(most));
  std::vector<int> around;
  for (const auto& [away, j] : close) around.push_back(j);
  return around;
}

std::optional<int> frame_of_earlier_visit(const KeyFrames& frames, const TPose2D& T_map_base, int here, double path,
                                          double least_path, Work* work) {
  std::vector<int> close;
  std::vector<double> off;
  for (int j = 0; j < frames.size(); ++j) {
    if (path - frames[j].path < least_path) continue;
    const TPose2D& old = frames.pose(j);
    const double distance = length(T_map_base.x - old.x, T_map_base.y - old.y);
    const double turn = std::abs(wrap_angle(T_map_base.phi - old.phi));
    if (distance > kKnownDistance || turn > kKnownTurn) continue;
    close.push_back(j);
    off.push_back(distance + turn);
  }
  if (close.empty()) return std::nullopt;
  const std::vector<double> paths = frames.paths_from(here, close, kKnownPath, work);
  std::optional<int> old;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < close.size(); ++k) {
    if (!(paths[k] <= kKnownPath) || off[k] >= least) continue;
    least = off[k];
    old = close[k];
  }
  return old;
}

}  // namespace rubble::slam
