#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/score_tools.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "scoring/trajectory/relative_error.h"
#include "scoring/trajectory/trajectory_error.h"

namespace rubble::app {
namespace {

using nlohmann::ordered_json;

constexpr double kPiece = 1.0;  // of path that RPE compares [m]

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void add_relations(ordered_json& json, const scoring::RelationError& error) {
  json["relations"] = error.relations;
  json["relations_missing"] = error.missing;
  json["relation_m"] = error.mean_m;
  json["relation_std_m"] = error.std_m;
  json["relation_m2"] = error.mean_m2;
  json["relation_deg"] = rad_to_deg(error.mean_rad);
  json["relation_std_deg"] = rad_to_deg(error.std_rad);
}

ordered_json compare(const Trajectory& estimate, const Trajectory& truth, const ScoreArguments& arguments) {
  const scoring::TrajectoryError ate = scoring::trajectory_error(estimate, truth);
  if (ate.matched < 2)
    throw InputError(arguments.map + ": shares less than two moments with " + arguments.truth +
                     "; are both stamped with the same clock?");
  const scoring::RelativeError frames = scoring::rpe_frames(estimate, truth);
  const scoring::RelativeError pieces = scoring::rpe_path(estimate, truth, kPiece);
  ordered_json json = {
      {"poses", ate.matched},         {"ate_aligned_m", ate.ate_aligned_m},           {"ate_first_m", ate.ate_first_m},
      {"rpe_frame_m", frames.rmse_m}, {"rpe_frame_deg", rad_to_deg(frames.rmse_rad)}, {"rpe_1m_pairs", pieces.pairs},
      {"rpe_1m_m", pieces.rmse_m},    {"rpe_1m_deg", rad_to_deg(pieces.rmse_rad)}};
  add_relations(json, scoring::relation_error(estimate, scoring::relations_of(truth)));
  return json;
}

}  // namespace

bool is_trajectory(const std::string& path) { return ends_with(path, ".tum"); }

int score_trajectory(const ScoreArguments& arguments) {
  if (!arguments.pose.empty() || !arguments.html.empty())
    throw UsageError("trajectories are scored without --pose and --html; see rubble score --help");
  const Trajectory estimate = read_tum(arguments.map);
  ordered_json json;
  if (ends_with(arguments.truth, ".relations"))
    add_relations(json, scoring::relation_error(estimate, scoring::read_relations(arguments.truth)));
  else if (is_trajectory(arguments.truth))
    json = compare(estimate, read_tum(arguments.truth), arguments);
  else
    throw UsageError(arguments.truth + ": a trajectory is compared with a .tum or a .relations file");
  if (!arguments.out.empty()) {
    make_folder(arguments.out);
    write_text_file(arguments.out + "/trajectory.json", json.dump(2) + "\n");
  }
  if (arguments.json) {
    std::printf("%s\n", json.dump(2).c_str());
    return kOk;
  }
  for (const auto& [key, value] : json.items())
    value.is_number_float() ? std::printf("%-20s %.4f\n", key.c_str(), value.get<double>())
                            : std::printf("%-20s %s\n", key.c_str(), value.dump().c_str());
  return kOk;
}

}  // namespace rubble::app
