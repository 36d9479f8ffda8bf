#include "scoring/alignment/other_scale.h"

#include <algorithm>
#include <cmath>

#include "scoring/alignment/pose_search.h"
#include "scoring/alignment/trust.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/specks.h"
#include "scoring/walls/wall_match.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// The map at another size, laid where its middle was.
struct Scaled {
  double scale = 0.0;
  TPose2D T_truth_map;
  double agreement = 0.0;
};

/// `T_truth_map`: of the map at `about` times its size.
Scaled fit(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map, double about,
           double scale) {
  const SearchConfig search;
  const GridFrame& frame = map.frame();
  const WallMatch match(at_size(map, scale), truth, search.reach, search.max_points);
  const TPoint2D centre = match.map_centre();
  const double back = about / scale;
  const TPoint2D before(frame.x0 + (centre.x - frame.x0) * back, frame.y0 + (centre.y - frame.y0) * back);
  const TPoint2D there = T_truth_map.composePoint(before);
  TPose2D T(0.0, 0.0, T_truth_map.phi);
  const TPoint2D turned = T.composePoint(centre);
  T.x = there.x - turned.x;
  T.y = there.y - turned.y;
  for (const double sigma : {1.0, 0.5, 0.25}) T = match.refine(T, sigma, 10);
  return {scale, T, tight_agreement(match.evidence(match.rigid(T), match.kernel(search.tau_tight)))};
}

}  // namespace

std::optional<double> better_scale(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
                                   const SightLines& sights, double score, double about) {
  constexpr double kGood = 0.6, kMuch = 0.2;  // strangers reach a score of 0.2
  constexpr double kStep = 1.03, kFineStep = 1.01, kFinestStep = 1.003, kLeast = 0.02;
  constexpr int kSteps = 12;  // to 0.7 and 1.4 times
  if (!sights.usable()) return std::nullopt;
  const OccupancyGrid clean = without_specks(map);
  Scaled best;
  const auto offer = [&](double scale) {
    const Scaled now = fit(clean, truth, T_truth_map, about, scale);
    if (now.agreement > best.agreement) best = now;
  };
  for (const double scale : sizes_about(about, kStep, kSteps)) offer(scale);
  if (best.agreement == 0.0) return std::nullopt;
  for (const double step : {kFineStep, kFinestStep})
    for (const double scale : sizes_about(best.scale, step, 2)) offer(scale);
  if (best.agreement < kTightEnough || std::abs(best.scale - 1.0) < kLeast) return std::nullopt;
  const double there = sights.at(at_size(map, best.scale), PlanarTransform(best.T_truth_map)).score;
  if (there < kGood || there < score + kMuch) return std::nullopt;
  return best.scale;
}

std::vector<double> sizes_by_extent(const OccupancyGrid& map, const OccupancyGrid& truth) {
  constexpr double kAlike = 1.06;  // what better_scale() finds from there as well
  constexpr double kMost = 4.0;    // more is no mistake that anybody makes
  const auto free_m2 = [](const OccupancyGrid& grid) {
    return static_cast<double>(std::count(grid.cells().begin(), grid.cells().end(), Occupancy::Free)) *
           grid.resolution() * grid.resolution();
  };
  const auto box_m2 = [](const OccupancyGrid& grid) {
    const std::optional<GridFrame> box = known_frame(grid, 0.0);
    return box ? static_cast<double>(box->size()) * box->resolution * box->resolution : 0.0;
  };
  std::vector<double> out;
  const auto offer = [&](double of_map, double of_truth) {
    if (of_map <= 0.0 || of_truth <= 0.0) return;
    const double size = std::sqrt(of_truth / of_map);
    const auto is_alike = [&](double other) { return std::max(size, other) < kAlike * std::min(size, other); };
    if (size > kMost || size < 1.0 / kMost || is_alike(1.0) || std::any_of(out.begin(), out.end(), is_alike)) return;
    out.push_back(size);
  };
  offer(free_m2(map), free_m2(truth));
  offer(box_m2(map), box_m2(truth));
  return out;
}

}  // namespace rubble::scoring
