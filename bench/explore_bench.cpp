#include <benchmark/benchmark.h>

#include "explore/plan/exploration_transform.h"
#include "explore/plan/frontier.h"
#include "explore/plan/planner.h"
#include "explore/plan/traversable.h"
#include "explore/stuck/way_out.h"
#include "slam/grid/count_map.h"
#include "slam/scan/level_scan.h"
#include "tests/support/explore_oracle.h"
#include "tests/support/explore_world.h"

namespace {

using namespace rubble;
using namespace rubble::explore;

/// A random maze as a map of 800 x 800 cells: a scan ahead and one back from the middle of each pallet, the last row
/// left out so that there is frontier, and all of it far from the first pallet.
slam::CountMap maze_map(int pallets) {
  const robot::RobotModel model;
  slam::CountMap map(800, 800, 0.05);
  slam::LevelScan level_scan(model.T_base_laser, {});
  test::Maze maze = test::random_maze(pallets, pallets, 0.2, 1);
  for (int row = 0; row + 1 < pallets; ++row)
    for (int column = 0; column < pallets; ++column)
      for (const double heading : {0.0, kPi}) {
        const mrpt::math::TPoint2D p = maze.centre(column, row);
        maze.start = {p.x, p.y, heading};
        test::MazeRobot robot(maze, model);
        robot::Inputs inputs;
        while (inputs.scans.empty()) inputs = robot.step({});
        map.stamp({p.x - 6.0, p.y - 6.0, heading}, level_scan.points(inputs.scans[0]));
      }
  return map;
}

const mrpt::math::TPose2D kStart{-6.0, -6.0, 0.0};

Traversable measured_floor(const slam::CountMap& map) {
  Traversable floor = traversable(map, 0.5);
  free_body(floor, kStart, 0.508, 0.497, 0.0);
  measure_clearance(floor, 1.2);
  return floor;
}

std::vector<Source> sources_of(const Traversable& floor) {
  std::vector<Source> sources;
  for (const Cell c : frontier_cells(floor)) sources.push_back({c, 0.0});
  return sources;
}

void KnownRegion(benchmark::State& state) {
  const slam::CountMap map = maze_map(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(traversable(map, 0.5));
}
BENCHMARK(KnownRegion)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

void Clearance(benchmark::State& state) {
  Traversable floor = traversable(maze_map(static_cast<int>(state.range(0))), 0.5);
  for (auto _ : state) measure_clearance(floor, 1.2);
}
BENCHMARK(Clearance)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

void FrontierClusters(benchmark::State& state) {
  const Traversable floor = measured_floor(maze_map(static_cast<int>(state.range(0))));
  for (auto _ : state) benchmark::DoNotOptimize(frontier_clusters(floor, 5));
}
BENCHMARK(FrontierClusters)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

/// Clearance and transform of the whole known map: the figure to compare with the heap below.
void BucketTransform(benchmark::State& state) {
  Traversable floor = measured_floor(maze_map(static_cast<int>(state.range(0))));
  const std::vector<Source> sources = sources_of(floor);
  ExplorationTransform transform;
  for (auto _ : state) {
    measure_clearance(floor, 1.2);
    transform.run(floor, sources, {});
    benchmark::DoNotOptimize(transform.cost(floor.cells.cell({kStart.x, kStart.y})));
  }
}
BENCHMARK(BucketTransform)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

void HeapTransform(benchmark::State& state) {
  Traversable floor = measured_floor(maze_map(static_cast<int>(state.range(0))));
  const std::vector<Source> sources = sources_of(floor);
  for (auto _ : state) {
    measure_clearance(floor, 1.2);
    benchmark::DoNotOptimize(test::heap_transform(floor.cells, floor.clearance, sources, {}));
  }
}
BENCHMARK(HeapTransform)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

/// All of one replanning: from the map to a smooth path.
void WholePlan(benchmark::State& state) {
  const slam::CountMap map = maze_map(static_cast<int>(state.range(0)));
  Planner planner({});
  for (auto _ : state) {
    const Traversable floor = measured_floor(map);
    const Plan plan = planner.to_frontier(
        floor, kStart, [](const mrpt::math::TPoint2D&) { return false; }, std::nullopt);
    if (!plan.found) state.SkipWithError("no way to a frontier");
    benchmark::DoNotOptimize(plan.cost);
  }
}
BENCHMARK(WholePlan)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

/// A plan that fails at every margin, on a pallet between walls with room to turn: the dearest that was found.
void NoWayOut(benchmark::State& state) {
  Trap trap;
  trap.size = 1.2;
  std::vector<mrpt::math::TPoint2D> walls;
  for (double t = -0.8; t <= 0.8; t += 0.05)
    for (const double at : {0.72, 0.77})
      for (const mrpt::math::TPoint2D& p : {mrpt::math::TPoint2D{at, t}, {-at, t}, {t, at}, {t, -at}})
        walls.push_back(p);
  for (auto _ : state) {
    WayOut way_out({}, trap, walls, {});
    if (way_out.drive({0.0, 0.0, 0.3})) state.SkipWithError("there is a way out");
  }
}
BENCHMARK(NoWayOut)->Unit(benchmark::kMillisecond);

}  // namespace
