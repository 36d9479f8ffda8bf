#pragma once

#include <cstdint>
#include <cstdlib>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"
#include "tests/support/scoring_maze.h"

/// The grounds over which the laws of the score are tried: plain mazes, and arenas of the project's own generator.
namespace rubble::scoring::testing {

struct Ground {
  std::string kind = "maze";  ///< maze: `maze()`; yellow, orange, red: a generated arena
  int columns = 7;            ///< pallets
  int rows = 7;
  std::uint64_t seed = 1;

  std::string name() const {
    return kind + "_" + std::to_string(columns) + "x" + std::to_string(rows) + "_seed" + std::to_string(seed);
  }
};

/// What a failing test prints of it.
inline void PrintTo(const Ground& ground, std::ostream* out) { *out << ground.name(); }

inline OccupancyGrid truth_of(const Ground& ground) {
  if (ground.kind == "maze") return maze_of(ground.seed, ground.columns, ground.rows);
  arenas::GenerateConfig config;
  config.kind = arenas::arena_kind(ground.kind);
  config.columns = ground.columns;
  config.rows = ground.rows;
  config.seed = ground.seed;
  return arenas::truth_map(arenas::parse_arena(arenas::generate_arena(config), ground.name()));
}

/// Two mazes and four arenas; with RUBBLE_ARENA_SEEDS=N in the environment N arenas of each shape instead.
inline std::vector<Ground> grounds() {
  const char* seeds = std::getenv("RUBBLE_ARENA_SEEDS");
  if (seeds == nullptr)
    return {{"maze", 7, 7, 1},    {"maze", 7, 7, 2},    {"yellow", 6, 7, 11},
            {"yellow", 9, 5, 12}, {"orange", 6, 6, 13}, {"orange", 7, 8, 14}};
  std::vector<Ground> out;
  for (std::uint64_t seed = 1; seed <= std::strtoull(seeds, nullptr, 10); ++seed)
    for (const auto& [kind, columns, rows] :
         {std::tuple{"yellow", 7, 7}, {"yellow", 9, 6}, {"yellow", 5, 8}, {"orange", 6, 8}, {"orange", 10, 7}})
      out.push_back({kind, columns, rows, seed});
  return out;
}

}  // namespace rubble::scoring::testing
