#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "base/planar.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/scorecard.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"

/// Does it pay to draw what is not known? Each attack on arenas of RUBBLE_ARENA_SEEDS seeds (default 50), in turn
/// yellow, orange and a maze, with the honest map's score and overlap beside it. All but the strangers are scored at
/// the true pose: whether an attack is refused by the alignment is another matter.
namespace rubble::scoring {
namespace {

using namespace testing;

std::uint64_t seeds() {
  const char* given = std::getenv("RUBBLE_ARENA_SEEDS");
  return given == nullptr ? 50 : std::strtoull(given, nullptr, 10);
}

Ground ground_of(std::uint64_t seed) {
  const Ground shapes[] = {
      {"yellow", 8, 8, seed}, {"orange", 7, 8, seed}, {"yellow", 9, 6, seed}, {"maze", 7, 7, seed}};
  return shapes[seed % 4];
}

struct Pair {
  OccupancyGrid honest;
  OccupancyGrid attack;
};

struct Attack {
  std::string name;
  std::function<Pair(const OccupancyGrid& truth, std::uint64_t seed)> make;
};

OccupancyGrid damaged(const OccupancyGrid& truth, std::uint64_t seed) {
  return with_gaps(with_phantoms(truth, 6, seed), 12, seed);
}

std::vector<Attack> attacks() {
  const auto thicker = [](double half) {
    return [half](const OccupancyGrid& truth, std::uint64_t) {
      return Pair{truth, thickened(truth, static_cast<int>(std::lround(half / truth.resolution())))};
    };
  };
  const auto touched_up = [](auto change) {
    return [change](const OccupancyGrid& truth, std::uint64_t seed) {
      const OccupancyGrid honest = damaged(truth, seed);
      return Pair{honest, change(honest)};
    };
  };
  return {
      {"half, the rest guessed",
       [](const OccupancyGrid& truth, std::uint64_t seed) {
         const OccupancyGrid half = half_of(truth, seed % 2 == 0);
         return Pair{half, filled(half, guessed(truth, 0.2 + 0.05 * static_cast<double>(seed % 7), seed))};
       }},
      {"half, the rest free",
       [](const OccupancyGrid& truth, std::uint64_t seed) {
         const OccupancyGrid half = half_of(truth, seed % 2 == 0);
         return Pair{half, unknown_as_free(half)};
       }},
      {"all guessed",
       [](const OccupancyGrid& truth, std::uint64_t seed) {
         return Pair{OccupancyGrid(truth.frame()), guessed(truth, 0.2 + 0.05 * static_cast<double>(seed % 7), seed)};
       }},
      {"walls 10 cm thicker", thicker(0.05)},
      {"walls 20 cm thicker", thicker(0.1)},
      {"copies of other sizes beside", touched_up([](const OccupancyGrid& map) {
         return beside_copies(map, {0.95, 1.05});
       })},
      {"unsure walls erased", touched_up([](const OccupancyGrid& map) { return without_unsure(map, 0.05); })},
      {"frame around", touched_up([](const OccupancyGrid& map) { return framed(map, 4); })},
      {"smoothed", touched_up([](const OccupancyGrid& map) { return smoothed(map); })},
  };
}

/// What one attack did over all seeds.
struct Tally {
  double honest = 0.0;
  double attack = 0.0;
  double honest_overlap = 0.0;
  double attack_overlap = 0.0;
  double worst = -1.0;   ///< the most that it gained
  double highest = 0.0;  ///< score of an attack
  double lowest = 1.0;
  int count = 0;
  void take(const MapScore& honest_score, const MapScore& attack_score) {
    honest += honest_score.score_at_best_pose;
    attack += attack_score.score_at_best_pose;
    honest_overlap += honest_score.overlap;
    attack_overlap += attack_score.overlap;
    worst = std::max(worst, attack_score.score_at_best_pose - honest_score.score_at_best_pose);
    highest = std::max(highest, attack_score.score_at_best_pose);
    lowest = std::min(lowest, attack_score.score_at_best_pose);
    ++count;
  }
  void print(const std::string& name) const {
    std::printf("| %s | %.3f | %.3f | %+.3f | %+.3f | %.3f | %.3f |\n", name.c_str(), honest / count, attack / count,
                (attack - honest) / count, worst, honest_overlap / count, attack_overlap / count);
  }
};

void BM_Attacks(benchmark::State& state) {
  const std::vector<Attack> all = attacks();
  std::vector<Tally> tallies(all.size());
  for (auto _ : state)
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      const OccupancyGrid truth = truth_of(ground_of(seed));
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Pair pair = all[i].make(truth, seed);
        tallies[i].take(score_at_pose(pair.honest, truth, {}), score_at_pose(pair.attack, truth, {}));
      }
    }
  std::printf("| attack | honest score | attack's | gain | largest gain | honest overlap | attack's |\n");
  double most = -1.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    tallies[i].print(all[i].name);
    most = std::max(most, (tallies[i].attack - tallies[i].honest) / tallies[i].count);
  }
  state.counters["seeds"] = static_cast<double>(seeds());
  state.counters["most_gained"] = most;
  state.counters["guess"] = tallies[2].attack / tallies[2].count;
  state.counters["thicker_10cm"] = tallies[3].lowest;
  state.counters["thicker_20cm"] = tallies[4].lowest;
}
BENCHMARK(BM_Attacks)->Unit(benchmark::kSecond)->Iterations(1);

/// Of a half, how far its score is off its share: of blocked lines by the place of their wall, of open ones by the
/// places of possible walls.
void BM_Shares(benchmark::State& state) {
  double off = 0.0;
  double most = 0.0;
  for (auto _ : state)
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      const OccupancyGrid truth = truth_of(ground_of(seed));
      const SightLines sights(truth);
      const OccupancyGrid half = half_of(truth, seed % 2 == 0);
      const double error = std::abs(sights.at(half, PlanarTransform()).score - share_within(sights, half));
      off += error / static_cast<double>(seeds());
      most = std::max(most, error);
    }
  state.counters["off"] = off;
  state.counters["most_off"] = most;
}
BENCHMARK(BM_Shares)->Unit(benchmark::kSecond)->Iterations(1);

/// Another arena of the same kind and lattice at the best pose of all.
void BM_OtherArenas(benchmark::State& state) {
  Tally tally;
  int aligned = 0;
  for (auto _ : state)
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      Ground other = ground_of(seed);
      other.seed += 1000;
      const OccupancyGrid truth = truth_of(ground_of(seed));
      MapScore found = score_map(truth_of(other), truth);
      aligned += found.aligned ? 1 : 0;
      found.overlap = score_at_pose(truth_of(other), truth, found.T_truth_map).overlap;
      tally.take({}, found);
    }
  tally.print("another arena, best pose");
  state.counters["mean"] = tally.attack / tally.count;
  state.counters["worst"] = tally.highest;
  state.counters["aligned"] = aligned;
}
BENCHMARK(BM_OtherArenas)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
