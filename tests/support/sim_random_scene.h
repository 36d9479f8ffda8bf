#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "base/angle.h"
#include "base/rng.h"
#include "sim/body/clutter.h"
#include "sim/body/world.h"

namespace rubble::sim::test {

/// A generated maze with ramps, for comparing casters.
inline arenas::Arena random_maze(std::uint64_t seed) {
  arenas::GenerateConfig config;
  config.columns = 5;
  config.rows = 5;
  config.seed = seed;
  config.ramps = 0.5;
  config.paper = 0.3;
  return arenas::parse_arena(arenas::generate_arena(config), "generated");
}

/// A robot somewhere on the floor of `arena`, clear of walls by 0.3 m; any heading and tilt.
inline WorldState random_state(const arenas::Arena& arena, Rng& rng) {
  WorldState state;
  for (;;) {
    const double x = rng.uniform(arena.min_corner.x, arena.max_corner.x);
    const double y = rng.uniform(arena.min_corner.y, arena.max_corner.y);
    bool clear = arenas::floor_height(arena, {x, y}) > -10.0;
    for (const arenas::Solid& solid : arena.solids) {
      double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
      for (const auto& p : solid.outline) {
        x0 = std::min(x0, p.x);
        y0 = std::min(y0, p.y);
        x1 = std::max(x1, p.x);
        y1 = std::max(y1, p.y);
      }
      clear = clear && !(x > x0 - 0.3 && x < x1 + 0.3 && y > y0 - 0.3 && y < y1 + 0.3);
    }
    if (!clear) continue;
    const double heading = rng.uniform(-kPi, kPi);
    const double pitch = rng.uniform(-0.25, 0.25);
    const double roll = rng.uniform(-0.25, 0.25);
    state.pose = {x, y, heading};
    state.stance = {arenas::floor_height(arena, {x, y}), pitch, roll};
    return state;
  }
}

/// Balls on the floor of `arena`, none nearer than half a metre to the robot.
inline std::vector<Sphere> random_balls(const arenas::Arena& arena, const WorldState& state, int count, Rng& rng) {
  std::vector<Sphere> balls;
  while (static_cast<int>(balls.size()) < count) {
    const double x = rng.uniform(arena.min_corner.x, arena.max_corner.x);
    const double y = rng.uniform(arena.min_corner.y, arena.max_corner.y);
    const double radius = rng.uniform(0.05, 0.3);
    const double floor = arenas::floor_height(arena, {x, y});
    if (floor < -10.0 || std::hypot(x - state.pose.x, y - state.pose.y) < 0.6) continue;
    balls.push_back({x, y, floor + radius, radius});
  }
  return balls;
}

}  // namespace rubble::sim::test
