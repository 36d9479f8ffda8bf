#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

/// What to know before a run that is made all the same: lines for people.

/// Of the arena, one line each: of a .raf file parts left out, and where the robot starts; of another file a start from
/// which this robot gets to little of the floor; of any the victims for which it has no sense. Throws InputError.
std::vector<std::string> arena_notes(const Scenario& scenario);

/// Of settings that have no effect on this robot, one line each.
std::vector<std::string> setting_notes(const Scenario& scenario);

/// Of a run whose robot may turn back before it has begun; nothing where there is time enough.
std::optional<std::string> short_time_note(const Scenario& scenario);

}  // namespace rubble::scenarios
