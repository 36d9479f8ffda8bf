#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/image/geotiff.h"
#include "scoring/alignment/alignment.h"
#include "scoring/maps/league_map.h"
#include "scoring/maps/normalise.h"
#include "scoring/measures/psi.h"
#include "scoring/proposals/correlation.h"
#include "scoring/proposals/features.h"
#include "scoring/scorecard.h"
#include "scoring/walls/overlap.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_maze.h"

/// Scoring of an 800 x 800 maze (0.05 m), beside the same steps with nothing but OpenCV.
namespace rubble::scoring {
namespace {

using namespace testing;

OccupancyGrid big_truth() {
  MazeSpec spec;
  spec.columns = 32;
  spec.rows = 32;
  spec.margin = 0.8;
  return maze(spec);
}

OccupancyGrid big_map() { return with_gaps(with_phantoms(big_truth(), 60, 1), 60, 1); }

void BM_Psi(benchmark::State& state) {
  const OccupancyGrid truth = big_truth();
  const OccupancyGrid map = big_map();
  for (auto _ : state) benchmark::DoNotOptimize(psi(map, truth, 5.0));
}
BENCHMARK(BM_Psi)->Unit(benchmark::kMillisecond);

cv::Mat mask_of(const OccupancyGrid& grid, Occupancy colour) {
  cv::Mat mask(grid.height(), grid.width(), CV_8U);
  for (std::size_t i = 0; i < grid.cells().size(); ++i) mask.data[i] = grid.cells()[i] == colour ? 0 : 255;
  return mask;
}

void BM_PsiOpenCv(benchmark::State& state) {
  const OccupancyGrid truth = big_truth();
  const OccupancyGrid map = big_map();
  for (auto _ : state) {
    double sum = 0.0;
    for (const Occupancy colour : {Occupancy::Occupied, Occupancy::Free, Occupancy::Unknown}) {
      const cv::Mat in_map = mask_of(map, colour);
      const cv::Mat in_truth = mask_of(truth, colour);
      cv::Mat distance;
      cv::distanceTransform(in_truth, distance, cv::DIST_L1, 3);
      sum += cv::mean(distance, in_map == 0)[0];
      cv::distanceTransform(in_map, distance, cv::DIST_L1, 3);
      sum += cv::mean(distance, in_truth == 0)[0];
    }
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK(BM_PsiOpenCv)->Unit(benchmark::kMillisecond);

void BM_Overlap(benchmark::State& state) {
  const OccupancyGrid truth = big_truth();
  const OccupancyGrid map = big_map();
  for (auto _ : state) benchmark::DoNotOptimize(overlap(map, truth, {}, 0.5));
}
BENCHMARK(BM_Overlap)->Unit(benchmark::kMillisecond);

void BM_Correlate(benchmark::State& state) {
  const OccupancyGrid truth = crop_to_known(big_truth(), 0.0);
  const OccupancyGrid map = crop_to_known(moved(big_map(), 0.7, 3.0, 1.0), 0.0);
  for (auto _ : state) benchmark::DoNotOptimize(correlate(map, truth));
}
BENCHMARK(BM_Correlate)->Unit(benchmark::kMillisecond);

/// Walls only, template matching at the same cell and rotation step: what a script with OpenCV would do.
void BM_CorrelateOpenCv(benchmark::State& state) {
  const auto coarse = [](const OccupancyGrid& grid) {
    cv::Mat walls = 255 - mask_of(grid, Occupancy::Occupied);
    cv::Mat out;
    cv::resize(walls, out, {}, 0.125, 0.125, cv::INTER_AREA);
    out.convertTo(out, CV_32F);
    return out;
  };
  const cv::Mat truth = coarse(crop_to_known(big_truth(), 0.0));
  const cv::Mat map = coarse(crop_to_known(big_map(), 0.0));
  cv::Mat canvas;
  cv::copyMakeBorder(truth, canvas, map.rows, map.rows, map.cols, map.cols, cv::BORDER_CONSTANT);
  for (auto _ : state) {
    double best = 0.0;
    for (int i = 0; i < 180; ++i) {
      const cv::Point2d middle(0.5 * map.cols, 0.5 * map.rows);
      cv::Mat turned;
      cv::warpAffine(map, turned, cv::getRotationMatrix2D(middle, 2.0 * i, 1.0), map.size());
      cv::Mat surface;
      cv::matchTemplate(canvas, turned, surface, cv::TM_CCORR);
      double peak = 0.0;
      cv::minMaxLoc(surface, nullptr, &peak);
      best = std::max(best, peak);
    }
    benchmark::DoNotOptimize(best);
  }
}
BENCHMARK(BM_CorrelateOpenCv)->Unit(benchmark::kMillisecond);

void BM_Align(benchmark::State& state) {
  const OccupancyGrid truth = crop_to_known(big_truth(), 0.0);
  const OccupancyGrid map = crop_to_known(moved(big_map(), 0.7, 3.0, 1.0), 0.0);
  for (auto _ : state) benchmark::DoNotOptimize(align(map, truth));
}
BENCHMARK(BM_Align)->Unit(benchmark::kMillisecond);

void BM_ScoreMap(benchmark::State& state) {
  const OccupancyGrid truth = big_truth();
  const OccupancyGrid map = moved(big_map(), 0.7, 3.0, 1.0);
  for (auto _ : state) benchmark::DoNotOptimize(score_map(map, truth));
}
BENCHMARK(BM_ScoreMap)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void BM_ScoreMapWithWarp(benchmark::State& state) {
  const OccupancyGrid truth = big_truth();
  const OccupancyGrid map = moved(big_map(), 0.7, 3.0, 1.0);
  ScoreConfig config;
  config.warp = true;
  for (auto _ : state) benchmark::DoNotOptimize(score_map(map, truth, config));
}
BENCHMARK(BM_ScoreMapWithWarp)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

/// Both maps from files. With RUBBLE_MAPS=FOLDER `map.tif` and `truth.tif` stay there, to be scored by the program.
void BM_ScoreFiles(benchmark::State& state) {
  const char* kept = std::getenv("RUBBLE_MAPS");
  const std::filesystem::path folder = kept != nullptr ? kept : std::filesystem::temp_directory_path();
  const std::string map = folder / "map.tif";
  const std::string truth = folder / "truth.tif";
  write_geotiff(map, draw_truth(moved(big_map(), 0.7, 3.0, 1.0)));
  write_geotiff(truth, draw_truth(big_truth()));
  for (auto _ : state) benchmark::DoNotOptimize(score_map(load_map(map).grid, load_map(truth).grid));
  if (kept != nullptr) return;
  std::filesystem::remove(map);
  std::filesystem::remove(truth);
}
BENCHMARK(BM_ScoreFiles)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void BM_Features(benchmark::State& state) {
  const OccupancyGrid map = big_map();
  const auto kind = static_cast<FeatureKind>(state.range(0));
  state.SetLabel(name_of(kind));
  for (auto _ : state) benchmark::DoNotOptimize(find_features(map, kind));
}
BENCHMARK(BM_Features)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rubble::scoring
