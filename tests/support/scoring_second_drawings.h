#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "scoring/walls/resample.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_schemes.h"

/// Schemes of a team that cannot tell which of two drawings is right, and hands in both on one canvas, joined. Written
/// when version 9 of the score stood.
namespace rubble::scoring::testing {

/// The drawing so many times as wide and high as it is, on cells of the same size. No wall is lost between them.
inline OccupancyGrid drawn_at(const OccupancyGrid& map, double wide, double high) {
  GridFrame frame = map.frame();
  frame.width = static_cast<int>(std::lround(map.width() * wide));
  frame.height = static_cast<int>(std::lround(map.height() * high));
  OccupancyGrid out(frame);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      out[{x, y}] = map[{std::min(map.width() - 1, static_cast<int>((x + 0.5) / wide)),
                         std::min(map.height() - 1, static_cast<int>((y + 0.5) / high))}];
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const Cell to{static_cast<int>((x + 0.5) * wide), static_cast<int>((y + 0.5) * high)};
      if (map[{x, y}] == Occupancy::Occupied && out.inside(to)) out[to] = Occupancy::Occupied;
    }
  return out;
}

/// What lies east of a line past the middle is moved by `metres` and turned by `turn` [rad].
inline OccupancyGrid came_apart(const OccupancyGrid& map, double metres, double turn) {
  const TPoint2D m = middle_of(map);
  const OccupancyGrid wide = padded(map, static_cast<int>(std::lround(3.0 / map.resolution())));
  return replaced(wide, displaced(wide, 0.8 * metres, 0.6 * metres, turn),
                  [&](const TPoint2D& p) { return p.x > m.x + 0.6; });
}

inline std::vector<Scheme> second_drawings() {
  using Grid = const OccupancyGrid&;
  using Seed = std::uint64_t;
  using Drawing = std::function<OccupancyGrid(Grid)>;
  const auto worn = [](Grid truth, Seed seed) { return with_gaps(with_phantoms(truth, 6, seed), 12, seed); };
  std::vector<Scheme> out;
  const auto add = [&](const std::string& name, const Drawing& other) {
    for (const bool clean : {true, false}) {
      const auto first = [=](Grid truth, Seed seed) { return clean ? truth : worn(truth, seed); };
      out.push_back(
          {"two drawings, the other " + name + (clean ? "" : ", both worn"),
           [=](Grid truth, Seed seed) {
             return std::vector<OccupancyGrid>{first(truth, seed), other(first(truth, seed))};
           },
           [=](Grid truth, Grid, Seed seed) { return joined_to(first(truth, seed), other(first(truth, seed))); }});
    }
  };
  const auto number = [](double value) {
    char text[16];
    std::snprintf(text, sizeof text, "%.2g", value);
    return std::string(text);
  };
  for (const double size : {0.4, 0.5, 0.62, 1.6, 2.0, 2.7})
    add(number(size) + " times as large", [=](Grid map) { return drawn_at(map, size, size); });
  for (const double factor : {0.75, 1.15, 1.25, 1.6})
    add(number(factor) + " times as wide", [=](Grid map) { return drawn_at(map, factor, 1.0); });
  add("in a mirror", [](Grid map) { return mirror_image(map); });
  for (const double turn : {0.1, 0.2, 0.35, 0.5})
    add("came apart by 0.5 m and " + number(turn) + " rad", [=](Grid map) { return came_apart(map, 0.5, turn); });
  for (const double metres : {1.2, 2.0})
    add("came apart by " + number(metres) + " m and 0.1 rad", [=](Grid map) { return came_apart(map, metres, 0.1); });
  return out;
}

}  // namespace rubble::scoring::testing
