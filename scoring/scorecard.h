#pragma once

#include <mrpt/math/TPose2D.h>

#include <memory>
#include <string>

#include "base/grid.h"
#include "scoring/alignment/alignment.h"
#include "scoring/alignment/feature_verdict.h"
#include "scoring/alignment/match_error.h"
#include "scoring/walls/break_fit.h"
#include "scoring/walls/wall_errors.h"

namespace rubble::scoring {

struct TruthFeatures;

struct ScoreConfig {
  double tau = 0.5;                ///< distance at which a wall cell counts nothing [m]
  double colour_absent_cap = 5.0;  ///< psi of a class that only one map has [m]
  AlignmentConfig alignment;
  bool warp = false;  ///< also fit eq. (8) and the feature error of eq. (7)
  /// What `warp` asks of the truth, where many maps are scored against one (prepared_for()); null: it is found.
  std::shared_ptr<const TruthFeatures> of_truth;
  std::size_t worst_places = 10;  ///< listed at the most
};

/// Counts up whenever the same map and truth come to another `score`: scores of different versions cannot be compared.
/// What each version changed stands in docs/scoring.md.
constexpr int kScoreVersion = 10;

/// The verdict on one map. Lengths in metres, shares 0..1.
struct MapScore {
  bool aligned = false;             ///< a rigid transform was found that can be trusted
  std::string note;                 ///< why not aligned, or what to know; one line
  mrpt::math::TPose2D T_truth_map;  ///< the transform found
  double runner_up = 0.0;           ///< how near the best different pose comes to the best, 0..1 (1: ambiguous)
  double score = 0.0;               ///< what the lines of sight say, 0 if not aligned: measures/sight_lines.h
  double score_at_best_pose = 0.0;  ///< the same at `T_truth_map`, also where that pose is not to be trusted
  double sight_known = 0.0;         ///< share of the truth's lines of sight that the map knows, at that pose
  double sight_kappa = 0.0;         ///< how right it is about those, at that pose: 1 wholly, 0 like a guess
  double detached = 0.0;       ///< share of the map that is drawn apart from what lies on the truth; it costs score
  double overlap = 0.0;        ///< min(precision, recall)
  double precision = 0.0;      ///< share of map walls near true walls
  double recall = 0.0;         ///< share of true walls near map walls
  double psi_m = 0.0;          ///< mean over {occupied, free} and both directions of eq. (6) [m]
  double psi_literal_m = 0.0;  ///< the literal sum of eq. (5) over all classes [m]
  double psi_occupied_map_m = 0.0;    ///< eq. (6), map -> truth, walls [m]
  double psi_occupied_truth_m = 0.0;  ///< eq. (6), truth -> map, walls [m]
  double psi_free_map_m = 0.0;
  double psi_free_truth_m = 0.0;
  double known = 0.0;            ///< share of the truth's free and occupied area that the map knows
  AlignBy by = AlignBy::Auto;    ///< what proposed the pose; Auto: nothing did
  Contest contest;               ///< by how much the pose found is ahead, and of which
  double mirrored = 0.0;         ///< how near the mirrored map comes to the best pose, 0..1; 0 where there was no pose
  double scale_hint = 0.0;       ///< not aligned, but the maps agree when this is the map's scale; 0: no such scale
  WallErrors errors;             ///< phantom and missing wall and the worst places
  bool warped = false;           ///< the fields below are filled in
  double warped_score = 0.0;     ///< `score` after the displacement of eq. (8); not below `score`
  double warp_m = 0.0;           ///< ||b|| of eq. (8) [m]
  double penalised_score = 0.0;  ///< warped score less the penalty; between `score` and `warped_score`
  MatchError features;           ///< E of eq. (7) over all SURF features of both maps
  FeatureVerdict by_features;    ///< the same over every kind of feature, against what strangers reach
  double feature_warp_m = 0.0;   ///< ||b|| of eq. (8) fitted to the pairs of features [m]
  double feature_warped_score = 0.0;  ///< `score` after that
  MapBreak broken;                    ///< two rigid parts, if that explains more than a bend
  double mended_score = 0.0;          ///< `score` with both parts where they belong; `score` where none is broken off
};

/// The reason alone of a note that says why a map is not aligned.
std::string reason_of(const std::string& note);

/// Adds to a note; its parts stand behind each other. Nothing to add: nothing changes.
void add_note(std::string& note, const std::string& more);

/// `config` for many maps of this one truth: what they have in common is found once.
ScoreConfig prepared_for(const OccupancyGrid& truth, ScoreConfig config);

/// Aligns `map` to `truth` without any initial guess and scores it. Never throws on poor maps: see `aligned`, `note`.
MapScore score_map(const OccupancyGrid& map, const OccupancyGrid& truth, const ScoreConfig& config = {});

/// The same at a pose that is given, not searched.
MapScore score_at_pose(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                       const ScoreConfig& config = {});

}  // namespace rubble::scoring
