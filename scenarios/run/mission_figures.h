#pragma once

#include <string>

#include "arenas/model/arena.h"
#include "base/trajectory.h"
#include "explore/explorer.h"
#include "robot/model.h"
#include "scenarios/run/core.h"
#include "scoring/figures/evidence.h"

namespace rubble::scenarios {

/// `truth`: poses of the base in the arena frame, in order.
scoring::DriveFigures drive_figures(const arenas::Arena& arena, const Trajectory& truth,
                                    const robot::RobotModel& model);

/// How many victims could be looked at by a camera from where the robot's middle can get.
int visible_victims(const arenas::Arena& arena, const robot::RobotModel& model);

/// How the mission went: what the truth and the explorer say.
scoring::MissionFigures mission_figures(const arenas::Arena& arena, const Trajectory& truth,
                                        const robot::RobotModel& model, const Core& core);

/// Why the explorer did what it did: one line each, `seconds reason`.
std::string decisions_text(const Core& core);

}  // namespace rubble::scenarios
