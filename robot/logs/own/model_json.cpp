#include "robot/logs/own/model_json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "robot/logs/own/bytes.h"

namespace rubble::robot {
namespace {

using nlohmann::json;

// One list of fields serves both directions, so that they cannot disagree.
template <class Model, class Field>
void each_field(Model& m, Field&& field) {
  field("name", m.name);
  field("length", m.length);
  field("width", m.width);
  field("wheel_radius", m.wheel_radius);
  field("wheelbase", m.wheelbase);
  field("track", m.track);
  field("effective_track", m.effective_track);
  field("ground_clearance", m.ground_clearance);
  field("climbable_step", m.climbable_step);
  field("mass", m.mass);
  field("max_v", m.max_v);
  field("max_w", m.max_w);
  field("max_accel", m.max_accel);
  field("max_turn_accel", m.max_turn_accel);
  field("command_timeout", m.command_timeout);
  field("odometry_period", m.odometry_period);
  field("acceleration_period", m.acceleration_period);
  field("tick", m.tick);
  field("has_levelling_unit", m.has_levelling_unit);
  field("max_aim", m.max_aim);
  field("base_laser_x", m.T_base_laser.x);
  field("base_laser_y", m.T_base_laser.y);
  field("base_laser_z", m.T_base_laser.z);
  field("base_laser_yaw", m.T_base_laser.yaw);
  field("base_laser_pitch", m.T_base_laser.pitch);
  field("base_laser_roll", m.T_base_laser.roll);
  field("laser_name", m.laser.name);
  field("laser_beams", m.laser.beams);
  field("laser_angle_step", m.laser.angle_step);
  field("laser_angle_min", m.laser.angle_min);
  field("laser_range_min", m.laser.range_min);
  field("laser_range_max", m.laser.range_max);
  field("laser_scan_period", m.laser.scan_period);
  field("laser_beam_period", m.laser.beam_period);
}

/// Fields that older logs do not have.
template <class Model, class Field>
void each_younger_field(Model& m, Field&& field) {
  field("accelerometer_mount", m.accelerometer_mount);
  field("laser_accuracy_near", m.laser.accuracy_near);
  field("laser_accuracy_near_to", m.laser.accuracy_near_to);
  field("laser_accuracy_far", m.laser.accuracy_far);
  field("laser_accuracy_far_share", m.laser.accuracy_far_share);
}

// JSON has no infinities: they travel as text.
void put(json& to, double value) {
  if (std::isfinite(value))
    to = value;
  else
    to = std::isnan(value) ? "nan" : (value > 0 ? "inf" : "-inf");
}
void put(json& to, const AccelerometerMount& value) {
  to = value == AccelerometerMount::Platform ? "platform" : "body";
}
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
  if (text != "platform" && text != "body") throw BadPayload("'" + text + "' is no place for the accelerometer");
  value = text == "platform" ? AccelerometerMount::Platform : AccelerometerMount::Body;
}
template <class T>
void take(const json& from, T& value) {
  value = from.get<T>();
}

}  // namespace

std::string model_to_json(const RobotModel& model) {
  json object = json::object();
  const auto put_field = [&](const char* key, const auto& value) { put(object[key], value); };
  each_field(model, put_field);
  each_younger_field(model, put_field);
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

RobotModel model_from_json(const std::string& text) {
  RobotModel model;
  try {
    const json object = json::parse(text);
    each_field(model, [&](const char* key, auto& value) { take(object.at(key), value); });
    each_younger_field(model, [&](const char* key, auto& value) {
      if (object.contains(key)) take(object.at(key), value);
    });
  } catch (const json::exception& e) {
    throw BadPayload(std::string("robot model: ") + e.what());
  }
  return model;
}

}  // namespace rubble::robot
