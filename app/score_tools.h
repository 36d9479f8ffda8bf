#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "app/commands.h"
#include "base/grid.h"
#include "scoring/pictures/evaluation_page.h"

namespace rubble::app {

/// A pose typed by a person: p_truth = T (scale p_map).
struct GivenPose {
  mrpt::math::TPose2D T_truth_map;
  double scale = 1.0;
};

/// X,Y,DEG[,SCALE]; nothing for an empty text. Throws UsageError for another form or a scale outside 0.1 to 10.
std::optional<GivenPose> parse_pose(const std::string& text);

/// The command that scores the same two maps again.
std::string command_of(const ScoreArguments& a);

/// Creates the folder of --out. Throws InputError when that is not possible.
void make_folder(const std::string& path);

/// Writes the Mapping Evaluation Tool page. Throws RunError.
void write_evaluation_page(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                           const scoring::EvaluationStart& start);

}  // namespace rubble::app
