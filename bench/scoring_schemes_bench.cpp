#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "arenas/raf/raf.h"
#include "arenas/truth/truth_map.h"
#include "bench/scoring_data.h"
#include "scoring/alignment/second_drawing.h"
#include "scoring/measures/beyond_walls.h"
#include "scoring/measures/detached.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/scorecard.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/scoring_halls.h"
#include "tests/support/scoring_hedges.h"
#include "tests/support/scoring_schemes.h"
#include "tests/support/scoring_schemes_more.h"
#include "tests/support/scoring_second_drawings.h"

/// The laws of the score on grounds and by schemes that it was not made for: orange and red arenas full of ramps,
/// arenas of real competitions (`arenas_raf` of RUBBLE_DATA), halls, buildings (`rooms`). RUBBLE_KIND=TEXT takes only
/// kinds with this text, RUBBLE_SCHEME=TEXT only schemes with this one.
namespace rubble::scoring {
namespace {

using namespace testing;

struct Place {
  std::string kind;
  std::string name;
  OccupancyGrid truth;
};

std::vector<Place> ramps(const std::string& kind, int count) {
  std::vector<Place> out;
  for (int i = 0; i < count; ++i) {
    arenas::GenerateConfig config;
    config.kind = arenas::arena_kind(kind);
    config.columns = 6 + i % 4;
    config.rows = 9 - i % 3;
    config.seed = 9100 + static_cast<std::uint64_t>(i);
    config.ramps = 0.8;
    config.loops = 0.05 * (i % 8);
    config.rough = 0.4;
    const std::string name = kind + " " + std::to_string(config.seed);
    out.push_back({kind, name, arenas::truth_map(arenas::parse_arena(arenas::generate_arena(config), name))});
  }
  return out;
}

std::vector<Place> large_ones(const std::string& kind, int count) {
  std::vector<Place> out;
  for (int i = 0; i < count; ++i) {
    const Ground ground{kind, 7 + i % 3, 9 - i % 4, 9500 + static_cast<std::uint64_t>(i)};
    out.push_back({"large " + kind, ground.name(), truth_of(ground)});
  }
  return out;
}

std::vector<Place> small_ones(int count) {
  std::vector<Place> out;
  for (int i = 0; i < count; ++i) {
    const Ground ground{"yellow", 4 + i % 3, 4 + i / 3 % 3, 9300 + static_cast<std::uint64_t>(i)};
    out.push_back({"small", ground.name(), truth_of(ground)});
  }
  return out;
}

std::vector<Place> halls(int count, bool lattice) {
  std::vector<Place> out;
  for (int i = 0; i < count; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    out.push_back({lattice ? "lattice hall" : "hall", "hall " + std::to_string(i), hall_of(seed, lattice)});
  }
  return out;
}

std::vector<Place> competitions(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Place> out;
  for (const std::string& file : files)
    if (arenas::is_raf(file))
      out.push_back({"raf", std::filesystem::path(file).stem(), arenas::truth_map(arenas::import_raf(file).arena)});
  return out;
}

void keep_chosen(std::vector<Place>& all) {
  const char* only = std::getenv("RUBBLE_KIND");
  if (only == nullptr) return;
  const auto other = [&](const Place& place) { return place.kind.find(only) == std::string::npos; };
  all.erase(std::remove_if(all.begin(), all.end(), other), all.end());
}

const std::vector<Place>& places(benchmark::State& state) {
  static std::vector<Place> all;
  if (!all.empty()) return all;
  const std::optional<std::string> raf = data_folder(state, "arenas_raf");
  const std::optional<std::vector<LabelledFloor>> floors = load_floors(state, false);
  if (!raf || !floors) return all;
  const auto add = [](const std::vector<Place>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(ramps("orange", 20));
  add(ramps("red", 12));
  add(large_ones("yellow", 12));
  add(small_ones(18));
  add(competitions(*raf));
  add(halls(16, false));
  add(halls(16, true));
  for (const LabelledFloor& floor : *floors) all.push_back({"building", floor.floor.name, floor.map});
  keep_chosen(all);
  return all;
}

/// The next place of the same kind.
const Place& stranger_of(const std::vector<Place>& all, std::size_t i) {
  for (std::size_t k = 1; k < all.size(); ++k)
    if (all[(i + k) % all.size()].kind == all[i].kind) return all[(i + k) % all.size()];
  return all[i];
}

class Judge {
 public:
  explicit Judge(const OccupancyGrid& truth) : truth_(truth), sights_(truth) {}
  double operator()(const OccupancyGrid& map) const {
    const PlanarTransform T;
    const double twice = std::max({detached_share(map, truth_, T), share_beyond_walls(map, truth_, T),
                                   second_drawing_share(map, truth_, T, sights_)});
    return sights_.at(map, PlanarTransform()).score * (1.0 - twice);
  }
  const SightLines& sights() const { return sights_; }

 private:
  const OccupancyGrid& truth_;
  SightLines sights_;
};

struct Tally {
  std::string kind;
  std::string scheme;
  double honest = 0.0;
  double attack = 0.0;
  double most = -1.0;
  std::string where;
  int count = 0;
};

/// What each scheme earns beside the honest maps, kind by kind.
void tell_gains(benchmark::State& state, const std::vector<Place>& all, std::vector<Scheme> tried) {
  const char* only = std::getenv("RUBBLE_SCHEME");
  if (only != nullptr)
    tried.erase(std::remove_if(tried.begin(), tried.end(),
                               [&](const Scheme& s) { return s.name.find(only) == std::string::npos; }),
                tried.end());
  std::vector<Tally> tallies;
  double most_gained = -1.0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const OccupancyGrid& truth = all[i].truth;
      const Judge judge(truth);
      if (!judge.sights().usable()) continue;
      const OccupancyGrid& stranger = stranger_of(all, i).truth;
      for (const Scheme& scheme : tried) {
        double honest = 0.0;
        const std::vector<OccupancyGrid> maps = scheme.honest(truth, i);
        for (const OccupancyGrid& map : maps) honest += judge(map) / static_cast<double>(maps.size());
        const double attack = judge(scheme.attack(truth, stranger, i));
        auto at = std::find_if(tallies.begin(), tallies.end(),
                               [&](const Tally& t) { return t.kind == all[i].kind && t.scheme == scheme.name; });
        if (at == tallies.end()) {
          at = tallies.insert(tallies.end(), Tally());
          at->kind = all[i].kind;
          at->scheme = scheme.name;
        }
        at->honest += honest;
        at->attack += attack;
        ++at->count;
        if (attack - honest > at->most) {
          at->most = attack - honest;
          at->where = all[i].name;
        }
      }
    }
  }
  std::printf("| ground | scheme | honest | scheme's | gain | largest gain | where |\n");
  for (const Tally& t : tallies) {
    const double gain = (t.attack - t.honest) / t.count;
    most_gained = std::max(most_gained, gain);
    const auto of_kind = state.counters.emplace("most_gained_" + t.kind, gain).first;
    of_kind->second = std::max(of_kind->second.value, gain);
    std::printf("| %s (%d) | %s | %.3f | %.3f | %+.3f | %+.3f | %s |%s\n", t.kind.c_str(), t.count, t.scheme.c_str(),
                t.honest / t.count, t.attack / t.count, gain, t.most, t.where.c_str(), gain > 0.01 ? " GAINS" : "");
  }
  state.counters["most_gained"] = most_gained;
  state.counters["places"] = static_cast<double>(all.size());
}
void BM_Schemes(benchmark::State& state) {
  const std::vector<Place>& all = places(state);
  if (!all.empty()) tell_gains(state, all, schemes());
}
BENCHMARK(BM_Schemes)->Unit(benchmark::kSecond)->Iterations(1);

void BM_MoreSchemes(benchmark::State& state) {
  const std::vector<Place>& all = places(state);
  if (!all.empty()) tell_gains(state, all, more_schemes());
}
BENCHMARK(BM_MoreSchemes)->Unit(benchmark::kSecond)->Iterations(1);

/// On arenas that no other bench has: twelve yellow, twelve orange, all of competitions.
void tell_gains_on_fresh_ones(benchmark::State& state, const std::vector<Scheme>& tried) {
  const std::optional<std::string> raf = data_folder(state, "arenas_raf");
  if (!raf) return;
  std::vector<Place> all;
  for (const char* kind : {"yellow", "orange"})
    for (std::uint64_t i = 0; i < 12; ++i) {
      const int more = static_cast<int>(i % 3);
      const Ground ground{kind, 7 + more, 8 - more, 15001 + i};
      all.push_back({kind, ground.name(), truth_of(ground)});
    }
  for (Place& place : competitions(*raf)) all.push_back(std::move(place));
  keep_chosen(all);
  tell_gains(state, all, tried);
}
void BM_Hedges(benchmark::State& state) { tell_gains_on_fresh_ones(state, hedges()); }
BENCHMARK(BM_Hedges)->Unit(benchmark::kSecond)->Iterations(1);

/// Two drawings on one canvas, joined, of which the other is of another size, stretched, mirrored or came apart.
void BM_SecondDrawings(benchmark::State& state) { tell_gains_on_fresh_ones(state, second_drawings()); }
BENCHMARK(BM_SecondDrawings)->Unit(benchmark::kSecond)->Iterations(1);

/// Both of two hypotheses a few centimetres apart: they gain, and the documentation says how much.
void BM_NearCopies(benchmark::State& state) { tell_gains_on_fresh_ones(state, near_copies()); }
BENCHMARK(BM_NearCopies)->Unit(benchmark::kSecond)->Iterations(1);

/// What is more than a guess: it gains, and the documentation says how much.
void BM_Conclusions(benchmark::State& state) {
  const std::vector<Place>& all = places(state);
  if (!all.empty()) tell_gains(state, all, conclusions());
}
BENCHMARK(BM_Conclusions)->Unit(benchmark::kSecond)->Iterations(1);

/// Fat walls, and parts of other shapes than halves.
void BM_SharesAndThickness(benchmark::State& state) {
  const std::vector<Place>& all = places(state);
  if (all.empty()) return;
  double off = 0.0;
  double thick_10 = 1.0;
  double thick_20 = 1.0;
  for (auto _ : state)
    for (const Place& place : all) {
      const OccupancyGrid& truth = place.truth;
      const Judge judge(truth);
      if (!judge.sights().usable()) {
        std::printf("%s %s: no lines\n", place.kind.c_str(), place.name.c_str());
        continue;
      }
      const int cells = static_cast<int>(std::lround(0.05 / truth.resolution()));
      const double a = judge(thickened(truth, cells));
      const double b = judge(thickened(truth, 2 * cells));
      thick_10 = std::min(thick_10, a);
      thick_20 = std::min(thick_20, b);
      std::printf("%s %s: thicker %.3f %.3f%s; parts off", place.kind.c_str(), place.name.c_str(), a, b,
                  a < 0.95 || b < 0.9 ? " MISS" : "");
      std::vector<OccupancyGrid> parts;
      for (const double angle : {0.3, 1.9, 3.7, 5.2}) parts.push_back(cut_at(truth, angle, angle > 3.0 ? 1.5 : -1.0));
      for (const double share : {0.3, 0.5, 0.8}) parts.push_back(patches_of(truth, share, 17));
      for (const OccupancyGrid& part : parts) {
        const double error = judge.sights().at(part, PlanarTransform()).score - share_within(judge.sights(), part);
        off = std::max(off, std::abs(error));
        std::printf(" %+.3f", error);
      }
      std::printf("\n");
    }
  state.counters["thicker_10cm"] = thick_10;
  state.counters["thicker_20cm"] = thick_20;
  state.counters["most_off"] = off;
}
BENCHMARK(BM_SharesAndThickness)->Unit(benchmark::kSecond)->Iterations(1);

/// Every place on the next two of its kind and on one of the kind after it, at the best pose of all.
void BM_OtherPlaces(benchmark::State& state) {
  const std::vector<Place>& all = places(state);
  if (all.empty()) return;
  double sum = 0.0;
  double worst = 0.0;
  int pairs = 0;
  int aligned = 0;
  for (auto _ : state)
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const std::size_t step : {std::size_t{1}, std::size_t{2}, all.size() / 3}) {
        const Place& other = all[(i + step) % all.size()];
        if (other.name == all[i].name) continue;
        const MapScore score = score_map(other.truth, all[i].truth);
        sum += score.score_at_best_pose;
        worst = std::max(worst, score.score_at_best_pose);
        aligned += score.aligned ? 1 : 0;
        ++pairs;
        if (score.score_at_best_pose > 0.1 || score.aligned)
          std::printf("%s on %s: %.3f %s\n", other.name.c_str(), all[i].name.c_str(), score.score_at_best_pose,
                      score.aligned ? "ALIGNED" : "");
      }
  state.counters["pairs"] = pairs;
  state.counters["mean"] = sum / std::max(1, pairs);
  state.counters["worst"] = worst;
  state.counters["aligned"] = aligned;
}
BENCHMARK(BM_OtherPlaces)->Unit(benchmark::kSecond)->Iterations(1);

/// The place next door on the same canvas, joined by a strip, is no second drawing. The next three of its kind.
void BM_NextDoor(benchmark::State& state) {
  const std::vector<Place>& all = places(state);
  if (all.empty()) return;
  int pairs = 0;
  int taken = 0;
  for (auto _ : state)
    for (std::size_t i = 0; i < all.size(); ++i) {
      const OccupancyGrid& truth = all[i].truth;
      const SightLines sights(truth);
      if (!sights.usable()) continue;
      int neighbours = 0;
      for (std::size_t k = 1; k < all.size() && neighbours < 3; ++k) {
        const Place& other = all[(i + k) % all.size()];
        if (other.kind != all[i].kind || other.truth.resolution() != truth.resolution()) continue;
        ++neighbours;
        ++pairs;
        if (second_drawing_share(joined_to(truth, other.truth), truth, PlanarTransform(), sights) <= 0.0) continue;
        ++taken;
        std::printf("%s beside %s: taken for a second drawing\n", other.name.c_str(), all[i].name.c_str());
      }
    }
  state.counters["pairs"] = pairs;
  state.counters["taken"] = taken;
}
BENCHMARK(BM_NextDoor)->Unit(benchmark::kSecond)->Iterations(1);

/// Each arena of a real competition on each other one, at the best pose of all.
void BM_CompetitionArenas(benchmark::State& state) {
  const std::optional<std::string> folder = data_folder(state, "arenas_raf");
  if (!folder) return;
  const std::vector<Place> all = competitions(*folder);
  double sum = 0.0;
  double worst = 0.0;
  int pairs = 0;
  int aligned = 0;
  for (auto _ : state)
    for (const Place& truth : all)
      for (const Place& other : all) {
        if (other.name == truth.name) continue;
        const MapScore score = score_map(other.truth, truth.truth);
        sum += score.score_at_best_pose;
        worst = std::max(worst, score.score_at_best_pose);
        aligned += score.aligned ? 1 : 0;
        ++pairs;
        if (score.score_at_best_pose > 0.1)
          std::printf("%s on %s: %.3f\n", other.name.c_str(), truth.name.c_str(), score.score_at_best_pose);
      }
  state.counters["pairs"] = pairs;
  state.counters["mean"] = sum / std::max(1, pairs);
  state.counters["worst"] = worst;
  state.counters["aligned"] = aligned;
}
BENCHMARK(BM_CompetitionArenas)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
