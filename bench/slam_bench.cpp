#include <benchmark/benchmark.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose2D.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/angle.h"
#include "base/rng.h"
#include "slam/mrpt/module/match_target.h"
#include "slam/paper/paper_mapper.h"
#include "slam/paper/particle_filter.h"
#include "slam/robust/graph/graph_solver.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/scan_matcher.h"
#include "slam/scan/surface.h"
#include "tests/support/slam_world.h"

namespace {

using namespace rubble;
using namespace rubble::slam;
using mrpt::math::TPose2D;

const robot::RobotModel kModel;

robot::LaserScan scan_from(const TPose2D& T_world_base) {
  Rng noise(1, "scan");
  return slam_test::scan_at(slam_test::furnished_room(), T_world_base, kModel, Stamp{0}, 0.01, noise);
}

ScanPoints points_from(const TPose2D& T_world_base) {
  LevelScan level_scan(kModel.T_base_laser, {});
  return level_scan.points(scan_from(T_world_base));
}

/// The room as a map of 800 x 800 cells, seen from a few places.
CountMap room_map() {
  CountMap map(800, 800, 0.05);
  for (int i = 0; i < 8; ++i) {
    const TPose2D T{-0.5 + 0.25 * i, 0.1 * i, 0.8 * i};
    map.stamp(T, points_from(T));
  }
  return map;
}

void BM_LevelScan(benchmark::State& state) {
  const robot::LaserScan scan = scan_from({0.3, 0.2, 0.4});
  LevelScan level_scan(kModel.T_base_laser, {});
  const SweepMotion motion{{-0.02, 0.0, -0.05}, {0.02, 0.0, 0.05}};
  for (auto _ : state) benchmark::DoNotOptimize(level_scan.points(scan, &motion));
}
BENCHMARK(BM_LevelScan);

/// Eq. (2) for 300 particles around a pose.
void BM_ParticleWeights(benchmark::State& state) {
  const CountMap map = room_map();
  const TPose2D T{0.3, 0.2, 0.4};
  const std::vector<mrpt::math::TPoint2D> hits = points_from(T).hits;
  Rng draw(1, "drift");
  const Particles particles = drift(particles_at(T, 300), {0.05, 0.0, 0.1}, {}, draw);
  for (auto _ : state) benchmark::DoNotOptimize(measure(particles, hits, map));
  state.counters["beams"] = static_cast<double>(hits.size());
}
BENCHMARK(BM_ParticleWeights)->Unit(benchmark::kMicrosecond);

/// Fig. 5 and the resampling for 300 particles.
void BM_DriftAndResample(benchmark::State& state) {
  Rng draw(1, "drift");
  const Particles start = normalise(particles_at({}, 300));
  for (auto _ : state) {
    Particles moved = drift(resample(start), {0.05, 0.0, 0.1}, {}, draw);
    benchmark::DoNotOptimize(mean_of_best(moved, 0.05));
  }
}
BENCHMARK(BM_DriftAndResample)->Unit(benchmark::kMicrosecond);

void BM_Stamp(benchmark::State& state) {
  CountMap map = room_map();
  const TPose2D T{0.3, 0.2, 0.4};
  const ScanPoints points = points_from(T);
  for (auto _ : state) map.stamp(T, points);
}
BENCHMARK(BM_Stamp)->Unit(benchmark::kMicrosecond);

/// One ICP of two scans 5 cm and 3 deg apart, with all it needs: thinning, coverage, buckets.
void BM_ScanMatch(benchmark::State& state) {
  const TPose2D T_world_last{0.3, 0.2, 0.4};
  const TPose2D motion{0.05, 0.0, deg_to_rad(3.0)};
  const ScanPoints last = points_from(T_world_last);
  const ScanPoints now = points_from(T_world_last + motion);
  ScanMatcher matcher{ScanMatcherConfig{}};
  const TPose2D prior = motion + TPose2D{0.02, -0.01, deg_to_rad(1.0)};
  for (auto _ : state) {
    const Surface surface = surface_of(last, {});
    matcher.set_last(surface);
    const Surface shared = covered_part(surface_of(now, {}), SurfaceCoverage(surface), prior, 0.1);
    benchmark::DoNotOptimize(matcher.match(shared, prior));
  }
}
BENCHMARK(BM_ScanMatch)->Unit(benchmark::kMicrosecond);

/// The pairs of one ICP iteration, index included once: by our buckets, and by MRPT's own kd-tree beside it.
template <class Target>
void pairs(benchmark::State& state) {
  const std::vector<mrpt::math::TPoint2D> last = points_from({0.3, 0.2, 0.4}).hits;
  const std::vector<mrpt::math::TPoint2D> now = points_from({0.35, 0.2, 0.45}).hits;
  mrpt::maps::CSimplePointsMap other;
  for (const auto& p : now) other.insertPointFast(static_cast<float>(p.x), static_cast<float>(p.y), 0.0f);
  mrpt::maps::TMatchingParams params;
  params.maxDistForCorrespondence = 0.3f;
  for (auto _ : state) {
    Target target;
    for (const auto& p : last) target.insertPointFast(static_cast<float>(p.x), static_cast<float>(p.y), 0.0f);
    target.mark_as_modified();
    if constexpr (std::is_same_v<Target, MatchTarget>) target.index();
    mrpt::tfest::TMatchingPairList found;
    mrpt::maps::TMatchingExtraResults result;
    for (int iteration = 0; iteration < 10; ++iteration)
      target.determineMatching2D(&other, mrpt::poses::CPose2D(0.05, 0.0, 0.05), found, params, result);
    benchmark::DoNotOptimize(found);
  }
}
BENCHMARK(pairs<MatchTarget>)->Unit(benchmark::kMicrosecond)->Name("BM_TenPairings/buckets");
BENCHMARK(pairs<mrpt::maps::CSimplePointsMap>)->Unit(benchmark::kMicrosecond)->Name("BM_TenPairings/mrpt_kd_tree");

/// The whole mapper on a scan after a motion of 4 cm.
void BM_MapperStep(benchmark::State& state) {
  PaperMapper mapper(kModel, {}, 1);
  std::vector<robot::LaserScan> scans;
  for (int i = 0; i < 20; ++i) scans.push_back(scan_from({0.04 * i, 0.0, 0.02 * i}));
  std::int64_t tick = 0;
  for (auto _ : state) {
    const std::int64_t phase = tick % 38;
    const std::size_t at = static_cast<std::size_t>(phase < 20 ? phase : 38 - phase);
    ++tick;
    robot::Inputs inputs;
    inputs.now = Stamp{tick * 100'000'000};
    robot::Odometry odometry;
    odometry.stamp = inputs.now;
    odometry.pose = {0.04 * static_cast<double>(at), 0.0, 0.02 * static_cast<double>(at)};
    inputs.odometry.push_back(odometry);
    inputs.scans.push_back(scans[at]);
    inputs.scans.back().stamp = Stamp{tick * 100'000'000 - 80'000'000};
    mapper.update(inputs);
  }
  state.counters["mapped"] = static_cast<double>(mapper.counts().mapped);
}
BENCHMARK(BM_MapperStep)->Unit(benchmark::kMicrosecond);

/// A drive round and round, each key frame tied to the one of the round before.
PoseGraph rounds(int nodes) {
  constexpr int kRound = 150;
  Rng noise(1, "rounds");
  PoseGraph graph;
  const auto truth = [](int k) {
    const double bearing = 2.0 * kPi * k / kRound;
    return TPose2D(6.0 * std::sin(bearing), 6.0 - 6.0 * std::cos(bearing), bearing);
  };
  const auto measure = [&](int from, int to, bool loop) {
    GraphEdge edge;
    edge.from = from;
    edge.to = to;
    const double dx = noise.gaussian(0.01);
    edge.T_from_to = (truth(to) - truth(from)) + TPose2D(dx, noise.gaussian(0.01), noise.gaussian(0.003));
    edge.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
    edge.loop = loop;
    graph.edges.push_back(edge);
  };
  graph.nodes.push_back(truth(0));
  for (int k = 1; k < nodes; ++k) {
    measure(k - 1, k, false);
    graph.nodes.push_back(graph.nodes.back() + graph.edges.back().T_from_to);
    if (k >= kRound) measure(k - kRound, k, true);
  }
  return graph;
}

/// A solution in slices of half a million units of work: a unit should take about a nanosecond, and no slice much more.
void BM_SolveGraph(benchmark::State& state) {
  const PoseGraph graph = rounds(static_cast<int>(state.range(0)));
  constexpr Work kSlice = 500'000;
  Work work = 0;
  Work largest = 0;
  int slices = 0;
  double longest = 0.0;
  GraphSolver solver;  // keeps its memory, as a mapper's does
  for (auto _ : state) {
    solver.start(graph, GraphSolver::Plan::Refine, 8.0);
    for (bool more = true; more; ++slices) {
      Work budget = kSlice;
      const auto start = std::chrono::steady_clock::now();
      more = solver.advance(budget);
      longest = std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      work += kSlice - budget;
      largest = std::max(largest, kSlice - budget);
    }
    benchmark::DoNotOptimize(solver.nodes());
  }
  const auto solutions = static_cast<double>(state.iterations());
  state.counters["work_ms"] = static_cast<double>(work) * 1e-6 / solutions;
  state.counters["slices"] = slices / solutions;
  state.counters["longest_slice_ms"] = 1e3 * longest;
  state.counters["largest_slice_work_ms"] = static_cast<double>(largest) * 1e-6;
}
BENCHMARK(BM_SolveGraph)->Arg(500)->Arg(2000)->Arg(4000)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
