#pragma once

#include <cmath>
#include <functional>
#include <optional>

#include "arenas/model/arena.h"
#include "sim/sim_robot.h"

namespace rubble::sim::test {

inline arenas::Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// A level floor at height z and nothing else; the robot starts at the origin, looking along x.
inline arenas::Arena flat_floor(double x0, double y0, double x1, double y1, double z = 0.0) {
  arenas::Arena arena;
  arena.name = "test";
  arena.min_corner = {x0, y0};
  arena.max_corner = {x1, y1};
  arena.floor.push_back({rectangle(x0, y0, x1, y1), z, 0.0, 0.0, "flat"});
  return arena;
}

/// A floor that rises along x by `angle`, with height z at x0.
inline void add_ramp(arenas::Arena& arena, double x0, double y0, double x1, double y1, double angle, double z = 0.0) {
  arena.floor.push_back({rectangle(x0, y0, x1, y1), z, std::tan(angle), 0.0, "pitch_ramp"});
}

inline arenas::Arena slope(double x0, double y0, double x1, double y1, double angle) {
  arenas::Arena arena = flat_floor(x0, y0, x1, y1);
  arena.floor.clear();
  add_ramp(arena, x0, y0, x1, y1, angle, x0 * std::tan(angle));
  return arena;
}

/// An axis-parallel box from the floor up.
inline void add_wall(arenas::Arena& arena, double x0, double y0, double x1, double y1, double height = 1.2,
                     double bottom = 0.0) {
  arena.solids.push_back({rectangle(x0, y0, x1, y1), bottom, height, "wall"});
}

/// Walls all round, 20 mm thick, inside the given rectangle's border.
inline arenas::Arena room(double x0, double y0, double x1, double y1) {
  arenas::Arena arena = flat_floor(x0, y0, x1, y1);
  add_wall(arena, x0, y0, x1, y0 + 0.02);
  add_wall(arena, x0, y1 - 0.02, x1, y1);
  add_wall(arena, x0, y0, x0 + 0.02, y1);
  add_wall(arena, x1 - 0.02, y0, x1, y1);
  return arena;
}

/// Exact sensors: what is left is geometry and friction.
inline SimConfig exact() {
  SimConfig config;
  config.range_noise = 0.0;
  config.acceleration_noise = 0.0;
  return config;
}

/// Reads ticks for `seconds` under one command; `see` gets each.
inline void run(SimRobot& robot, const robot::Commands& commands, double seconds,
                const std::function<void(const robot::Inputs&)>& see = {}) {
  const int ticks = static_cast<int>(std::lround(seconds / robot.model().tick));
  for (int i = 0; i < ticks; ++i) {
    robot.command(commands);
    const std::optional<robot::Inputs> inputs = robot.read();
    if (!inputs) return;
    if (see) see(*inputs);
  }
}

inline robot::Commands drive(double v, double w = 0.0) { return {{v, w}, {}}; }

}  // namespace rubble::sim::test
