#include <benchmark/benchmark.h>

#include <cstdio>

#include "bench/scoring_data.h"
#include "scoring/alignment/alignment.h"
#include "tests/support/scoring_maze.h"

/// Alignment without a guess on the 84 labelled sensor-map pairs (RUBBLE_DATA/alignment), and on pairs that do not
/// belong together: mirrored ones and maps of the other building.
namespace rubble::scoring {
namespace {

using namespace testing;

void BM_AlignSensorMaps(benchmark::State& state) {
  const std::optional<SensorMaps> data = load_sensor_maps(state);
  if (!data) return;
  const auto& [pairs, maps] = *data;
  int right = 0;
  int trusted = 0;
  int right_and_trusted = 0;
  for (auto _ : state) {
    right = trusted = right_and_trusted = 0;
    for (const LabelledPair& pair : pairs) {
      const Alignment found = align(maps.at(pair.map_a), maps.at(pair.map_b));
      const double error = mean_error(pair, found.T_truth_map);
      const bool good = error <= allowed_error(pair);
      right += good ? 1 : 0;
      trusted += found.aligned ? 1 : 0;
      right_and_trusted += good && found.aligned ? 1 : 0;
      std::printf("%-7s %-7s error %5.2f m, allowed %4.2f, %-5s %-11s log odds %.2f runner-up %.2f mirrored %.2f\n",
                  pair.map_a.c_str(), pair.map_b.c_str(), error, allowed_error(pair), good ? "right" : "WRONG",
                  found.aligned ? "aligned" : "not aligned", found.log_odds, found.runner_up, found.mirrored);
    }
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
  state.counters["right"] = right;
  state.counters["aligned"] = trusted;
  state.counters["right_and_aligned"] = right_and_trusted;
  state.counters["wrong_but_aligned"] = trusted - right_and_trusted;
}
BENCHMARK(BM_AlignSensorMaps)->Unit(benchmark::kSecond)->Iterations(1);

/// Every fourth pair, 1 % of the one map's free cells turned into walls.
void BM_AlignSaltedMaps(benchmark::State& state) {
  const std::optional<SensorMaps> data = load_sensor_maps(state);
  if (!data) return;
  const auto& [pairs, maps] = *data;
  int tried = 0;
  int right = 0;
  int right_and_trusted = 0;
  int wrong_but_trusted = 0;
  for (auto _ : state) {
    tried = right = right_and_trusted = wrong_but_trusted = 0;
    for (std::size_t i = 0; i < pairs.size(); i += 4) {
      const Alignment found = align(with_salt(maps.at(pairs[i].map_a), 0.01, i), maps.at(pairs[i].map_b));
      const bool good = mean_error(pairs[i], found.T_truth_map) <= allowed_error(pairs[i]);
      ++tried;
      right += good ? 1 : 0;
      right_and_trusted += good && found.aligned ? 1 : 0;
      wrong_but_trusted += !good && found.aligned ? 1 : 0;
    }
  }
  state.counters["pairs"] = tried;
  state.counters["right"] = right;
  state.counters["right_and_aligned"] = right_and_trusted;
  state.counters["wrong_but_aligned"] = wrong_but_trusted;
}
BENCHMARK(BM_AlignSaltedMaps)->Unit(benchmark::kSecond)->Iterations(1);

void BM_AlignStrangers(benchmark::State& state) {
  const std::optional<SensorMaps> data = load_sensor_maps(state);
  if (!data) return;
  const auto& [pairs, maps] = *data;
  int tried = 0;
  int accepted = 0;
  for (auto _ : state) {
    tried = accepted = 0;
    for (std::size_t i = 0; i < pairs.size(); i += 4) {
      ++tried;
      accepted += align(mirrored(maps.at(pairs[i].map_a)), maps.at(pairs[i].map_b)).aligned ? 1 : 0;
    }
    int k = 0;
    for (const auto& [name_a, a] : maps)
      for (const auto& [name_b, b] : maps) {
        if (name_a.front() == name_b.front() || k++ % 4 != 0) continue;
        ++tried;
        accepted += align(a, b).aligned ? 1 : 0;
      }
  }
  state.counters["tried"] = tried;
  state.counters["wrongly_aligned"] = accepted;
}
BENCHMARK(BM_AlignStrangers)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
