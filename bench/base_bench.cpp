#include <benchmark/benchmark.h>

#include <filesystem>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "base/distance_transform.h"
#include "base/image/geotiff.h"
#include "base/rng.h"

namespace rubble {
namespace {

constexpr int kSide = 800;

/// Rooms of 24 cells with walls one cell thick, like pallets at 5 cm; a third of the walls stands.
Grid<std::uint8_t> maze() {
  Grid<std::uint8_t> mask(GridFrame{kSide, kSide, 0.05, 0.0, 0.0});
  Rng rng(1, "maze");
  for (int y = 0; y < kSide; y += 24)
    for (int x = 0; x < kSide; x += 24) {
      const bool east = rng.below(3) == 0;
      const bool north = rng.below(3) == 0;
      for (int i = 0; i < 24; ++i) {
        if (east && x + i < kSide) mask[{x + i, y}] = 1;
        if (north && y + i < kSide) mask[{x, y + i}] = 1;
      }
    }
  return mask;
}

/// A few lonely cells: every cell is far from the next set one.
Grid<std::uint8_t> sparse() {
  Grid<std::uint8_t> mask(GridFrame{kSide, kSide, 0.05, 0.0, 0.0});
  for (int i = 0; i < 5; ++i) mask[{100 + 137 * i, 700 - 97 * i}] = 1;
  return mask;
}

void euclidean(benchmark::State& state, const Grid<std::uint8_t>& mask, double cap) {
  for (auto _ : state) benchmark::DoNotOptimize(distance_transform(mask, cap));
}

void opencv(benchmark::State& state, const Grid<std::uint8_t>& mask, int kind, int size) {
  cv::setNumThreads(1);
  cv::Mat image(kSide, kSide, CV_8U);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) image.at<std::uint8_t>(y, x) = mask[{x, y}] != 0 ? 0 : 255;
  cv::Mat distance;
  for (auto _ : state) cv::distanceTransform(image, distance, kind, size);
}

/// A league map: a few flat colours.
GeoTiff league_map() {
  GeoTiff tiff;
  tiff.image = RgbImage(kSide, kSide);
  const Grid<std::uint8_t> walls = maze();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) std::fill_n(tiff.image.pixel(x, y), 3, walls[{x, y}] != 0 ? 20 : 226);
  tiff.transform = georeference(-20.0, 20.0, 0.05, GeoAnchor{50.36, 7.56, 33.0}, tiff.epsg);
  return tiff;
}

std::string map_path() { return (std::filesystem::temp_directory_path() / "rubble-bench.tif").string(); }

void write_map(benchmark::State& state) {
  const GeoTiff tiff = league_map();
  for (auto _ : state) write_geotiff(map_path(), tiff);
  std::filesystem::remove(map_path());
}

void read_map(benchmark::State& state) {
  write_geotiff(map_path(), league_map());
  for (auto _ : state) benchmark::DoNotOptimize(read_geotiff(map_path()));
  std::filesystem::remove(map_path());
}

void gaussian(benchmark::State& state) {
  Rng rng(1, "bench");
  for (auto _ : state) benchmark::DoNotOptimize(rng.gaussian());
}

BENCHMARK(write_map)->Unit(benchmark::kMillisecond);
BENCHMARK(read_map)->Unit(benchmark::kMillisecond);
BENCHMARK(gaussian);

constexpr double kNoCap = std::numeric_limits<double>::infinity();
BENCHMARK_CAPTURE(euclidean, maze_cap_1m, maze(), 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(euclidean, maze_cap_5m, maze(), 5.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(euclidean, maze_no_cap, maze(), kNoCap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(euclidean, sparse_cap_1m, sparse(), 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(euclidean, sparse_cap_5m, sparse(), 5.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(euclidean, sparse_no_cap, sparse(), kNoCap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(opencv, maze_exact, maze(), cv::DIST_L2, cv::DIST_MASK_PRECISE)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(opencv, maze_5x5, maze(), cv::DIST_L2, 5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(opencv, sparse_exact, sparse(), cv::DIST_L2, cv::DIST_MASK_PRECISE)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rubble
