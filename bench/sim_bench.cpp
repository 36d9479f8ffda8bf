#include <benchmark/benchmark.h>
#include <box2d/box2d.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <cmath>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"
#include "base/rng.h"
#include "sim/body/clutter.h"
#include "sim/body/world.h"
#include "sim/laser/laser.h"
#include "sim/laser/ray_walk.h"
#include "sim/laser/rays.h"
#include "sim/sim_robot.h"

namespace {

using namespace rubble;
using mrpt::math::TPoint2D;

/// On a machine with other work the fastest of many repetitions is what the code needs.
void best_of_many(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMicrosecond)->Repetitions(20)->MinTime(0.03)->ReportAggregatesOnly();
  b->ComputeStatistics("best", [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); });
  b->ComputeStatistics("most", [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); });
}

/// A maze of 12 x 12 pallets (its walls joined to 71 boards) with 50 paper balls.
const arenas::Arena& maze() {
  static const arenas::Arena arena = [] {
    arenas::GenerateConfig config;
    config.columns = 12;
    config.rows = 12;
    config.seed = 3;
    arenas::Arena made = arenas::parse_arena(arenas::generate_arena(config), "bench");
    made.balls.clear();
    Rng rng(1, "balls");
    while (made.balls.size() < 50) {
      const double x = rng.uniform(made.min_corner.x, made.max_corner.x);
      const double y = rng.uniform(made.min_corner.y, made.max_corner.y);
      const bool near_start = std::hypot(x - made.start.x, y - made.start.y) < 0.8;
      const bool in_wall = std::any_of(made.solids.begin(), made.solids.end(), [&](const arenas::Solid& solid) {
        return std::any_of(solid.outline.begin(), solid.outline.end(),
                           [&](const TPoint2D& p) { return std::hypot(p.x - x, p.y - y) < 0.2; });
      });
      if (!near_start && !in_wall) made.balls.push_back({{x, y}, 0.12, 0.03});
    }
    return made;
  }();
  return arena;
}

sim::WorldState at_start() {
  sim::WorldState state;
  state.pose = maze().start;
  return state;
}

std::vector<sim::Sphere> spheres() {
  std::vector<sim::Sphere> result;
  for (const auto& ball : maze().balls) {
    const double floor = arenas::floor_height(maze(), ball.position);
    result.push_back({ball.position.x, ball.position.y, floor + ball.radius, ball.radius});
  }
  return result;
}

/// States 10 ms apart: forward at 0.3 m/s, turning at 60 deg/s, tilted by 5 deg.
std::vector<sim::WorldState> moving() {
  std::vector<sim::WorldState> states(9, at_start());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double t = 0.01 * static_cast<double>(i);
    states[i].stamp = Stamp::from_seconds(t);
    states[i].pose.x += 0.3 * t;
    states[i].pose.phi += 1.047 * t;
    states[i].stance.pitch = -0.0873 * (1.0 + t);
  }
  return states;
}

void RayWalkScan(benchmark::State& state) {
  const robot::RobotModel model;
  const sim::RayWalk walk(arenas::faces(maze()));
  const sim::BeamTable table(model.laser);
  sim::Beams beams;
  sim::swept_beams(moving(), model, table, Stamp::from_seconds(0.0043), model.laser.beam_period, beams);
  for (auto _ : state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < beams.count; ++i) sum += std::min(4.0, walk.cast(beams.ray(i), 4.0));
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(RayWalkScan)->Apply(best_of_many);

void LaserScan(benchmark::State& state, bool is_moving, double noise) {
  const robot::RobotModel model;
  sim::Laser laser(maze(), model, noise, true, 1);
  std::vector<sim::WorldState> states = moving();
  if (!is_moving) {
    for (sim::WorldState& s : states) {
      const Stamp stamp = s.stamp;
      s = states[0];
      s.stamp = stamp;
    }
  }
  const auto balls = spheres();
  for (auto _ : state) benchmark::DoNotOptimize(laser.scan(Stamp::from_seconds(0.0043), states, balls));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(LaserScan, swept_exact, true, 0.0)->Apply(best_of_many);
BENCHMARK_CAPTURE(LaserScan, swept_noise, true, 1.0)->Apply(best_of_many);
BENCHMARK_CAPTURE(LaserScan, still_exact, false, 0.0)->Apply(best_of_many);
BENCHMARK_CAPTURE(LaserScan, still_noise, false, 1.0)->Apply(best_of_many);

/// The yardstick: Box2D's own ray cast against the same walls and balls, level, one pose.
void Box2dRayCastScan(benchmark::State& state) {
  class Nearest : public b2RayCastCallback {
   public:
    float ReportFixture(b2Fixture*, const b2Vec2&, const b2Vec2&, float fraction) override {
      nearest = fraction;
      return fraction;
    }
    float nearest = 1.0f;
  };
  const robot::RobotModel model;
  b2World world(b2Vec2(0.0f, 0.0f));
  const sim::PlanOrigin origin{};
  sim::Obstacles obstacles(world, origin, maze(), model.climbable_step);
  const sim::Terrain terrain(maze(), model.climbable_step);
  const sim::Clutter clutter(world, origin, terrain, obstacles, maze().balls, {});
  const sim::BeamTable table(model.laser);
  const b2Vec2 from = origin.to_box2d({maze().start.x, maze().start.y});
  for (auto _ : state) {
    float sum = 0.0f;
    for (std::size_t i = 0; i < table.cosine.size(); ++i) {
      Nearest nearest;
      world.RayCast(&nearest, from,
                    from + 4.0f * b2Vec2(static_cast<float>(table.cosine[i]), static_cast<float>(table.sine[i])));
      sum += nearest.nearest;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Box2dRayCastScan)->Apply(best_of_many);

/// The other yardstick: MRPT's walk through an occupancy grid of 0.05 m, level, one pose, without balls.
void MrptLaserScanSimulator(benchmark::State& state) {
  const robot::RobotModel model;
  const OccupancyGrid truth = arenas::truth_map(maze());
  const GridFrame& frame = truth.frame();
  mrpt::maps::COccupancyGridMap2D grid(
      static_cast<float>(frame.x0), static_cast<float>(frame.x0 + frame.width * frame.resolution),
      static_cast<float>(frame.y0), static_cast<float>(frame.y0 + frame.height * frame.resolution), 0.05f);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto p = frame.centre({x, y});
      const float free = truth[{x, y}] == Occupancy::Occupied ? 0.0f : 1.0f;
      grid.setPos(static_cast<float>(p.x), static_cast<float>(p.y), free);
    }
  }
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(model.laser.angle_step * (model.laser.beams - 1));
  scan.maxRange = 4.0f;
  const mrpt::poses::CPose2D pose(maze().start);
  for (auto _ : state) {
    grid.laserScanSimulator(scan, pose, 0.5f, static_cast<std::size_t>(model.laser.beams));
    benchmark::DoNotOptimize(scan);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(MrptLaserScanSimulator)->Apply(best_of_many);

void PhysicsStep(benchmark::State& state, double v, double w) {
  sim::World world(maze(), robot::RobotModel{}, sim::ServoParameters{}, 0.01);
  int step = 0;
  double iterations = 0.0;
  for (auto _ : state) {
    if (step++ % 100 == 0) world.firmware().command({v, w});
    world.step();
    iterations += world.drive().iterations();
  }
  state.counters["iterations"] = iterations / static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(PhysicsStep, standing, 0.0, 0.0)->Apply(best_of_many);
BENCHMARK_CAPTURE(PhysicsStep, turning, 0.0, 0.8)->Apply(best_of_many);
BENCHMARK_CAPTURE(PhysicsStep, against_a_wall, 0.3, 0.0)->Apply(best_of_many);

/// A whole robot on the move for a quarter of an hour, now and then against a wall: the mean over all of it.
void SimRobotRealTimeFactor(benchmark::State& state) {
  sim::SimConfig config;
  config.time_limit = 1e9;
  sim::SimRobot robot(maze(), robot::RobotModel{}, config, 1);
  int tick = 0;
  for (auto _ : state) {
    const double phase = 0.02 * tick++;
    robot.command({{0.15 * std::sin(0.3 * phase), 0.8 * std::sin(0.1 * phase)}, {}});
    benchmark::DoNotOptimize(robot.read());
  }
  state.counters["real_time_factor"] =
      benchmark::Counter(0.02 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(SimRobotRealTimeFactor)->Unit(benchmark::kMicrosecond)->Iterations(45000)->Repetitions(9);

}  // namespace
