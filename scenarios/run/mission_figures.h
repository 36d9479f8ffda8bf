#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "arenas/model/arena.h"
#include "base/trajectory.h"
#include "explore/explorer.h"
#include "robot/model.h"
#include "scenarios/run/core.h"

namespace rubble::scenarios {

/// What the truth says about a drive. All of it follows from the arena and the true poses; the core knows nothing of
/// it.
struct DriveFigures {
  double way_m = 0.0;            ///< driven in the plan view
  double contact_s = 0.0;        ///< time within 12 mm of a solid or of a step too high to climb
  int contacts = 0;              ///< spells of it
  double contact_speed = 0.0;    ///< the fastest at which one began [m/s]
  double min_clearance_m = 0.0;  ///< of the outline, to the nearest such thing (0.5 m when never nearer)
  double home_m = 0.0;           ///< from the start at the end
};

/// `truth`: poses of the base in the arena frame, in order.
DriveFigures drive_figures(const arenas::Arena& arena, const Trajectory& truth, const robot::RobotModel& model);

/// How many victims could be looked at by a camera from where the robot's middle can get.
int visible_victims(const arenas::Arena& arena, const robot::RobotModel& model);

/// Adds the mission's figures to score.json: end_code, contact_s, contacts, contact_speed, min_clearance_m, stalls,
/// way_m, home_m, area_per_min, victims_visible.
void add_mission_figures(nlohmann::ordered_json& json, const arenas::Arena& arena, const Trajectory& truth,
                         const robot::RobotModel& model, const Core& core);

/// Why the explorer did what it did: one line each, `seconds reason`.
std::string decisions_text(const Core& core);

}  // namespace rubble::scenarios
