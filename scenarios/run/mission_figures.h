#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>
#include <vector>

#include "arenas/model/arena.h"
#include "arenas/model/patch_index.h"
#include "base/grid.h"
#include "base/trajectory.h"
#include "explore/explorer.h"
#include "robot/model.h"
#include "scenarios/run/core.h"
#include "scenarios/run/first_seen.h"
#include "scoring/figures/evidence.h"

namespace rubble::scenarios {

/// `truth`: poses of the base in the arena frame, in order.
scoring::DriveFigures drive_figures(const arenas::Arena& arena, const Trajectory& truth,
                                    const robot::RobotModel& model);

/// The names of the victims that no camera could look at from where the robot's middle can get; of those that are heard
/// or smelt only, that could not be.
std::vector<std::string> unseen_victims(const arenas::Arena& arena, const robot::RobotModel& model);

/// What of an arena's floor the laser can see from where the robot can get, 0 to 1.
double visible_share(const arenas::Arena& arena, const robot::RobotModel& model);

/// Floor that became known in a minute until 95 % of all free floor of `visible` (arena frame) were, or as much as was
/// in the end after `end` seconds [m^2/min].
double area_per_minute(const FirstSeen& seen, const OccupancyGrid& visible, const mrpt::math::TPose2D& T_map_arena,
                       double end);

/// Whether no floor is below the robot's middle: it drove over the rim.
bool off_the_floor(const arenas::PatchIndex& floor, const mrpt::math::TPose2D& T_arena_base);

/// How a mission ended that ended `home` [m] from the start, by what the explorer said of it: "home" is what it
/// believes, and "lost" it is who believes so more than 1 m away.
std::string true_end(const std::string& said, double home);

/// How the mission went: what the truth and the explorer say. `known_visible`: the visible truth of the arena, where it
/// is known already.
scoring::MissionFigures mission_figures(const arenas::Arena& arena, const Trajectory& truth,
                                        const robot::RobotModel& model, const Core& core,
                                        const OccupancyGrid* known_visible = nullptr);

/// Why the explorer did what it did: one line each, `seconds reason`.
std::string decisions_text(const Core& core);
/// One of these lines.
std::string decision_line(const explore::Decision& decision);

}  // namespace rubble::scenarios
