#include "robot/logs/own/model_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "base/bytes.h"
#include "robot/model.h"

namespace rubble::robot {
namespace {

/// The usual robot with one value changed.
std::string with(const std::string& key, const nlohmann::json& value) {
  auto model = nlohmann::json::parse(model_to_json(RobotModel()));
  EXPECT_TRUE(model.contains(key)) << key;
  model[key] = value;
  return model.dump();
}

TEST(ModelJson, TheUsualRobotIsTaken) {
  const RobotModel model;
  EXPECT_EQ(model_to_json(model_from_json(model_to_json(model))), model_to_json(model));
  EXPECT_NO_THROW(model_from_json(with("command_timeout", "inf")));
  EXPECT_NO_THROW(model_from_json(with("base_laser_x", -0.4)));
  EXPECT_NO_THROW(model_from_json(with("laser_angle_step", -0.006)));
}

TEST(ModelJson, RobotsThatNobodyCanHaveBuiltAreRefusedByTheirValue) {
  const std::vector<std::pair<std::string, nlohmann::json>> wrong = {
      {"laser_beams", 0},       {"laser_beams", -3},    {"laser_beams", 2'000'000}, {"laser_angle_step", 0.0},
      {"laser_range_max", -1},  {"laser_range_max", 0}, {"laser_range_max", "nan"}, {"laser_range_max", "inf"},
      {"max_v", 1e12},          {"width", -0.5},        {"tick", "nan"},            {"base_laser_z", 1e9},
      {"base_laser_yaw", "nan"}};
  for (const auto& [key, value] : wrong) EXPECT_THROW(model_from_json(with(key, value)), BadPayload) << key << ' ' << value;
}

}  // namespace
}  // namespace rubble::robot
