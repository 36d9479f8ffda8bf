#include "scenarios/config/notes.h"

#include "arenas/files/arena_file.h"
#include "arenas/raf/raf.h"
#include "arenas/truth/start_region.h"
#include "base/text/number_text.h"
#include "scenarios/config/viewer.h"

namespace rubble::scenarios {

std::vector<std::string> arena_notes(const Scenario& scenario) {
  if (scenario.arena_file.empty()) return {};
  std::vector<std::string> notes;
  if (arenas::is_raf(scenario.arena_file)) {
    notes = arenas::import_raf(scenario.arena_file).notes();
  } else {
    const arenas::Arena arena = arenas::load_arena(scenario.arena_file);
    if (const auto note = arenas::small_start(arena, viewer_of(scenario.robot))) notes.push_back(*note);
  }
  for (std::string& note : notes) note = scenario.arena_file + ": " + note;
  return notes;
}

std::optional<std::string> short_time_note(const Scenario& scenario) {
  const double for_home = scenario.explorer.make(scenario.robot, {scenario.time_limit})->time_for_home();
  if (scenario.time_limit <= 0.0 || scenario.time_limit > for_home) return std::nullopt;
  const auto seconds = [](double s) { return number_text(s) + " s"; };
  return "time limit: all of the " + seconds(scenario.time_limit) + " are kept for the way home (" + seconds(for_home) +
         " and the way itself), so little will be explored; better give at least " + seconds(2.0 * for_home) +
         ", or --set explorer.return_home=false";
}

}  // namespace rubble::scenarios
