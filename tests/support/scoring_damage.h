#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/scoring_maze.h"

/// The kinds of damage that the laws and the ranking of maps go through, each over growing levels.
namespace rubble::scoring::testing {

struct Damage {
  std::string name;
  std::vector<double> levels;
  std::function<OccupancyGrid(const OccupancyGrid&, double level, std::uint64_t seed)> apply;
};

inline void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

using Levels = std::vector<double>;

/// Levels: sag [m].
inline Damage bending(Levels levels) {
  return {"Bending", std::move(levels),
          [](const OccupancyGrid& map, double bend, std::uint64_t) { return bent(map, bend); }};
}

/// Levels: walls of a metre.
inline Damage phantom_walls(Levels levels) {
  return {"PhantomWalls", std::move(levels), [](const OccupancyGrid& map, double count, std::uint64_t seed) {
            return with_phantoms(map, static_cast<int>(count), seed);
          }};
}

/// Levels: gaps of 0.8 m.
inline Damage erased_walls(Levels levels) {
  return {"ErasedWalls", std::move(levels), [](const OccupancyGrid& map, double count, std::uint64_t seed) {
            return with_gaps(map, static_cast<int>(count), seed);
          }};
}

/// Levels: cells on each side.
inline Damage thickening(Levels levels) {
  return {"Thickening", std::move(levels), [](const OccupancyGrid& map, double cells, std::uint64_t) {
            return thickened(map, static_cast<int>(cells));
          }};
}

/// Levels: share of the map that stays known, falling.
inline Damage lost_coverage(Levels levels) {
  return {"LostCoverage", std::move(levels),
          [](const OccupancyGrid& map, double share, std::uint64_t) { return with_coverage(map, share); }};
}

/// Levels: share of the free cells.
inline Damage salting(Levels levels) {
  return {"Salt", std::move(levels),
          [](const OccupancyGrid& map, double share, std::uint64_t seed) { return with_salt(map, share, seed); }};
}

/// Levels: size of the map over its true size.
inline Damage scale_error(Levels levels) {
  return {"ScaleError", std::move(levels),
          [](const OccupancyGrid& map, double factor, std::uint64_t) { return scaled(map, factor); }};
}

}  // namespace rubble::scoring::testing
