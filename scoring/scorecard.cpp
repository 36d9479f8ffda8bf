#include "scoring/scorecard.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "scoring/alignment/alignment.h"
#include "scoring/alignment/feature_score.h"
#include "scoring/alignment/other_scale.h"
#include "scoring/alignment/second_drawing.h"
#include "scoring/alignment/trust.h"
#include "scoring/measures/beyond_walls.h"
#include "scoring/measures/detached.h"
#include "scoring/measures/psi.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/overlap.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/warp_fit.h"

namespace rubble::scoring {
namespace {

constexpr double kCanvasMargin = 1.0;  // unknown cells around both maps when psi is taken [m]

double known_share(const OccupancyGrid& map, const OccupancyGrid& truth) {
  std::size_t known = 0;
  std::size_t total = 0;
  for (std::size_t i = 0; i < truth.cells().size(); ++i) {
    if (truth.cells()[i] == Occupancy::Unknown) continue;
    ++total;
    if (map.cells()[i] != Occupancy::Unknown) ++known;
  }
  return total == 0 ? 0.0 : static_cast<double>(known) / static_cast<double>(total);
}

void fill_psi(MapScore& out, const Psi& psi) {
  out.psi_m = psi.mean;
  out.psi_literal_m = psi.literal;
  out.psi_occupied_map_m = psi.occupied.map_to_truth;
  out.psi_occupied_truth_m = psi.occupied.truth_to_map;
  out.psi_free_map_m = psi.free.map_to_truth;
  out.psi_free_truth_m = psi.free.truth_to_map;
}

/// Without a pose no class has a counterpart.
Psi psi_of_strangers(double cap) {
  const PsiClass absent{cap, cap};
  return {absent, absent, absent, 6.0 * cap, cap};
}

/// The scale at which the maps do agree, of those that people mix up; 0 where there is none.
double agreeing_scale(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config) {
  AlignmentConfig by_walls = config;
  by_walls.by = AlignBy::Walls;
  for (const double scale : {0.5, 2.0})
    if (align(at_size(map, scale), truth, by_walls).aligned) return scale;
  return 0.0;
}

std::string scale_note(double scale, double resolution) {
  char text[160];
  std::snprintf(text, sizeof text, "not aligned: wrong scale? walls fit at %.3g of this size; give --resolution %.3g",
                scale, scale * resolution);
  return text;
}

/// Both measures of the walls of one map and the truth, for many poses.
struct Walls {
  Walls(const OccupancyGrid& the_map, const OccupancyGrid& truth, double tau)
      : map(the_map), overlaps(the_map, truth, tau), sights(truth), seen(the_map) {}
  /// Where the truth has no lines of sight worth asking about, the overlap stands for them.
  template <class Transform>
  double score(const Transform& T) const {
    return sights.usable() ? sights.at(seen, T).score : overlaps.at(T).score;
  }
  const OccupancyGrid& map;
  WallOverlap overlaps;
  SightLines sights;
  SightMap seen;
};

/// Eqs. (7) and (8) over features instead of walls.
void fill_features(MapScore& out, const OccupancyGrid& map, const MapFeatures& of_map, const OccupancyGrid& truth,
                   const TruthFeatures& of_truth, const Walls& walls) {
  out.features = feature_error(of_map, of_truth.features, EvidenceKind::Surf, out.T_truth_map);
  out.by_features = judge_features(map, of_map, truth, of_truth, out.T_truth_map);
  const FeatureWarp warp = fit_feature_warp(of_map, of_truth.features, out.T_truth_map, map.frame());
  out.feature_warp_m = warp.size;
  out.feature_warped_score = std::max(out.score, walls.score(warp.warp) * (1.0 - out.detached));
}

/// A polynomial bends; a map that came apart has a step. Whichever explains more is what happened to it.
void fill_break(MapScore& out, const OccupancyGrid& map, const OccupancyGrid& truth, MapBreak seam,
                const Walls& walls) {
  constexpr double kLeastGain = 0.02;
  constexpr double kLeastShare = 0.3;  // of what is missing to 1
  out.mended_score = out.score;
  if (!seam.found) return;
  const OccupancyGrid whole = mended(map, truth, seam);
  const double score = walls.sights.usable() ? walls.sights.at(whole, PlanarTransform()).score
                                             : overlap(whole, truth, {}, walls.overlaps.tau()).score;
  const double smooth = std::max(out.score, out.warped_score);
  seam.found = score * (1.0 - out.detached) >= smooth + std::min(kLeastGain, kLeastShare * (1.0 - smooth));
  if (!seam.found) return;
  out.broken = seam;
  out.mended_score = score * (1.0 - out.detached);
}

void fill_warp(MapScore& out, const OccupancyGrid& map, const OccupancyGrid& truth, const Walls& walls,
               const std::shared_ptr<const TruthFeatures>& known) {
  // None of these waits for another: on other processors, where there are any.
  auto of_truth =
      std::async([&] { return known ? known : std::make_shared<const TruthFeatures>(truth_features(truth)); });
  auto seam = std::async([&map, &truth, T = out.T_truth_map] { return find_break(map, truth, T); });
  auto of_map = std::async([&] { return features_of(map); });
  const WarpedScore warped = fit_warp(map, truth, walls.overlaps, out.T_truth_map);
  out.warped = true;
  out.warp_m = warped.size;
  out.warped_score = std::max(out.score, walls.score(warped.warp) * (1.0 - out.detached));
  out.penalised_score = std::max(out.score, out.warped_score * warped.kept);
  fill_features(out, map, of_map.get(), truth, *of_truth.get(), walls);
  fill_break(out, map, truth, seam.get(), walls);
}

/// A second drawing on the canvas is a second guess: each is worth its share.
void fill_sights(MapScore& out, const OccupancyGrid& truth, const Walls& walls) {
  const SightAgreement sights = walls.sights.at(walls.seen, PlanarTransform(out.T_truth_map));
  out.sight_known = sights.known;
  out.sight_kappa = sights.kappa;
  const PlanarTransform T(out.T_truth_map);
  out.detached = std::max({detached_share(walls.map, truth, T), share_beyond_walls(walls.map, truth, T),
                           second_drawing_share(walls.map, truth, T, walls.sights)});
  const double score = walls.sights.usable() ? sights.score : walls.overlaps.at(PlanarTransform(out.T_truth_map)).score;
  out.score_at_best_pose = score * (1.0 - out.detached);
}

/// How right the map is about what it knows, where another arena at its best pose has 0; 1 is wholly.
double beyond_luck(const MapScore& score) {
  const double most = score.sight_known * (1.0 - score.detached);
  return most > 0.0 ? score.score_at_best_pose / most : 0.0;
}

/// Pixels wider than the truth's walls may have dropped whole ones: said, since nothing in the picture tells.
std::string note_of_coarse_pixels(const OccupancyGrid& map, const OccupancyGrid& truth) {
  constexpr double kWider = 1.15;
  const double thickness = 2.0 * wall_half_thickness(truth);
  if (map.resolution() <= kWider * thickness) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "the map's pixels (%.3g m) are wider than the truth's walls (%.3g m): made smaller by nearest "
                "neighbour, a map loses whole walls",
                map.resolution(), thickness);
  return text;
}

/// The true walls are there, and so are others that cut lines of sight: who drew them may not see walls in them.
std::string note_of_crossed_floor(const MapScore& score) {
  constexpr double kPoor = 0.8, kThere = 0.95, kClean = 0.9;
  constexpr double kVeryPoor = 0.2, kMostThere = 0.8, kHalfClean = 0.8;
  const bool many = score.score < kVeryPoor && score.recall >= kMostThere && score.precision < kHalfClean;
  const bool some = score.score < kPoor && score.recall >= kThere && score.precision < kClean;
  if (!many && !some) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%.0f m of what it draws as walls cross free floor, beside the true ones; a robot's way, text, arrows or "
      "grid lines drawn as dark as walls count as walls",
      score.errors.phantom_m);
  return text;
}

/// Lines of sight end where the truth does: no line crosses the walls around it.
std::string note_of_unasked_walls(const MapScore& score) {
  constexpr double kGood = 0.9, kThere = 0.85;
  constexpr double kVeryGood = 0.97, kMuch = 4.0;  // of maps that are right where they are asked [m]
  constexpr double kSome = 0.5;                    // less is no wall [m]
  const double gaps_m = score.errors.gaps_m;
  const bool much = score.score >= kVeryGood && gaps_m >= kMuch;
  const bool some = score.score >= kGood && score.recall < kThere && gaps_m >= kSome;
  if (!much && !some) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%.0f m of wall is missing, and the score hardly says so: no line of sight crosses what stands around the "
      "arena; overlap and recall count it",
      gaps_m);
  return text;
}

/// A legend on white is explored ground apart from the arena.
std::string note_of_what_is_apart(double share) {
  constexpr double kNothing = 0.005;
  if (share < kNothing) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "%.0f %% of what the map knows is drawn apart from the arena (a second drawing, or a legend on the "
                "colour of explored ground?), which takes as much off the score",
                100.0 * share);
  return text;
}

/// How many times as large the map would have to be to have a good score: near the pose it has, else where it lies best
/// at the sizes that its extent tells. Walls that meet to the decimetre are of the right size.
std::optional<double> scale_of_walls(const MapScore& score, const OccupancyGrid& map, const OccupancyGrid& truth,
                                     const SightLines& sights, const AlignmentConfig* search) {
  constexpr double kPoor = 0.8;
  if (score.score_at_best_pose >= kPoor) return std::nullopt;
  if (const auto near = better_scale(map, truth, score.T_truth_map, sights, score.score_at_best_pose)) return near;
  if (search == nullptr || score.contest.agreement >= kTightEnough) return std::nullopt;
  AlignmentConfig by_walls = *search;
  by_walls.by = AlignBy::Walls;
  by_walls.start.reset();
  for (const double size : sizes_by_extent(map, truth)) {
    const Alignment there = align(at_size(map, size), truth, by_walls);
    if (there.by == AlignBy::Auto) continue;
    if (const auto scale = better_scale(map, truth, there.T_truth_map, sights, score.score_at_best_pose, size))
      return scale;
  }
  return std::nullopt;
}

/// The score stays that of the size that was given. `search`: how to look for other poses; null: not at all.
std::string note_of_scale(const MapScore& score, const OccupancyGrid& map, const OccupancyGrid& truth,
                          const SightLines& sights, const AlignmentConfig* search) {
  const std::optional<double> scale = scale_of_walls(score, map, truth, sights, search);
  if (!scale) return {};
  char text[120];
  std::snprintf(text, sizeof text, "walls fit at %.3g of this size: is the resolution %.3g m?", *scale,
                *scale * map.resolution());
  return text;
}

/// Of a map that is not aligned: whether its size is the reason. Walls that do meet, only at too many poses, are of the
/// right size.
void look_for_other_scale(MapScore& out, const OccupancyGrid& map, const OccupancyGrid& truth,
                          const PoseEvidence& tight, const SightLines& sights, const AlignmentConfig& config) {
  if (tight_agreement(tight) < kTightEnough) out.scale_hint = agreeing_scale(map, truth, config);
  if (out.scale_hint == 0.0) out.scale_hint = scale_of_walls(out, map, truth, sights, &config).value_or(0.0);
  if (out.scale_hint > 0.0)
    out.note = scale_note(out.scale_hint, map.resolution());
  else
    add_note(out.note, note_of_coarse_pixels(map, truth));
}

/// All numbers at the pose that `out` holds.
void measure(MapScore& out, const OccupancyGrid& map, const OccupancyGrid& truth, const Walls& walls,
             const ScoreConfig& config) {
  const Overlap overlap = walls.overlaps.at(PlanarTransform(out.T_truth_map));
  out.precision = overlap.precision;
  out.recall = overlap.recall;
  out.overlap = overlap.score;
  fill_sights(out, truth, walls);
  out.score = out.score_at_best_pose;
  if (!walls.sights.usable())
    add_note(out.note, "the truth has too few walls with free space on both sides; the score is the overlap");
  constexpr double kWhole = 0.98;  // of a map that lacks nothing to speak of
  if (out.recall < kWhole && out.score < kWhole) add_note(out.note, note_of_coarse_pixels(map, truth));
  out.errors = wall_errors(walls.overlaps, PlanarTransform(out.T_truth_map), config.worst_places);
  add_note(out.note,
           note_of_scale(out, map, truth, walls.sights, out.by == AlignBy::Hand ? nullptr : &config.alignment));
  add_note(out.note, note_of_crossed_floor(out));
  add_note(out.note, note_of_unasked_walls(out));
  add_note(out.note, note_of_what_is_apart(out.detached));
  if (config.warp) fill_warp(out, map, truth, walls, config.of_truth);
  const GridFrame frame = common_frame(map, truth, out.T_truth_map, kCanvasMargin);
  const OccupancyGrid map_on_frame = resample(map, out.T_truth_map, frame);
  const OccupancyGrid truth_on_frame = resample(truth, {}, frame);
  fill_psi(out, psi(map_on_frame, truth_on_frame, config.colour_absent_cap));
  out.known = known_share(map_on_frame, truth_on_frame);
}

}  // namespace

std::string reason_of(const std::string& note) {
  const std::string head = "not aligned: ";
  return note.rfind(head, 0) == 0 ? note.substr(head.size()) : note;
}

void add_note(std::string& note, const std::string& more) {
  if (!more.empty()) note += (note.empty() ? "" : "; ") + more;
}

ScoreConfig prepared_for(const OccupancyGrid& truth, ScoreConfig config) {
  if (config.warp && !config.of_truth)
    config.of_truth = std::make_shared<const TruthFeatures>(truth_features(crop_to_known(truth, 0.0)));
  return config;
}

MapScore score_map(const OccupancyGrid& map, const OccupancyGrid& truth, const ScoreConfig& config) {
  MapScore out;
  const OccupancyGrid map_known = crop_to_known(map, 0.0);
  const OccupancyGrid truth_known = crop_to_known(truth, 0.0);
  // What is asked at a pose takes no knowledge of it: prepared on another processor, where there is one.
  const auto when = too_many_walls(map_known, truth_known).empty() ? std::launch::async | std::launch::deferred
                                                                   : std::launch::deferred;
  std::future<std::unique_ptr<const Walls>> prepared =
      std::async(when, [&] { return std::make_unique<const Walls>(map_known, truth_known, config.tau); });
  const Alignment alignment = align(map_known, truth_known, config.alignment);
  out.aligned = alignment.aligned;
  out.note = alignment.note;
  out.T_truth_map = alignment.T_truth_map;
  out.runner_up = alignment.runner_up;
  out.by = alignment.by;
  out.contest = alignment.contest;
  out.mirrored = alignment.mirrored;
  if (!out.aligned) {
    fill_psi(out, psi_of_strangers(config.colour_absent_cap));
    if (alignment.by == AlignBy::Auto) return out;
    const std::unique_ptr<const Walls> walls = prepared.get();
    fill_sights(out, truth_known, *walls);
    if (alignment.near.any() && walls->sights.usable())
      out.note = why_rivalled(alignment.near, beyond_luck(out)) + alignment.aside;
    look_for_other_scale(out, map_known, truth_known, alignment.tight_evidence, walls->sights, config.alignment);
    return out;
  }
  const std::unique_ptr<const Walls> walls = prepared.get();
  if (walls->score(PlanarTransform(alignment.T_walls)) > walls->score(PlanarTransform(out.T_truth_map)))
    out.T_truth_map = alignment.T_walls;
  measure(out, map_known, truth_known, *walls, config);
  return out;
}

MapScore score_at_pose(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                       const ScoreConfig& config) {
  const OccupancyGrid map_known = crop_to_known(map, 0.0);
  const OccupancyGrid truth_known = crop_to_known(truth, 0.0);
  MapScore out;
  out.aligned = true;
  out.by = AlignBy::Hand;
  out.T_truth_map = T_truth_map;
  measure(out, map_known, truth_known, Walls(map_known, truth_known, config.tau), config);
  return out;
}

}  // namespace rubble::scoring
