#include <benchmark/benchmark.h>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/render.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"

namespace {

using namespace rubble::arenas;

GenerateConfig square(std::int64_t pallets) {
  GenerateConfig config;
  config.columns = config.rows = static_cast<int>(pallets);
  return config;
}

Arena generated(std::int64_t pallets) { return parse_arena(generate_arena(square(pallets)), "generated"); }

void generate(benchmark::State& state) {
  GenerateConfig config = square(state.range(0));
  for (auto _ : state) {
    ++config.seed;
    benchmark::DoNotOptimize(generate_arena(config));
  }
}
BENCHMARK(generate)->Arg(8)->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);

void parse(benchmark::State& state) {
  const std::string text = generate_arena(square(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(parse_arena(text, "generated"));
}
BENCHMARK(parse)->Arg(8)->Arg(60)->Unit(benchmark::kMillisecond);

void all_faces(benchmark::State& state) {
  const Arena arena = generated(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(faces(arena));
}
BENCHMARK(all_faces)->Arg(8)->Arg(60)->Unit(benchmark::kMillisecond);

void ground_truth(benchmark::State& state) {
  const Arena arena = generated(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(truth_map(arena));
}
BENCHMARK(ground_truth)->Arg(8)->Arg(60)->Unit(benchmark::kMillisecond);

/// range(1): of the scanner [m].
void visible(benchmark::State& state) {
  const Arena arena = generated(state.range(0));
  const rubble::OccupancyGrid truth = truth_map(arena);
  Viewer viewer;
  viewer.range = static_cast<double>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(visible_truth(arena, truth, viewer));
}
BENCHMARK(visible)->Args({8, 4})->Args({8, 30})->Args({60, 4})->Unit(benchmark::kMillisecond);

void plan_picture(benchmark::State& state) {
  const Arena arena = generated(8);
  for (auto _ : state) benchmark::DoNotOptimize(render(arena));
}
BENCHMARK(plan_picture)->Unit(benchmark::kMillisecond);

}  // namespace
