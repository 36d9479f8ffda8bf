#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "app/command.h"
#include "base/grid.h"
#include "scoring/maps/normalise.h"
#include "scoring/pictures/evaluation_page.h"

namespace rubble::app {

struct ScoreArguments {
  std::string map;
  std::string truth;
  std::optional<double> map_resolution;
  std::optional<double> truth_resolution;
  std::string align = "auto";
  bool warp = false;
  double tau = 0.5;
  std::string out;
  bool force = false;  ///< the pictures and score.json of a run may be replaced
  bool json = false;
  std::optional<double> fail_under;  ///< exit code 1 for a lower score, or a map that is not aligned
  std::string pose;                  ///< X,Y,DEG[,SCALE]: score there instead of aligning
  std::string start;                 ///< X,Y,DEG in the truth of where the robot started
  std::string html;                  ///< the evaluation page to write
  std::string league;                ///< folder of maps to rank; `map` is the truth then
  std::string judge;                 ///< CSV of the judge's points
  std::string pois;                  ///< list of the victims that the map reports; empty: those drawn on it
  std::string victims;               ///< list of the true victims
};

// The other kinds of scoring that the command leads to, each in the file of its name.
int score_league(const ScoreArguments& arguments);
bool is_trajectory(const std::string& path);
int score_trajectory(const ScoreArguments& arguments);

/// `path`; of a run folder the map in it that has this name. Throws InputError for another folder.
std::string map_file(const std::string& path, const std::string& name = "map.tif");

/// A pose typed by a person: p_truth = T (scale p_map).
struct GivenPose {
  mrpt::math::TPose2D T_truth_map;
  double scale = 1.0;
};

/// X,Y,DEG[,SCALE]; nothing for an empty text. Throws UsageError for another form or a scale outside 0.1 to 10.
std::optional<GivenPose> parse_pose(const std::string& text);

/// What --start X,Y,DEG says about a map: it must count from where its robot started. Throws UsageError, InputError.
std::optional<scoring::KnownStart> parse_start(const std::string& text, const std::string& path,
                                               const scoring::LoadedMap& map);

/// The command that scores the same two maps again.
std::string command_of(const ScoreArguments& a);

/// Creates the folder of --out. Throws InputError when that is not possible.
void make_folder(const std::string& path);

/// The same for files that a run's folder has too, with more in them. Throws InputError for such a folder, but with
/// `force`.
void make_score_folder(const std::string& path, bool force);

/// Writes the Mapping Evaluation Tool page. Throws RunError.
void write_evaluation_page(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                           const scoring::EvaluationStart& start);

}  // namespace rubble::app
