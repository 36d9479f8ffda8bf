#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "scoring/marks.h"
#include "scoring/scorecard.h"

namespace rubble::scoring {

/// What the command that scores two maps was given.
struct ScoreCommand {
  std::string map;
  std::string truth;
  std::optional<double> map_resolution;  ///< [m a pixel]
  std::optional<double> truth_resolution;
  double tau = ScoreConfig().tau;  ///< [m]
  std::string pois;                ///< list of the victims that the map reports; empty: none was given
  std::string victims;             ///< list of the true victims; empty: none was given
};

/// The command, quoted as a shell needs it.
std::string words_of(const ScoreCommand& command);

/// What the page starts with.
struct EvaluationStart {
  std::string map_name;  ///< as a person would type them
  std::string truth_name;
  std::string command;  ///< what scores the two at a pose when ` --pose=...` is added
  mrpt::math::TPose2D T_truth_map;
  double scale = 1.0;  ///< of the map: p_truth = T (scale p_map)
  ScoreConfig config;
  std::string not_trusted;      ///< why the pose is not to be trusted; empty: it is
  std::vector<Marks> marks;     ///< that can be shown: victims, features, rooms
  double score = 0.0;           ///< at the pose, trusted or not; of a map that is not trusted the headline is 0
  AlignBy by = AlignBy::Walls;  ///< what proposed the pose; Hand: it was given; Auto: there is none
  /// Where the map came apart, in the truth [m].
  std::optional<std::pair<mrpt::math::TPoint2D, mrpt::math::TPoint2D>> seam{};
};

/// The Mapping Evaluation Tool of section IV.B as one HTML page that needs nothing else: two maps that a person moves,
/// turns, scales and blends, and the figures of `score_at` for the pose, live. `map` in its own scale.
std::string evaluation_page(const OccupancyGrid& map, const OccupancyGrid& truth, const EvaluationStart& start);

}  // namespace rubble::scoring
