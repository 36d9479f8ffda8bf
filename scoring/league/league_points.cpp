#include "scoring/league/league_points.h"

#include <algorithm>
#include <cmath>

#include "scoring/measures/victims.h"
#include "scoring/walls/overlap.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_match.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kPerVictim = 10.0;

/// The part of a grid in a square; cells outside `half` stay unknown.
OccupancyGrid window_of(const OccupancyGrid& grid, const TPoint2D& centre, double half) {
  const double r = grid.resolution();
  const Cell low = grid.cell({centre.x - half, centre.y - half});
  const Cell high = grid.cell({centre.x + half, centre.y + half});
  OccupancyGrid out(
      GridFrame{high.x - low.x + 1, high.y - low.y + 1, r, grid.frame().x0 + low.x * r, grid.frame().y0 + low.y * r});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if (grid.inside({low.x + x, low.y + y})) out[{x, y}] = grid[{low.x + x, low.y + y}];
  return out;
}

/// min(P, R) over the window: the map's walls inside it against all of the truth, and the window's true walls against
/// all of the map.
double agreement(const OccupancyGrid& map, const OccupancyGrid& truth, const OccupancyGrid& truth_window,
                 const TPose2D& T_truth_map, double tau) {
  OccupancyGrid inside = resample(map, T_truth_map, truth_window.frame());
  const double precision = overlap(inside, truth, {}, tau).precision;
  const double recall = overlap(map, truth_window, T_truth_map, tau).recall;
  return std::min(precision, recall);
}

}  // namespace

double local_quality(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
                     const TPoint2D& p_truth, const LeaguePointsConfig& config) {
  const double half = 0.5 * config.window;
  const OccupancyGrid truth_window = window_of(truth, p_truth, half);
  const OccupancyGrid truth_around = window_of(truth, p_truth, half + config.tau);
  const TPoint2D p_map = T_truth_map.inverseComposePoint(p_truth);
  const OccupancyGrid map_around = window_of(map, p_map, std::sqrt(2.0) * half + config.most_drift);
  double best = agreement(map_around, truth_around, truth_window, T_truth_map, config.tau);
  const WallMatch match(map_around, truth_window, config.most_drift, 0);
  if (!match.usable()) return best;
  constexpr int kIterations = 15;
  const double sigmas[] = {0.5, 0.2};
  TPose2D T = T_truth_map;
  for (const double sigma : sigmas) T = match.refine(T, sigma, kIterations);
  if ((T.composePoint(p_map) - p_truth).norm() <= config.most_drift)
    best = std::max(best, agreement(map_around, truth_around, truth_window, T, config.tau));
  return best;
}

LeaguePoints league_points(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
                           const std::vector<Poi>& reported, const std::vector<Poi>& victims,
                           const LeaguePointsConfig& config) {
  std::vector<TPoint2D> p_reported;
  std::vector<TPoint2D> p_victims;
  for (const Poi& poi : reported) p_reported.push_back(poi.p_picture);
  for (const Poi& poi : victims) p_victims.push_back(poi.p_picture);
  const VictimScore matched = score_victims(p_reported, p_victims, T_truth_map, config.worthless);
  LeaguePoints out;
  out.false_alarms = matched.false_alarms;
  for (const Poi& victim : victims) out.victims.push_back({victim.name, "", false, 0.0, 0.0, 0.0});
  for (const VictimMatch& match : matched.matches) {
    VictimPoints& points = out.victims[match.truth];
    points.found = true;
    points.report = reported[match.reported].name;
    points.error_m = match.error_m;
    points.quality = kPerVictim * local_quality(map, truth, T_truth_map, p_victims[match.truth], config);
    const double lost = (match.error_m - config.perfect) / (config.worthless - config.perfect);
    points.location = kPerVictim * std::clamp(1.0 - lost, 0.0, 1.0);
    out.quality += points.quality;
    out.location += points.location;
  }
  out.fine = std::min(out.unfined(), config.false_report * static_cast<double>(out.false_alarms));
  return out;
}

}  // namespace rubble::scoring
