#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>

#include "bench/scoring_data.h"
#include "scoring/pictures/room_picture.h"
#include "scoring/rooms/room_hypotheses.h"

/// Rooms found on the public floor maps (RUBBLE_DATA/rooms), plain and furnished, against those drawn by hand.
/// One table a method: bench/scoring_rooms_bench. With RUBBLE_PICTURES=FOLDER the rooms are drawn as well.
namespace rubble::scoring {
namespace {

using namespace testing;

void print_row(const char* name, const RoomAgreement& a) {
  std::printf("  %-22s %9.1f %7.1f %6.3f %7.3f %9d %6d\n", name, 100.0 * a.precision, 100.0 * a.recall, a.iou, a.strict,
              a.segments, a.rooms);
}

struct Mean {
  RoomAgreement sum;
  int maps = 0;
  void add(const RoomAgreement& a) {
    sum.precision += a.precision;
    sum.recall += a.recall;
    sum.iou += a.iou;
    sum.strict += a.strict;
    sum.segments += a.segments;
    sum.rooms += a.rooms;
    ++maps;
  }
  RoomAgreement value() const {
    RoomAgreement mean = sum;
    for (double* v : {&mean.precision, &mean.recall, &mean.iou, &mean.strict}) *v /= maps;
    return mean;
  }
};

void BM_Rooms(benchmark::State& state) {
  const bool furnished = state.range(1) != 0;
  const std::optional<std::vector<LabelledFloor>> floors = load_floors(state, furnished);
  if (!floors) return;
  const char* pictures = std::getenv("RUBBLE_PICTURES");
  RoomConfig config;
  config.method = state.range(0) == 0 ? RoomMethod::Passages : RoomMethod::Visibility;
  const std::string title =
      std::string(state.range(0) == 0 ? "passages" : "visibility clusters") + (furnished ? ", furnished" : ", plain");
  Mean all;
  Mean tuned;
  Mean held;
  double slowest_s = 0.0;
  for (auto _ : state) {
    std::printf("%-24s precision  recall    IoU  strict  segments  rooms\n", title.c_str());
    for (const auto& [floor, map, truth] : *floors) {
      const double start_s = cpu_s();
      const Rooms rooms = extract_rooms(map, config);
      slowest_s = std::max(slowest_s, cpu_s() - start_s);
      const RoomAgreement agreement = compare_rooms(rooms.labels, truth);
      print_row(floor.name, agreement);
      all.add(agreement);
      (floor.tuned ? tuned : held).add(agreement);
      if (pictures != nullptr)
        write_rooms_png(std::string(pictures) + "/" + floor.name + (furnished ? "_furnished" : "_plain") +
                            (state.range(0) == 0 ? ".png" : "_visibility.png"),
                        map, rooms);
    }
    print_row("mean, tuned on", tuned.value());
    print_row("mean, not tuned on", held.value());
    print_row("mean", all.value());
  }
  state.counters["maps"] = all.maps;
  state.counters["precision"] = all.value().precision;
  state.counters["recall"] = all.value().recall;
  state.counters["iou"] = all.value().iou;
  state.counters["strict_iou"] = all.value().strict;
  state.counters["slowest_s"] = slowest_s;
}
BENCHMARK(BM_Rooms)
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->ArgNames({"visibility", "furnished"})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

/// Poses that rooms alone propose for the 84 labelled sensor-map pairs: how often the first one, and any of the list,
/// is right by the rule of the alignment benchmark made twice as wide, which refinement is meant to close.
void BM_RoomHypotheses(benchmark::State& state) {
  const std::optional<SensorMaps> data = load_sensor_maps(state);
  if (!data) return;
  const auto& [pairs, maps] = *data;
  int first = 0;
  int any = 0;
  double count = 0.0;
  for (auto _ : state) {
    for (const LabelledPair& pair : pairs) {
      const std::vector<PoseGuess> found = propose_by_rooms(maps.at(pair.map_a), maps.at(pair.map_b)).guesses;
      const auto right = [&](const PoseGuess& h) {
        return mean_error(pair, h.T_truth_map) <= 2.0 * allowed_error(pair);
      };
      first += !found.empty() && right(found.front()) ? 1 : 0;
      any += std::any_of(found.begin(), found.end(), right) ? 1 : 0;
      count += static_cast<double>(found.size());
    }
  }
  state.counters["pairs"] = static_cast<double>(pairs.size());
  state.counters["first_right"] = first;
  state.counters["any_right"] = any;
  state.counters["hypotheses"] = count / static_cast<double>(pairs.size());
}
BENCHMARK(BM_RoomHypotheses)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
