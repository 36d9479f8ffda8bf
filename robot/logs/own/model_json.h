#pragma once

#include <string>

#include "robot/model.h"

namespace rubble::robot {

/// The robot model as one JSON object; every number comes back bit-exact, infinities included.
std::string model_to_json(const RobotModel& model);

/// Throws BadPayload: not JSON, a key missing or of another type. Unknown keys are left alone.
RobotModel model_from_json(const std::string& text);

}  // namespace rubble::robot
