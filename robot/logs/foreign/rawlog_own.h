#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "robot/logs/own/model_json.h"

namespace rubble::robot {

/// Opens the comment entry by which our own rawlogs carry the robot model.
constexpr std::string_view kModelComment = "rubble robot model: ";

/// Stands for a turn rate of zero while driving: MRPT 2.5's pose extrapolation divides by the turn rate, so that its
/// icp-slam ends in NaN on a robot that drives straight. [rad/s]
constexpr double kStraightTurnRate = 1e-12;

inline std::string comment_of_model(const RobotModel& model) {
  return std::string(kModelComment) + model_to_json(model);
}

/// Nothing when the comment is somebody else's. Throws BadPayload.
inline std::optional<RobotModel> model_of_comment(const std::string& text) {
  if (std::string_view(text).substr(0, kModelComment.size()) != kModelComment) return std::nullopt;
  return model_from_json(text.substr(kModelComment.size()));
}

}  // namespace rubble::robot
