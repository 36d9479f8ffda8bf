#pragma once

#include "arenas/truth/visible.h"
#include "robot/model.h"

namespace rubble::scenarios {

/// What decides where that robot gets and how far it sees.
arenas::Viewer viewer_of(const robot::RobotModel& model);

}  // namespace rubble::scenarios
