#include "scenarios/config/notes.h"

#include "arenas/files/arena_file.h"
#include "arenas/raf/raf.h"
#include "arenas/truth/start_region.h"
#include "base/text/number_text.h"
#include "base/text/words.h"
#include "scenarios/config/viewer.h"

namespace rubble::scenarios {

namespace {

/// Victims that are heard or smelt only, by a robot without such a sense; nothing where there are none.
std::optional<std::string> senseless_note(const arenas::Arena& arena, const sim::SimConfig& sim) {
  std::vector<std::string> names;
  bool sound = false;
  bool co2 = false;
  for (const arenas::Victim& victim : arena.victims) {
    const bool found =
        victim.appearance || victim.heat || (victim.sound && sim.microphones) || (victim.co2 && sim.co2_probe);
    if (found || (!victim.sound && !victim.co2)) continue;
    names.push_back(victim.name);
    sound = sound || victim.sound;
    co2 = co2 || victim.co2;
  }
  if (names.empty()) return std::nullopt;
  std::vector<std::string> cues, keys;
  if (sound) cues.push_back("heard"), keys.push_back("sim.microphones=true");
  if (co2) cues.push_back("smelt"), keys.push_back("sim.co2_probe=true");
  return "the robot cannot find " + joined(names) + ", to be " + (cues.size() == 2 ? "heard or smelt" : cues.front()) +
         " only: it lacks the sense; give it " + joined(keys);
}

}  // namespace

std::vector<std::string> arena_notes(const Scenario& scenario) {
  std::vector<std::string> notes;
  const auto add = [&](const std::optional<std::string>& note) {
    if (note) notes.push_back(*note);
  };
  if (scenario.arena_file.empty()) {
    add(senseless_note(arenas::parse_arena(arena_yaml(scenario), "generated arena"), scenario.sim));
    return notes;
  }
  if (arenas::is_raf(scenario.arena_file)) {
    const arenas::RafImport import = arenas::import_raf(scenario.arena_file);
    notes = import.notes();
    add(senseless_note(import.arena, scenario.sim));
  } else {
    const arenas::Arena arena = arenas::load_arena(scenario.arena_file);
    add(arenas::small_start(arena, viewer_of(scenario.robot)));
    add(senseless_note(arena, scenario.sim));
  }
  for (std::string& note : notes) note = scenario.arena_file + ": " + note;
  return notes;
}

std::vector<std::string> setting_notes(const Scenario& scenario) {
  return scenario.explorer.notes(scenario.robot,
                                 {scenario.time_limit, {scenario.sim.microphones, scenario.sim.co2_probe}});
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
