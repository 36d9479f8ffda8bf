#include "scoring/alignment/other_scale.h"

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
  double scale = 1.0;
  TPose2D T_truth_map;
  double agreement = 0.0;
};

Scaled fit(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map, double scale) {
  const SearchConfig search;
  const GridFrame& frame = map.frame();
  const WallMatch match(at_size(map, scale), truth, search.reach, search.max_points);
  const TPoint2D centre = match.map_centre();
  const TPoint2D before(frame.x0 + (centre.x - frame.x0) / scale, frame.y0 + (centre.y - frame.y0) / scale);
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
                                   const SightLines& sights, double score) {
  constexpr double kGood = 0.6, kMuch = 0.2;  // strangers reach a score of 0.2
  constexpr double kStep = 1.03, kFineStep = 1.01, kFinestStep = 1.003, kLeast = 0.02;
  constexpr int kSteps = 12;  // to 0.7 and 1.4 times
  if (!sights.usable()) return std::nullopt;
  const OccupancyGrid clean = without_specks(map);
  Scaled best;
  const auto offer = [&](double scale, const TPose2D& T) {
    const Scaled now = fit(clean, truth, T, scale);
    if (now.agreement > best.agreement) best = now;
  };
  for (const double scale : sizes_about(1.0, kStep, kSteps)) offer(scale, T_truth_map);
  for (const double step : {kFineStep, kFinestStep})
    for (const double scale : sizes_about(best.scale, step, 2)) offer(scale, T_truth_map);
  if (best.agreement < kTightEnough || std::abs(best.scale - 1.0) < kLeast) return std::nullopt;
  const double there = sights.at(at_size(map, best.scale), PlanarTransform(best.T_truth_map)).score;
  if (there < kGood || there < score + kMuch) return std::nullopt;
  return best.scale;
}

}  // namespace rubble::scoring
