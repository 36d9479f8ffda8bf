#include "scenarios/hardware/robot_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/file_name.h"
#include "base/yaml/binder.h"
#include "base/yaml/strict_yaml.h"
#include "robot/drivers/port.h"

namespace rubble::scenarios {
namespace {

void bind(Binder& b, robot::AxisCalibration& axis) {
  b.number("zero_duty", axis.zero, 0.05, 0.95);
  b.number("duty_per_g", axis.sensitivity, 0.01, 0.5);
}

void bind(Binder& b, robot::ServoCalibration& servo) {
  b.number("centre_us", servo.centre_us, 500.0, 2500.0);
  b.degrees("deg_per_us", servo.radians_per_us, -1.0, 1.0);
}

void bind_lidar(Binder& b, LidarSettings& lidar, robot::RobotModel& model) {
  b.choice("driver", lidar.driver, {"scip", "mrpt"});
  b.text("class", lidar.mrpt_class);
  b.text("port", lidar.port);
  b.degrees("yaw_deg", model.T_base_laser.yaw, -180.0, 180.0);
  b.boolean("upside_down", lidar.upside_down);
  b.number("delay_s", lidar.delay, -1.0, 1.0);
  b.boolean("no_echo_is_miss", lidar.no_echo_is_miss);
  if (lidar.parameters.empty()) return;
  b.section("parameters", [&](Binder& in) {
    for (auto& [key, value] : lidar.parameters) in.text(key.c_str(), value);
  });
}

void bind_base(Binder& b, robot::RealRobotSettings& r) {
  std::vector<std::string> names;
  for (const robot::BaseKind& kind : robot::base_kinds()) names.push_back(kind.name);
  b.choice("driver", r.base_driver, names);
  b.text("port", r.base_port);
  b.number("distance_scale", r.base.distance_scale, 0.5, 2.0);
  b.number("turn_scale", r.base.turn_scale, 0.3, 3.0);
  b.number("delay_s", r.base.delay, -0.5, 0.5);
}

void bind_levelling(Binder& b, robot::RealRobotSettings& r) {
  std::string driver = r.model.has_levelling_unit ? kLevellingUnit : kNoLevelling;
  b.choice("driver", driver, {kLevellingUnit, kNoLevelling});
  r.model.has_levelling_unit = driver != kNoLevelling;
  b.text("port", r.levelling_port);
  b.section("x", [&](Binder& in) { bind(in, r.levelling.x); });
  b.section("y", [&](Binder& in) { bind(in, r.levelling.y); });
  b.section("pitch", [&](Binder& in) { bind(in, r.levelling.pitch); });
  b.section("roll", [&](Binder& in) { bind(in, r.levelling.roll); });
  b.number("delay_s", r.levelling.delay, -0.5, 0.5);
}

void bind(Binder& b, robot::SafetySettings& s) {
  b.number("lidar_silence_s", s.lidar_silence, 0.1, 10.0);
  b.number("lidar_age_s", s.lidar_age, 0.2, 10.0);
  b.number("base_silence_s", s.base_silence, 0.2, 10.0);
  b.number("base_answer_s", s.base_answer, 0.05, 10.0);
  b.number("levelling_answer_s", s.levelling_answer, 0.05, 10.0);
  b.number("levelling_silence_s", s.levelling_silence, 0.1, 10.0);
  b.number("core_silence_s", s.core_silence, 0.1, 10.0);
  b.number("operator_silence_s", s.operator_silence, 0.1, 60.0);
  b.number("start_s", s.start, 1.0, 3600.0);
  b.number("give_up_s", s.give_up, 1.0, 3600.0);
  b.boolean("mount_check", s.mount_check);
  b.boolean("sees_nothing_holds", s.scans.nothing_holds);
  b.number("sees_nothing_m", s.scans.nothing_way, 0.0, 1000.0);
  b.number("battery_low_v", s.battery_low, 0.0, 100.0);
  b.number("battery_empty_v", s.battery_empty, 0.0, s.battery_low);
}

void bind_devices(Binder& b, RobotFile& file) {
  b.section("devices", [&](Binder& devices) {
    devices.section("urg", [&](Binder& in) { bind_lidar(in, file.lidar, file.robot.model); });
    devices.section("base", [&](Binder& in) { bind_base(in, file.robot); });
    devices.section("levelling", [&](Binder& in) { bind_levelling(in, file.robot); });
  });
  b.section("safety", [&](Binder& in) { bind(in, file.robot.safety); });
}

/// A word that YAML takes for something else (`tcp:127.0.0.1:` is a map to it) is text to `--set`.
std::string as_text(const std::string& key, const std::string& value) {
  const bool port = key == "devices.urg.port" || key == "devices.base.port" || key == "devices.levelling.port";
  if (!port || value.empty() || value.back() != ':') return value;
  return yaml_quoted(value);
}

/// Whether two words lead to one device: by the file where there is one, for it may have several names.
bool is_same_port(const std::string& a, const std::string& b) {
  if (a == b) return true;
  std::error_code error_a, error_b;
  const auto path_a = std::filesystem::canonical(a, error_a), path_b = std::filesystem::canonical(b, error_b);
  return !error_a && !error_b && path_a == path_b;
}

/// The ports that are opened, before anything is.
void check_ports(const YamlMap& devices, const RobotFile& file) {
  std::vector<std::pair<const char*, std::string>> seen;
  const auto check = [&](const char* device, const std::string& word) {
    try {
      robot::check_port_word(word);
    } catch (const InputError& error) {
      devices.map(device).fail("port", error.what());
    }
    for (const auto& [other, taken] : seen)
      if (is_same_port(word, taken))
        devices.map(device).fail("port", std::string("devices.") + other + " and devices." + device +
                                             " have the same port '" + word + "'; each device needs its own");
    seen.emplace_back(device, word);
  };
  check("urg", file.lidar.port);
  if (file.robot.base_driver != robot::kNoBase) check("base", file.robot.base_port);
  if (file.robot.model.has_levelling_unit) check("levelling", file.robot.levelling_port);
}

/// The limits of the model are those that the driver enforces.
void settle(RobotFile& file, const robot::RobotModel& devices) {
  robot::RobotModel& model = file.settings.robot;
  model.T_base_laser.yaw = devices.T_base_laser.yaw;
  model.has_levelling_unit = devices.has_levelling_unit;
  file.settings.has_arena = false;
  // No driver tells of victims: floor that nothing can hear or smell is not to be searched so.
  file.settings.sim.microphones = file.settings.sim.co2_probe = false;
  file.settings.levelling.on = file.settings.levelling.on && model.has_levelling_unit;
  robot::RealRobotSettings& robot = file.robot;
  robot.model = model;
  if (!model.has_levelling_unit) robot.levelling_port.clear();
  if (robot.base_driver == robot::kNoBase) robot.base_port.clear();
  robot.base.max_v = model.max_v;
  robot.base.max_w = model.max_w;
  robot.base.max_accel = model.max_accel;
  robot.base.max_turn_accel = model.max_turn_accel;
  robot.base.track = model.effective_track;
  robot.time_limit = file.settings.time_limit;
  // A driver that gives up its connection sooner would make a silence that is permitted one that holds the robot.
  robot.base.silence = std::max(robot.base.silence, robot.safety.base_silence);
  robot.levelling.silence = std::max(robot.levelling.silence, robot.safety.levelling_silence);
}

}  // namespace

void as_mounted(const LidarSettings& lidar, robot::LaserScan& scan) {
  scan.stamp = scan.stamp - lidar.delay;
  if (lidar.upside_down) robot::turn_over(scan);
}

RobotFile load_robot_file(const std::string& path, const std::vector<Override>& overrides) {
  YamlMap root = YamlMap::load(path);
  for (const Override& o : overrides) root.set(o.key, as_text(o.key, o.value), o.place);
  RobotFile file;
  file.lidar.port = "/dev/ttyACM0";
  file.robot.base_port = "/dev/ttyUSB0";
  file.robot.levelling_port = "/dev/ttyUSB1";
  file.settings.name = root.text("name", as_file_name(std::filesystem::path(path).stem().string()));
  if (const auto trouble = file_name_trouble(file.settings.name)) root.fail("name", *trouble);
  const YamlMap urg = root.map("devices").map("urg");
  for (const std::string& key : urg.map("parameters").keys()) file.lidar.parameters.emplace_back(key, "");
  // MRPT's drivers lose the codes: what they call invalid may be a black wall close by as well as nothing at all.
  if (urg.text("driver", "scip") == "mrpt") file.lidar.no_echo_is_miss = false;
  YamlReader reader(root);
  bind_devices(reader, file);
  check_ports(root.map("devices"), file);
  if (!file.lidar.parameters.empty() && file.lidar.driver != LidarDriver::Mrpt)
    urg.fail("parameters", "are passed to MRPT's drivers; `driver: mrpt` is missing");
  read_settings(root, file.settings);
  root.finish();
  settle(file, robot::RobotModel(file.robot.model));
  return file;
}

std::string robot_file_yaml(const RobotFile& file) {
  RobotFile copy = file;  // binding needs a mutable object
  YamlWriter devices;
  bind_devices(devices, copy);
  return devices.yaml() + resolved_yaml(file.settings);
}

}  // namespace rubble::scenarios
