#include <nlohmann/json.hpp>

#include "app/maps/score_tools.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "scenarios/run/score_json.h"
#include "scoring/figures/figures.h"
#include "scoring/trajectory/relative_error.h"
#include "scoring/trajectory/trajectory_error.h"

namespace rubble::app {
namespace {

constexpr double kPiece = 1.0;  // of path that RPE compares [m]

scoring::Evidence compared(const Trajectory& estimate, const Trajectory& truth, const ScoreArguments& arguments) {
  scoring::Evidence evidence;
  evidence.error = scoring::trajectory_error(estimate, truth);
  if (evidence.error->matched < 2)
    throw InputError(arguments.map + ": shares less than two moments with " + arguments.truth +
                     "; are both stamped with the same clock?");
  evidence.pieces = {scoring::rpe_frames(estimate, truth), scoring::rpe_path(estimate, truth, kPiece)};
  evidence.relations = scoring::relation_error(estimate, scoring::relations_of(truth));
  return evidence;
}

}  // namespace

bool is_trajectory(const std::string& path) { return ends_with(path, ".tum"); }

int score_trajectory(const ScoreArguments& arguments) {
  if (!arguments.pose.empty() || !arguments.html.empty() || arguments.force || arguments.fail_under)
    throw UsageError(
        "trajectories are scored without --pose, --html, --force and --fail-under; see rubble score --help");
  const Trajectory estimate = read_tum(arguments.map);
  scoring::Evidence evidence;
  if (ends_with(arguments.truth, ".relations")) {
    evidence.relations = scoring::relation_error(estimate, scoring::read_relations(arguments.truth));
    if (evidence.relations->relations == 0)
      throw InputError(arguments.truth + ": none of its relations lies in the time of " + arguments.map +
                       "; give those of the same log");
  } else if (is_trajectory(arguments.truth)) {
    evidence = compared(estimate, read_tum(arguments.truth), arguments);
  } else {
    throw UsageError(arguments.truth + ": a trajectory is compared with a .tum or a .relations file");
  }
  const nlohmann::ordered_json json = scenarios::known_figures(evidence);
  if (!arguments.out.empty()) {
    make_folder(arguments.out);
    write_text_file(place_in(arguments.out, "trajectory.json"), json.dump(2) + "\n");
  }
  if (arguments.json) {
    print_json(json);
    return kOk;
  }
  for (const scoring::Figure& figure : scoring::figures())
    if (const std::string text = scoring::text_of(figure, figure.get(evidence)); !text.empty())
      print_figure(figure, text, true);
  return kOk;
}

}  // namespace rubble::app
