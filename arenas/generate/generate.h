#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// Yellow: drivable throughout; orange, red: with that kind's obstacles.
enum class ArenaKind { Yellow, Orange, Red };

/// "yellow", "orange", "red": as files and options call them, in the order of ArenaKind.
const std::vector<std::string>& arena_kinds();
std::string name_of(ArenaKind kind);
/// The league's fourth kind, and why none is generated.
inline constexpr const char* kBlueArena = "blue";
inline constexpr const char* kNoBlueArena =
    "a blue arena asks to grasp objects and put them down, and the robot has no arm: use yellow, orange or red; "
    "'objects' of an arena file lays bottles and radios out";
/// Throws InputError for another name.
ArenaKind arena_kind(const std::string& name);

/// What a generated arena shall be like.
struct GenerateConfig {
  ArenaKind kind = ArenaKind::Yellow;
  int columns = 8;  ///< pallets west-east, 2..60
  int rows = 8;     ///< pallets south-north, 2..60
  std::uint64_t seed = 1;
  double ramps = 0.3;   ///< share of pallets that are 10 deg ramps, 0..1 (reached as far as drivability allows)
  double paper = 0.1;   ///< share of pallets with loose or crumpled paper, 0..1
  double loops = 0.2;   ///< share of the inner walls of a perfect maze taken away, 0..1
  double rough = 0.25;  ///< orange, red: share of pallets with the kind's obstacles (reached as far as the maze allows)
  int victims = 4;
  double sound_alone = 0.0;  ///< share of the victims that are heard only, neither seen nor warm, 0..1
  double co2_alone = 0.0;    ///< share that is smelt only; both shares together no more than 1
  double ramp_deg = 10.0;
};

/// The YAML text of a random arena: a maze in which every pallet can be reached without a step the robot cannot take;
/// in orange and red ones every pallet but those with obstacles, which all lie beside the others.
/// Same config, same bytes. Throws InputError on values out of range.
std::string generate_arena(const GenerateConfig& config);

}  // namespace rubble::arenas
