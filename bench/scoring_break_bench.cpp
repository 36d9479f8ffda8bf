#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/angle.h"
#include "bench/scoring_data.h"
#include "scoring/scorecard.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_break.h"

/// Maps of real buildings, drawn by robots (RUBBLE_DATA/alignment) and floor plans (RUBBLE_DATA/rooms), that came apart
/// in their middle: does the score with --warp say so, and where and how far? Beside them the same maps whole.
/// RUBBLE_EVERY=N takes every N-th map.
namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

struct NamedMap {
  std::string name;
  OccupancyGrid map;
};

struct Tally {
  int broken = 0;
  int found = 0;
  int measured = 0;  ///< of those, within 0.15 m, 0.6 deg and a seam 1.5 m from the one planted
  int whole = 0;
  int false_alarms = 0;
};

void try_one(const NamedMap& one, Tally& tally) {
  ScoreConfig config;
  config.warp = true;
  const OccupancyGrid truth = crop_to_known(one.map, 0.0);
  const GridFrame f = truth.frame();
  const TPoint2D middle(f.x0 + 0.5 * f.width * f.resolution, f.y0 + 0.5 * f.height * f.resolution);
  for (const double deg : {2.1, 0.0}) {
    const double apart = deg > 0.0 ? 0.31 : 0.5;  // [m]
    const TPose2D T = testing::about(middle, deg, 0.6 * apart, -0.8 * apart);
    const OccupancyGrid map = crop_to_known(testing::come_apart(truth, middle.x, T), 0.0);
    const MapScore score = score_map(map, truth, config);
    const MapBreak& seam = score.broken;
    const double x = 0.5 * (seam.from.x + seam.to.x);
    ++tally.broken;
    tally.found += seam.found ? 1 : 0;
    const bool measured = seam.found && std::abs(std::abs(rad_to_deg(seam.turned_rad)) - deg) < 0.6 &&
                          std::abs(seam.apart_m - apart) < 0.15 && std::abs(x - middle.x) < 1.5;
    tally.measured += measured ? 1 : 0;
    std::printf("%-12s %.1f deg %.2f m: %s %.2f deg %.2f m, seam %.1f m off, score %.3f, bent %.3f, mended %.3f%s\n",
                one.name.c_str(), deg, apart, seam.found ? "found" : "MISSED", rad_to_deg(seam.turned_rad),
                seam.apart_m, seam.found ? x - middle.x : 0.0, score.score, score.warped_score, score.mended_score,
                score.aligned ? "" : ", refused");
    std::fflush(stdout);
  }
  ++tally.whole;
  tally.false_alarms += score_map(truth, truth, config).broken.found ? 1 : 0;
}

void BM_Breaks(benchmark::State& state) {
  const std::optional<SensorMaps> data = load_sensor_maps(state);
  if (!data) return;
  const std::optional<std::vector<LabelledFloor>> floors = load_floors(state, false);
  if (!floors) return;
  std::vector<NamedMap> maps;
  for (const auto& [name, map] : data->maps) maps.push_back({name, map});
  for (const LabelledFloor& floor : *floors) maps.push_back({floor.floor.name, floor.map});
  const char* every = std::getenv("RUBBLE_EVERY");
  const auto step = static_cast<std::size_t>(every == nullptr ? 1 : std::max(1, std::atoi(every)));
  for (auto _ : state) {
    Tally tally;
    for (std::size_t i = 0; i < maps.size(); i += step) try_one(maps[i], tally);
    state.counters["broken"] = tally.broken;
    state.counters["found"] = tally.found;
    state.counters["measured"] = tally.measured;
    state.counters["whole"] = tally.whole;
    state.counters["false_alarms"] = tally.false_alarms;
  }
}
BENCHMARK(BM_Breaks)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
