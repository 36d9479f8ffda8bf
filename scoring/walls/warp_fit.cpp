#include "scoring/walls/warp_fit.h"

#include <algorithm>

namespace rubble::scoring {
namespace {

constexpr double kReach = 2.0;  // walls further apart than this do not pull on each other [m]

Warp fit(const WallMatch& match, const mrpt::math::TPose2D& T_truth_map, int degree, double stiffness) {
  Warp warp = match.rigid(T_truth_map, degree);
  for (const double sigma : {1.0, 0.5, 0.25})
    warp = match.refine(warp, sigma, {0.0, stiffness, 2.0 * stiffness, 4.0 * stiffness}, 8);
  return warp;
}

}  // namespace

bool keeps_order(const Warp& warp, const GridFrame& frame) {
  const double width = frame.width * frame.resolution;
  const double height = frame.height * frame.resolution;
  for (double y = 0.0; y <= height; y += 1.0)
    for (double x = 0.0; x <= width; x += 1.0)
      if (warp.jacobian({frame.x0 + x, frame.y0 + y}) <= 0.0) return false;
  return true;
}

WarpedScore fit_warp(const OccupancyGrid& map, const OccupancyGrid& truth, const WallOverlap& walls,
                     const mrpt::math::TPose2D& T_truth_map, const WarpConfig& config) {
  const WallMatch match(map, truth, kReach, config.max_points);
  WarpedScore best;
  best.warp = match.rigid(T_truth_map, config.degree);
  best.overlap = walls.at(PlanarTransform(T_truth_map));
  for (const double stiffer : {1.0, 10.0, 100.0}) {
    const Warp warp = fit(match, T_truth_map, config.degree, stiffer * config.stiffness);
    if (!keeps_order(warp, map.frame())) continue;
    const Overlap overlap = walls.at(warp);
    if (overlap.score <= best.overlap.score) continue;
    best.warp = warp;
    best.overlap = overlap;
    best.size = match.bend(warp);
    best.kept = std::max(0.0, 1.0 - best.size / config.intolerable);
  }
  return best;
}

}  // namespace rubble::scoring
