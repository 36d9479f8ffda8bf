#include "arenas/truth/unseen.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <utility>

#include "base/angle.h"
#include "base/grid.h"

namespace rubble::arenas {
namespace {

constexpr double kAnySlope = deg_to_rad(89.0);  ///< [rad]
constexpr double kAnyGap = 0.01;                ///< radius of a body that fits through [m]

std::string with_number(const char* format, double value) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

}  // namespace

std::vector<Unseen> unseen_by_cause(const Arena& arena, const OccupancyGrid& truth, const OccupancyGrid& visible,
                                    const Viewer& viewer) {
  std::size_t known = 0;
  std::vector<std::size_t> left;  // cells that are not explained yet
  for (std::size_t i = 0; i < truth.frame().size(); ++i) {
    if (truth.data()[i] == Occupancy::Unknown) continue;
    ++known;
    if (visible.data()[i] == Occupancy::Unknown) left.push_back(i);
  }
  std::vector<Unseen> out;
  const auto explain = [&](const std::string& why, const std::function<bool(std::size_t)>& explains) {
    std::vector<std::size_t> others;
    for (const std::size_t i : left)
      if (!explains(i)) others.push_back(i);
    if (others.size() < left.size())
      out.push_back({why, static_cast<double>(left.size() - others.size()) / static_cast<double>(known)});
    left = std::move(others);
  };
  if (!left.empty()) {
    const Grid<std::uint8_t> seen = visible_mask(arena, truth, reachable_mask(arena, truth, viewer), viewer);
    explain("veils, the foot of steep floor, open ground: a map may show them or not",
            [&](std::size_t i) { return seen.data()[i] != 0; });
  }
  Viewer abler = viewer;
  const auto explain_by = [&](const std::string& why) {
    if (left.empty()) return;
    const OccupancyGrid more = visible_truth(arena, truth, abler);
    explain(why, [&](std::size_t i) { return more.data()[i] != Occupancy::Unknown; });
  };
  abler.max_slope = kAnySlope;
  explain_by(with_number("behind slopes of more than %.0f deg", rad_to_deg(viewer.max_slope)));
  abler.climbable_step = std::max(viewer.climbable_step, viewer.height);
  explain_by(with_number("behind steps and blocks of more than %.2f m", viewer.climbable_step));
  abler.radius = kAnyGap;
  explain_by(with_number("behind gaps of less than %.2f m", 2.0 * viewer.radius));
  explain("behind walls and steps as high as the robot", [](std::size_t) { return true; });
  return out;
}

}  // namespace rubble::arenas
