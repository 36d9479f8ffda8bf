#pragma once

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "tests/support/scoring_floor_maps.h"
#include "tests/support/scoring_pairs.h"

/// The public maps that benchmarks of the scoring work on: RUBBLE_DATA names the folder, docs/scoring_measured.md what
/// lies in it.
namespace rubble::scoring {

/// The part `name` of the data; none, and the benchmark is skipped with the remedy, where it is not there.
inline std::optional<std::string> data_folder(benchmark::State& state, const std::string& name) {
  const char* data = std::getenv("RUBBLE_DATA");
  const std::string folder = (data == nullptr ? std::string() : std::string(data)) + "/" + name;
  if (data == nullptr)
    state.SkipWithError("set RUBBLE_DATA to the folder with the public data (docs/scoring_measured.md)");
  else if (!std::filesystem::is_directory(folder))
    state.SkipWithError((folder + ": no such folder; docs/scoring_measured.md says what belongs in it").c_str());
  else
    return folder;
  return std::nullopt;
}

/// The labelled pairs of sensor maps and the maps themselves.
struct SensorMaps {
  std::vector<testing::LabelledPair> pairs;
  std::map<std::string, OccupancyGrid> maps;
};

inline std::optional<SensorMaps> load_sensor_maps(benchmark::State& state) {
  const std::optional<std::string> folder = data_folder(state, "alignment");
  if (!folder) return std::nullopt;
  try {
    SensorMaps out;
    out.pairs = testing::load_pairs(*folder);
    out.maps = testing::load_maps(*folder, out.pairs);
    return out;
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
    return std::nullopt;
  }
}

/// A floor map and its rooms drawn by hand.
struct LabelledFloor {
  testing::FloorMap floor;
  OccupancyGrid map;
  cv::Mat rooms;
};

inline std::optional<std::vector<LabelledFloor>> load_floors(benchmark::State& state, bool furnished) {
  const std::optional<std::string> folder = data_folder(state, "rooms");
  if (!folder) return std::nullopt;
  try {
    std::vector<LabelledFloor> out;
    for (const testing::FloorMap& floor : testing::floor_maps()) {
      const std::string base = *folder + "/" + floor.name;
      out.push_back({floor, testing::read_floor_map(base + (furnished ? "_furnitures.png" : ".png")),
                     testing::read_true_rooms(base + "_gt_segmentation.png")});
    }
    return out;
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
    return std::nullopt;
  }
}

/// CPU time of this process [s].
inline double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace rubble::scoring
