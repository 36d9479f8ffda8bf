#include "robot/logs/own/model_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "base/bytes.h"
#include "base/text/json_size.h"
#include "robot/model_fields.h"

namespace rubble::robot {
namespace {

using nlohmann::json;

constexpr int kMostLaserBeams = 1'000'000;

// JSON has no infinities: they travel as text.
void put(json& to, double value) {
  if (std::isfinite(value))
    to = value;
  else
    to = std::isnan(value) ? "nan" : (value > 0 ? "inf" : "-inf");
}
void put(json& to, const AccelerometerMount& value) { to = mount_names().at(static_cast<std::size_t>(value)); }
template <class T>
void put(json& to, const T& value) {
  to = value;
}

void take(const json& from, double& value) {
  if (!from.is_string()) {
    value = from.get<double>();
    return;
  }
  const auto text = from.get<std::string>();
  if (text != "nan" && text != "inf" && text != "-inf") throw BadPayload("'" + text + "' is not a number");
  value = text == "nan" ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  if (text == "-inf") value = -value;
}
void take(const json& from, AccelerometerMount& value) {
  const auto text = from.get<std::string>();
  const auto found = std::find(mount_names().begin(), mount_names().end(), text);
  if (found == mount_names().end()) throw BadPayload("'" + text + "' is no place for the accelerometer");
  value = static_cast<AccelerometerMount>(found - mount_names().begin());
}
template <class T>
void take(const json& from, T& value) {
  value = from.get<T>();
}

/// Throws BadPayload for a robot that nobody can have built: what is computed with it would be nonsense told as a map.
void check_model(const RobotModel& model) {
  constexpr double kLargest = 1e4;  // m, kg, s, m/s: beyond any vehicle and any laser
  const auto refuse = [](const ModelKey& key, const std::string& why) {
    throw BadPayload(std::string("the robot model's ") + key.log + " is " + why);
  };
  each_model_field(model, [&](const ModelKey& key, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      const std::string name = key.log;
      const bool is_signed = name.rfind("base_laser_", 0) == 0 || name.rfind("laser_angle_", 0) == 0;
      const bool may_be_endless = name == "command_timeout";
      if (std::isnan(value) || std::abs(value) > (may_be_endless ? HUGE_VAL : kLargest)) refuse(key, "no sensible number");
      if (value < 0.0 && !is_signed) refuse(key, "negative");
    }
  });
  const LaserModel& laser = model.laser;
  if (laser.beams < 1 || laser.beams > kMostLaserBeams)
    throw BadPayload("the robot model's laser has " + std::to_string(laser.beams) + " beams");
  if (laser.beams > 1 && laser.angle_step == 0.0) throw BadPayload("the beams of the robot model's laser have no angle");
  if (laser.range_max <= laser.range_min) throw BadPayload("the robot model's laser reaches no further than it begins");
}

}  // namespace

std::string model_to_json(const RobotModel& model) {
  json object = json::object();
  each_model_field(model, [&](const ModelKey& key, const auto& value) { put(object[key.log], value); });
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

RobotModel model_from_json(const std::string& text) {
  if (!is_modest_json(text)) throw BadPayload("the robot model holds more than a model has");
  RobotModel model;
  try {
    const json object = json::parse(text);
    each_model_field(model, [&](const ModelKey& key, auto& value) {
      if (!key.is_younger || object.contains(key.log)) take(object.at(key.log), value);
    });
  } catch (const json::parse_error&) {
    throw BadPayload("the robot model is no JSON");
  } catch (const json::exception&) {
    throw BadPayload("a value of the robot model is missing or of another kind");
  }
  check_model(model);
  return model;
}

}  // namespace rubble::robot
