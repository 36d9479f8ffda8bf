#include "scoring/alignment/second_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/distance_transform.h"
#include "scoring/alignment/pose_search.h"
#include "scoring/proposals/correlation.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/specks.h"

namespace rubble::scoring {
namespace {

constexpr double kSurvey = 0.5;  // what a map knows so near to the truth's known ground belongs to it [m]
constexpr double kLegend = 0.1;  // of what lies on the truth: less is no drawing
constexpr double kAlike = 0.25;  // score: strangers reach 0.2 at their best pose
constexpr double kSizeStep = 1.05;
constexpr int kSizeSteps = 7;      // to 0.7 and 1.4 times the size
constexpr std::size_t kPoses = 3;  // the best of each size

/// What the map knows away from the truth, and how much of it there is on and off it [cells].
struct Parted {
  OccupancyGrid off;
  double cells_on = 0.0;
  double cells_off = 0.0;
};

Parted part(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map) {
  GridFrame frame = truth.frame();
  const int rim = static_cast<int>(std::ceil(kSurvey / frame.resolution)) + 1;
  frame.x0 -= rim * frame.resolution;
  frame.y0 -= rim * frame.resolution;
  frame.width += 2 * rim;
  frame.height += 2 * rim;
  Grid<std::uint8_t> known(frame);
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x) known[{x + rim, y + rim}] = truth[{x, y}] != Occupancy::Unknown ? 1 : 0;
  const Grid<float> away = distance_transform(known, 2.0 * kSurvey);
  Parted out{OccupancyGrid(map.frame())};
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] == Occupancy::Unknown) continue;
      const Cell c = away.cell(T_truth_map(map.centre({x, y})));
      const bool on = away.inside(c) && static_cast<double>(away[c]) <= kSurvey;
      (on ? out.cells_on : out.cells_off) += 1.0;
      if (!on) out.off[{x, y}] = map[{x, y}];
    }
  return out;
}

/// The drawing agrees with the truth at one of its best poses.
bool alike(const OccupancyGrid& drawing, const OccupancyGrid& truth, const SightLines& sights) {
  const SearchConfig search;
  const WallMatch match(drawing, truth, search.reach, search.max_points);
  if (!match.usable()) return false;
  const SightMap seen(drawing);
  const std::vector<Hypothesis> hypotheses = examine(correlate(drawing, truth, {}), match, search);
  for (std::size_t i = 0; i < std::min(kPoses, hypotheses.size()); ++i)
    if (sights.at(seen, PlanarTransform(hypotheses[i].T_best)).score >= kAlike) return true;
  return false;
}

}  // namespace

double second_drawing_share(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map,
                            const SightLines& sights) {
  if (!sights.usable() || map.cells().empty()) return 0.0;
  const Parted parted = part(map, truth, T_truth_map);
  if (parted.cells_on <= 0.0 || parted.cells_off < kLegend * parted.cells_on) return 0.0;
  const OccupancyGrid drawing = crop_to_known(without_specks(parted.off), 0.0);
  const std::vector<double> sizes = sizes_about(1.0, kSizeStep, kSizeSteps);
  const bool again = std::any_of(sizes.begin(), sizes.end(),
                                 [&](double size) { return alike(at_size(drawing, size), truth, sights); });
  return again ? parted.cells_off / (parted.cells_on + parted.cells_off) : 0.0;
}

}  // namespace rubble::scoring
