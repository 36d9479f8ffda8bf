#include "robot/logs/own/model_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/bytes.h"
#include "base/text/json_size.h"
#include "robot/model_fields.h"

namespace rubble::robot {
namespace {

using nlohmann::json;

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
  return model;
}

}  // namespace rubble::robot
