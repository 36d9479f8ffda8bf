#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/angle.h"
#include "bench/scoring_data.h"
#include "scoring/alignment/alignment.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"

/// Over a thousand pairs of maps that do not belong together, class by class, and beside them pairs that do: of the
/// former none may be called aligned, of the latter few may be lost. RUBBLE_EVERY=N takes every N-th pair of a class,
/// RUBBLE_CLASS=TEXT only classes with this text in their name.
namespace rubble::scoring {
namespace {

using namespace testing;

struct Tally {
  int tried = 0;
  int aligned = 0;
  int wrong = 0;  ///< of the aligned: at another pose than the right one
};

/// Where a map of the class belongs on its truth; none: nowhere.
using IsRight = std::function<bool(const TPose2D& T_truth_map)>;

class Trial {
 public:
  void operator()(const std::string& kind, const std::string& name, const OccupancyGrid& map,
                  const OccupancyGrid& truth, const IsRight& is_right = nullptr) {
    if (kind.find(only_) == std::string::npos || seen_[kind]++ % every_ != 0) return;
    const OccupancyGrid map_known = crop_to_known(map, 0.0);
    const OccupancyGrid truth_known = crop_to_known(truth, 0.0);
    const Alignment found = align(map_known, truth_known);
    const bool right = is_right && is_right(found.T_truth_map);
    Tally& tally = tallies_[kind];
    ++tally.tried;
    tally.aligned += found.aligned ? 1 : 0;
    tally.wrong += found.aligned && !right ? 1 : 0;
    const SightAgreement sights = SightLines(truth_known).at(map_known, PlanarTransform(found.T_truth_map));
    const PoseEvidence& t = found.tight_evidence;
    const PoseEvidence& w = found.wide_evidence;
    std::printf(
        "%s;%s;%s;%s;t %.3f;L %.2f;m %.3f;by %d;score %.3f;known %.3f;kappa %.3f;tight %.3f %.3f %.3f %.3f;"
        "wide %.3f %.3f %.3f %.3f;common %.1f %.3f;mirror %.3f;rival %.3f;%s\n",
        kind.c_str(), name.c_str(), found.aligned ? "aligned" : "refused", right ? "right" : "wrong",
        found.contest.agreement, found.log_odds, found.contest.margin, found.contest.by_agreement ? 1 : 0, sights.score,
        sights.known, sights.kappa, t.map.known, t.map.kappa(), t.truth.known, t.truth.kappa(), w.map.met,
        w.map.contradicted, w.truth.met, w.truth.contradicted, t.common_area, t.free_common, found.mirrored,
        found.runner_up, found.note.c_str());
    std::fflush(stdout);
  }

  void print() const {
    std::printf("%-58s %6s %8s %6s\n", "class", "pairs", "aligned", "wrong");
    for (const auto& [kind, t] : tallies_)
      std::printf("%-58s %6d %8d %6d\n", kind.c_str(), t.tried, t.aligned, t.wrong);
  }
  Tally total(bool strangers) const {
    Tally sum;
    for (const auto& [kind, t] : tallies_)
      if ((kind.rfind("right", 0) != 0) == strangers) {
        sum.tried += t.tried;
        sum.aligned += t.aligned;
        sum.wrong += t.wrong;
      }
    return sum;
  }

 private:
  static int every() {
    const char* text = std::getenv("RUBBLE_EVERY");
    return text == nullptr ? 1 : std::max(1, std::atoi(text));
  }
  static std::string only() {
    const char* text = std::getenv("RUBBLE_CLASS");
    return text == nullptr ? "" : text;
  }
  const int every_ = every();
  const std::string only_ = only();
  std::map<std::string, int> seen_;
  std::map<std::string, Tally> tallies_;
};

/// Within a metre and 0.1 rad of the pose at which the map was put.
IsRight put_at(const TPose2D& T_map_truth, const OccupancyGrid& truth) {
  const GridFrame f = known_frame(truth, 0.0).value_or(truth.frame());
  const TPoint2D middle(f.x0 + 0.5 * f.width * f.resolution, f.y0 + 0.5 * f.height * f.resolution);
  return [=](const TPose2D& T_truth_map) {
    const TPose2D rest = T_truth_map + T_map_truth;
    return (rest.composePoint(middle) - middle).norm() < 1.0 && std::abs(wrap_angle(rest.phi)) < 0.1;
  };
}

void try_sensor_maps(Trial& trial, const SensorMaps& data) {
  const auto& maps = data.maps;
  for (const LabelledPair& pair : data.pairs) {
    const OccupancyGrid& a = maps.at(pair.map_a);
    const OccupancyGrid& b = maps.at(pair.map_b);
    LabelledPair back = pair;
    std::swap(back.a, back.b);
    const std::string name = pair.map_a + " on " + pair.map_b;
    const auto right = [](const LabelledPair& p) {
      return [&p](const TPose2D& T) { return mean_error(p, T) <= allowed_error(p); };
    };
    trial("right: sensor maps", name, a, b, right(pair));
    trial("right: sensor maps, exchanged", name, b, a, right(back));
    trial("sensor maps, same building, mirrored", name, mirrored(a), b);
    trial("sensor maps, same building, mirrored, exchanged", name, mirrored(b), a);
  }
  int k = 0;
  for (const auto& [name_a, a] : maps)
    for (const auto& [name_b, b] : maps) {
      if (name_a.front() == name_b.front()) continue;
      const std::string name = name_a + " on " + name_b;
      trial("sensor maps, other building", name, a, b);
      trial("sensor maps, other building, mirrored", name, mirrored(a), b);
      trial("sensor maps, other building, half", name, half_of(a, k++ % 2 == 0), b);
    }
}

void try_floors(Trial& trial, const std::vector<LabelledFloor>& plain, const std::vector<LabelledFloor>& furnished) {
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const OccupancyGrid& truth = plain[i].map;
    const TPose2D T_map_truth(1.0, 2.0, 0.4 + 0.5 * static_cast<double>(i));
    const auto put = [&](const OccupancyGrid& map) {
      return moved(map, T_map_truth.phi, T_map_truth.x, T_map_truth.y);
    };
    const IsRight right = put_at(T_map_truth, truth);
    const std::string name = plain[i].floor.name;
    trial("right: floor maps, furnished, turned", name, put(furnished[i].map), truth, right);
    for (const bool western : {true, false})
      trial("right: floor maps, furnished, half, turned", name, put(half_of(furnished[i].map, western)), truth, right);
    trial("floor maps, own mirror image", name, mirrored(truth), truth);
    trial("floor maps, own mirror image, furnished, turned", name, put(mirrored(furnished[i].map)), truth);
    for (std::size_t j = 0; j < plain.size(); ++j) {
      if (i == j) continue;
      const std::string pair = name + std::string(" on ") + plain[j].floor.name;
      trial("floor maps, other building, turned", pair, put(truth), plain[j].map);
      trial("floor maps, other building, mirrored", pair, mirrored(truth), plain[j].map);
      trial("floor maps, other building, half, turned", pair, put(half_of(furnished[i].map, (i + j) % 2 == 0)),
            plain[j].map);
    }
  }
}

void try_arenas(Trial& trial) {
  const std::vector<Ground> shapes = {{"yellow", 7, 7, 0}, {"yellow", 9, 6, 0}, {"orange", 8, 8, 0}, {"maze", 8, 7, 0}};
  for (std::uint64_t seed = 7001; seed < 7010; ++seed)
    for (Ground ground : shapes) {
      ground.seed = seed;
      Ground other = ground;
      other.seed += 500;
      const OccupancyGrid truth = truth_of(ground);
      const OccupancyGrid stranger = truth_of(other);
      const TPose2D T_map_truth(1.0, 2.0, 0.37 * static_cast<double>(seed - 7000));
      const auto put = [&](const OccupancyGrid& map) {
        return moved(map, T_map_truth.phi, T_map_truth.x, T_map_truth.y);
      };
      const auto damaged = [&](const OccupancyGrid& map) { return with_gaps(with_phantoms(map, 6, seed), 12, seed); };
      const IsRight right = put_at(T_map_truth, truth);
      const std::string name = ground.name();
      trial("right: arenas, damaged, turned", name, put(damaged(truth)), truth, right);
      trial("right: arenas, damaged, half, turned", name, put(half_of(damaged(truth))), truth, right);
      trial("arenas, other seed, turned", name, put(stranger), truth);
      trial("arenas, other seed, half, turned", name, put(half_of(damaged(stranger))), truth);
      trial("arenas, own mirror image, damaged", name, put(mirrored(damaged(truth))), truth);
      trial("arenas, own mirror image, half", name, put(mirrored(half_of(truth))), truth);
    }
}

/// Arenas of few pallets look alike.
void try_small_arenas(Trial& trial) {
  for (std::uint64_t seed = 7201; seed < 7213; ++seed)
    for (const auto& [columns, rows] : {std::pair{4, 5}, {5, 5}, {6, 5}}) {
      const char* kind = seed % 3 == 0 ? "maze" : seed % 3 == 1 ? "yellow" : "orange";
      const OccupancyGrid truth = truth_of({kind, columns, rows, seed});
      const OccupancyGrid stranger = truth_of({kind, columns, rows, seed + 500});
      const TPose2D T_map_truth(1.0, 2.0, 0.41 * static_cast<double>(seed - 7200));
      const auto put = [&](const OccupancyGrid& map) {
        return moved(map, T_map_truth.phi, T_map_truth.x, T_map_truth.y);
      };
      const std::string name = Ground{kind, columns, rows, seed}.name();
      const OccupancyGrid worn = with_gaps(with_phantoms(truth, 3, seed), 5, seed);
      trial("right: small arenas, damaged, turned", name, put(worn), truth, put_at(T_map_truth, truth));
      trial("small arenas, other seed, turned", name, put(stranger), truth);
      trial("small arenas, other seed, damaged", name, put(with_gaps(with_phantoms(stranger, 3, seed), 5, seed)),
            truth);
      trial("small arenas, own mirror image, damaged", name, put(mirrored(worn)), truth);
    }
}

/// Quarters of arenas, which fit somewhere by chance.
void try_fragments(Trial& trial) {
  for (std::uint64_t seed = 7301; seed < 7313; ++seed)
    for (const Ground& ground : {Ground{"maze", 8, 7, seed}, {"yellow", 9, 6, seed}, {"orange", 7, 7, seed}}) {
      Ground other = ground;
      other.seed += 1000;
      const OccupancyGrid truth = truth_of(ground);
      const TPose2D T_map_truth(1.0, 2.0, 0.4);
      const auto quarter = [&](const OccupancyGrid& map) {
        return moved(with_coverage(with_gaps(map, 8, seed), 0.25), T_map_truth.phi, T_map_truth.x, T_map_truth.y);
      };
      trial("right: arenas, damaged, quarter, turned", ground.name(), quarter(truth), truth,
            put_at(T_map_truth, truth));
      trial("arenas, other seed, quarter, turned", ground.name(), quarter(truth_of(other)), truth);
      trial("arenas, own mirror image, quarter", ground.name(), quarter(mirrored(truth)), truth);
    }
}

/// Buildings on buildings of the other collection and on arenas.
void try_across(Trial& trial, const SensorMaps& data, const std::vector<LabelledFloor>& floors) {
  for (const auto& [name, map] : data.maps)
    for (const LabelledFloor& floor : floors)
      trial("sensor maps on floor maps", name + " on " + floor.floor.name, map, floor.map);
  for (std::uint64_t seed = 7101; seed < 7106; ++seed)
    for (const LabelledFloor& floor : floors) {
      const Ground ground{"yellow", 8, 8, seed};
      trial("arenas on floor maps", ground.name() + " on " + floor.floor.name, truth_of(ground), floor.map);
      trial("halves of floor maps on arenas", floor.floor.name + (" on " + ground.name()), half_of(floor.map),
            truth_of(ground));
    }
}

void BM_Strangers(benchmark::State& state) {
  const std::optional<SensorMaps> data = load_sensor_maps(state);
  if (!data) return;
  const std::optional<std::vector<LabelledFloor>> plain = load_floors(state, false);
  if (!plain) return;
  const std::optional<std::vector<LabelledFloor>> furnished = load_floors(state, true);
  if (!furnished) return;
  for (auto _ : state) {
    Trial trial;
    try_arenas(trial);
    try_small_arenas(trial);
    try_fragments(trial);
    try_floors(trial, *plain, *furnished);
    try_sensor_maps(trial, *data);
    try_across(trial, *data, *plain);
    trial.print();
    const Tally strangers = trial.total(true);
    const Tally right = trial.total(false);
    state.counters["strangers"] = strangers.tried;
    state.counters["wrongly_aligned"] = strangers.aligned;
    state.counters["right"] = right.tried;
    state.counters["right_aligned"] = right.aligned - right.wrong;
    state.counters["right_misplaced"] = right.wrong;
  }
}
BENCHMARK(BM_Strangers)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
