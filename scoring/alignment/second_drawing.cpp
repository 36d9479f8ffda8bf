#include "scoring/alignment/second_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "base/rigid.h"
#include "scoring/alignment/drawing_sizes.h"
#include "scoring/alignment/pose_search.h"
#include "scoring/measures/off_truth.h"
#include "scoring/proposals/correlation.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/specks.h"

namespace rubble::scoring {
namespace {

constexpr double kLegend = 0.1;    // of what lies on the truth: less is no drawing
constexpr double kAlike = 0.25;    // score: strangers reach 0.2 at their best pose
constexpr double kClear = 0.6;     // the same that leaves no doubt about the size
constexpr double kMirrored = 0.5;  // the same of a mirror image, lest there be twice as much luck
constexpr double kSizeStep = 1.05;
constexpr int kSizeSteps = 19;       // to 0.4 and 2.5 times the size
constexpr int kSizeStepsNear = 7;    // to 0.7 and 1.4 times: tried however much ground there is; of a bare truth no
                                     // others, for an empty hall is any other one at another size
constexpr int kSizeStepsTold = 1;    // about each size that extents tell
constexpr double kMostGround = 4.0;  // of the truth's, that a drawing of another size covers
constexpr std::size_t kPoses = 3;    // the best of each size ...
constexpr int kGuesses = 6;          // ... of so many
// Of a drawing that came apart.
constexpr std::size_t kHalfPoses = 5;  // the best of each half
constexpr double kHalvesAlike = 0.4;   // both scores: halves of strangers reach 0.37
constexpr double kApart = 2.5;         // halves that lie further apart are none of one drawing [m]
constexpr double kTurned = 0.6;        // [rad]
constexpr double kApartBare = 1.6;     // the same on a bare truth
constexpr double kTurnedBare = 0.25;   // [rad]
constexpr double kShownTwice = 0.5;    // of the ground that the halves show, what the first drawing shows, too

/// What the map knows on the truth and away from it, and how much there is of either [cells].
struct Parted {
  OccupancyGrid on;
  OccupancyGrid off;
  double cells_on = 0.0;
  double cells_off = 0.0;
};

Parted part(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map) {
  const OffTruth off_truth(truth, kSurvey);
  Parted out{OccupancyGrid(map.frame()), OccupancyGrid(map.frame())};
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] == Occupancy::Unknown) continue;
      const bool on = off_truth(T_truth_map(map.centre({x, y}))) <= kSurvey;
      (on ? out.cells_on : out.cells_off) += 1.0;
      (on ? out.on : out.off)[{x, y}] = map[{x, y}];
    }
  return out;
}

/// What is left without pieces of less than a hundredth of it: ends of strips, rays that went astray.
OccupancyGrid without_crumbs(const OccupancyGrid& drawing) {
  constexpr double kCrumb = 0.01;
  cv::Mat known(drawing.height(), drawing.width(), CV_8U);
  for (std::size_t i = 0; i < drawing.cells().size(); ++i)
    known.data[i] = drawing.cells()[i] != Occupancy::Unknown ? 255 : 0;
  cv::Mat labels, stats, centres;
  const int pieces = cv::connectedComponentsWithStats(known, labels, stats, centres, 8);
  const double least = kCrumb * cv::countNonZero(known);
  OccupancyGrid out = drawing;
  for (int y = 0; y < drawing.height(); ++y)
    for (int x = 0; x < drawing.width(); ++x) {
      const int piece = labels.at<int>(y, x);
      if (pieces > 1 && piece > 0 && stats.at<int>(piece, cv::CC_STAT_AREA) < least) out[{x, y}] = Occupancy::Unknown;
    }
  return out;
}

/// Where a drawing lies on the truth, and how far it agrees there.
struct Placed {
  PlanarTransform T_truth_drawing;
  double score = 0.0;
};

std::vector<Placed> best_places(const OccupancyGrid& drawing, const OccupancyGrid& truth, const SightLines& sights,
                                std::size_t most, const CorrelationConfig& guesses = {}) {
  std::vector<Placed> out;
  const SearchConfig search;
  const WallMatch match(drawing, truth, search.reach, search.max_points);
  if (!match.usable()) return out;
  const SightMap seen(drawing);
  const std::vector<Hypothesis> hypotheses = examine(correlate(drawing, truth, guesses), match, search);
  for (std::size_t i = 0; i < std::min(most, hypotheses.size()); ++i) {
    const PlanarTransform T(hypotheses[i].T_best);
    out.push_back({T, sights.at(seen, T).score});
  }
  return out;
}

/// The best that the drawing earns at one of its best poses.
double best_score(const OccupancyGrid& drawing, const OccupancyGrid& truth, const SightLines& sights) {
  CorrelationConfig few;
  few.guesses = kGuesses;
  double best = 0.0;
  for (const Placed& at : best_places(drawing, truth, sights, kPoses, few)) best = std::max(best, at.score);
  return best;
}

/// How many times as much ground the drawing covers at the size at which it draws the truth again.
std::optional<double> ground_where_alike(const OccupancyGrid& drawing, const OccupancyGrid& on,
                                         const OccupancyGrid& truth, const SightLines& sights) {
  std::vector<double> sizes = sizes_about(1.0, kSizeStep, sights.bare() ? kSizeStepsNear : kSizeSteps);
  std::vector<AxisSizes> stretches;
  std::vector<double> mirrored = {1.0};
  for (const OccupancyGrid* const other : {&truth, &on}) {
    if (sights.bare()) break;
    const ToldSizes told = sizes_told(drawing, *other);
    mirrored.insert(mirrored.end(), told.sizes.begin(), told.sizes.end());
    for (const double size : told.sizes)
      for (const double near : sizes_about(size, kSizeStep, kSizeStepsTold))
        if (near < sizes.front() / kSizeStep || near > kSizeStep / sizes.front()) sizes.push_back(near);
    stretches.insert(stretches.end(), told.stretches.begin(), told.stretches.end());
  }
  // With less ground it cannot earn that; with much more it is not what it is at its own size.
  const double own = known_m2(drawing) / known_m2(truth);
  const auto may_draw_all = [&](double times) { return times * own >= kAlike && times * own <= kMostGround; };
  const double nearest_beyond = std::pow(kSizeStep, kSizeStepsNear + 0.5);
  const auto is_near = [&](double size) { return std::max(size, 1.0 / size) < nearest_beyond; };
  double best = 0.0;
  double ground = 0.0;
  const auto offer = [&](const OccupancyGrid& as, double times) {
    const double score = best_score(as, truth, sights);
    if (score <= best) return;
    best = score;
    ground = times;
  };
  for (const double size : sizes)
    if (may_draw_all(size * size) || is_near(size)) offer(at_size(drawing, size), size * size);
  if (best < kClear)
    for (const AxisSizes& by : stretches)
      if (may_draw_all(by.along * by.across)) offer(stretched(drawing, by), by.along * by.across);
  if (best >= kAlike) return ground;
  const OccupancyGrid image = mirror_image(drawing);
  for (const double size : mirrored)
    if (!sights.bare() && may_draw_all(size * size) && best_score(at_size(image, size), truth, sights) >= kMirrored)
      return size * size;
  return std::nullopt;
}

struct Halves {
  OccupancyGrid first;
  OccupancyGrid second;
};

/// Cut where half of what the drawing knows lies to either side: west and east, or south and north.
Halves halves_of(const OccupancyGrid& drawing, bool west_east) {
  std::vector<int> along;
  for (int y = 0; y < drawing.height(); ++y)
    for (int x = 0; x < drawing.width(); ++x)
      if (drawing[{x, y}] != Occupancy::Unknown) along.push_back(west_east ? x : y);
  Halves out{OccupancyGrid(drawing.frame()), OccupancyGrid(drawing.frame())};
  if (along.empty()) return out;
  const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
  std::nth_element(along.begin(), middle, along.end());
  for (int y = 0; y < drawing.height(); ++y)
    for (int x = 0; x < drawing.width(); ++x)
      ((west_east ? x : y) < *middle ? out.first : out.second)[{x, y}] = drawing[{x, y}];
  out.first = crop_to_known(out.first, 0.0);
  out.second = crop_to_known(out.second, 0.0);
  return out;
}

bool is_known(const OccupancyGrid& grid, const mrpt::math::TPoint2D& p) {
  const Cell c = grid.cell(p);
  return grid.inside(c) && grid[c] != Occupancy::Unknown;
}

/// Share of the truth's ground shown by either half that the map shows where it lies on the truth, too.
double shown_twice(const Halves& halves, const Placed& first, const Placed& second, const OccupancyGrid& map,
                   const PlanarTransform& T_truth_map, const OccupancyGrid& truth) {
  double shown = 0.0;
  double twice = 0.0;
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x) {
      const mrpt::math::TPoint2D p = truth.centre({x, y});
      if (truth[{x, y}] == Occupancy::Unknown) continue;
      if (!is_known(halves.first, first.T_truth_drawing.inverse(p)) &&
          !is_known(halves.second, second.T_truth_drawing.inverse(p)))
        continue;
      shown += 1.0;
      twice += is_known(map, T_truth_map.inverse(p)) ? 1.0 : 0.0;
    }
  return shown > 0.0 ? twice / shown : 0.0;
}

/// A drawing that came apart agrees with the truth nowhere as a whole. Its halves do, at two poses that are near each
/// other: by luck one half of a stranger agrees somewhere, but hardly both at such poses.
bool alike_in_halves(const OccupancyGrid& drawing, const OccupancyGrid& map, const PlanarTransform& T_truth_map,
                     const OccupancyGrid& truth, const SightLines& sights) {
  const double apart = sights.bare() ? kApartBare : kApart;
  const double turned = sights.bare() ? kTurnedBare : kTurned;
  const mrpt::math::TPoint2D middle = drawing.centre({drawing.width() / 2, drawing.height() / 2});
  for (const bool west_east : {true, false}) {
    const Halves halves = halves_of(drawing, west_east);
    const std::vector<Placed> firsts = best_places(halves.first, truth, sights, kHalfPoses);
    const std::vector<Placed> seconds = best_places(halves.second, truth, sights, kHalfPoses);
    for (const Placed& first : firsts)
      for (const Placed& second : seconds) {
        if (first.score + second.score < kHalvesAlike) continue;
        if (!same_pose(first.T_truth_drawing.pose(), second.T_truth_drawing.pose(), middle, apart, turned)) continue;
        if (shown_twice(halves, first, second, map, T_truth_map, truth) >= kShownTwice) return true;
      }
  }
  return false;
}

}  // namespace

double second_drawing_share(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map,
                            const SightLines& sights) {
  if (!sights.usable() || map.cells().empty()) return 0.0;
  const Parted parted = part(map, truth, T_truth_map);
  if (parted.cells_on <= 0.0 || parted.cells_off < kLegend * parted.cells_on) return 0.0;
  const OccupancyGrid drawing = crop_to_known(without_crumbs(without_specks(parted.off)), 0.0);
  std::optional<double> ground = ground_where_alike(drawing, parted.on, truth, sights);
  if (!ground && alike_in_halves(drawing, map, T_truth_map, truth, sights)) ground = 1.0;
  if (!ground) return 0.0;
  // A small drawing is as much of a guess as a large one.
  const double off = parted.cells_off * std::max(1.0, *ground);
  return off / (parted.cells_on + off);
}

}  // namespace rubble::scoring
