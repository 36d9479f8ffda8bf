#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "robot/logs/foreign/carmen.h"
#include "robot/logs/foreign/text_fields.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;

constexpr double kNoReturn = 30.0;  // FLASER says no limit; SICK scanners in these logs write 30 m and more for it [m]
constexpr double kFarthestRange = 1000.0;  ///< of any scanner; more is a log in another unit [m]
constexpr std::int64_t kMaxBeams = 100000;
constexpr double kWidestInRadians = 6.3;     ///< a larger field of view is in degrees
constexpr double kCoarsestInRadians = 0.03;  ///< of an angle between beams; a larger one is in degrees

bool is_keyword(std::string_view word) {
  return !word.empty() && std::isupper(static_cast<unsigned char>(word[0])) != 0 &&
         std::all_of(word.begin(), word.end(),
                     [](unsigned char c) { return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_'; });
}

TPose2D take_pose(TextFields& fields, const char* what) {
  TPose2D pose;
  pose.x = fields.number(what);
  pose.y = fields.number(what);
  pose.phi = wrap_angle(fields.number(what));
  return pose;
}

void take_ranges(TextFields& fields, std::int64_t count, LaserScan& scan) {
  scan.ranges.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const double range = fields.number("range");
    if (range < 0.0) fields.fail("a range is negative; correct or delete the line");
    const bool missed = range >= scan.range_max;
    scan.ranges.push_back(missed ? LaserScan::kMiss
                                 : (range > scan.range_min ? static_cast<float>(range) : LaserScan::kUnknown));
  }
}

void take_stamps(TextFields& fields, CarmenRecord& record) {
  record.measured = fields.stamp("ipc_timestamp");
  fields.text("ipc_hostname");
  record.logged = fields.stamp("logger_timestamp");
}

// ODOM x y theta tv rv accel ipc_timestamp ipc_hostname logger_timestamp
void take_odom(TextFields& fields, CarmenRecord& record) {
  record.robot = take_pose(fields, "odometry pose");
  record.v = fields.number("tv");
  record.w = fields.number("rv");
  fields.number("accel");
  take_stamps(fields, record);
}

// The bearings are set when all PARAM lines are read.
// FLASER n r1 .. rn x y theta odom_x odom_y odom_theta ipc_timestamp ipc_hostname logger_timestamp
void take_flaser(TextFields& fields, CarmenRecord& record) {
  record.is_scan = true;
  const std::int64_t count = fields.integer("num_readings", 2, kMaxBeams);
  record.scan.range_max = kNoReturn;
  take_ranges(fields, count, record.scan);
  record.laser = take_pose(fields, "laser pose");
  record.robot = take_pose(fields, "robot pose");
  take_stamps(fields, record);
}

// ROBOTLASER1 type start_angle field_of_view resolution max_range accuracy remission_mode n r1 .. rn m e1 .. em
// laser_x y theta robot_x y theta tv rv forward_safety side_safety turn_axis ipc_timestamp ipc_hostname
// logger_timestamp
void take_robotlaser(TextFields& fields, CarmenRecord& record) {
  record.is_scan = true;
  LaserScan& scan = record.scan;
  fields.number("laser_type");
  scan.angle_min = fields.number("start_angle");
  fields.number("field_of_view");
  scan.angle_step = fields.number("angular_resolution");
  if (!(scan.angle_step > 1e-6 && scan.angle_step <= kPi))
    fields.fail("'angular_resolution' must be positive and at most half a turn [rad]; correct or delete the line");
  scan.range_max = fields.number("maximum_range");
  if (!(scan.range_max > 0.0 && scan.range_max <= kFarthestRange))
    fields.fail(
        "'maximum_range' must be positive and at most 1000 m; is it in another unit? correct or delete the line");
  fields.number("accuracy");
  fields.number("remission_mode");
  take_ranges(fields, fields.integer("num_readings", 1, kMaxBeams), scan);
  fields.skip(static_cast<int>(fields.integer("num_remissions", 0, kMaxBeams)), "remission");
  record.laser = take_pose(fields, "laser pose");
  record.robot = take_pose(fields, "robot pose");
  record.v = fields.number("laser_tv");
  record.w = fields.number("laser_rv");
  fields.skip(3, "safety distances and turn axis");
  take_stamps(fields, record);
}

/// What PARAM lines tell of the front laser.
struct FrontLaser {
  std::optional<double> field_of_view;  ///< [rad]
  std::optional<double> resolution;     ///< [rad]
};

/// The angle of a PARAM line, which some write in degrees and some in radians; nothing where it is none ("none").
std::optional<double> take_angle(TextFields& fields, double most_radians) {
  const std::string_view field = fields.text("angle");
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  const bool is_number = error == std::errc{} && end == field.data() + field.size();
  if (!is_number || !(value > 0.0 && value <= 360.0)) return std::nullopt;
  return value > most_radians ? deg_to_rad(value) : value;
}

void take_param(TextFields& fields, CarmenText& log, FrontLaser& laser) {
  const std::string_view name = fields.text("parameter name");
  if (name == "laser_front_laser_fov") laser.field_of_view = take_angle(fields, kWidestInRadians);
  if (name == "laser_front_laser_resolution") laser.resolution = take_angle(fields, kCoarsestInRadians);
  if (name == "robot_frontlaser_offset") log.front_laser_offset = fields.number("robot_frontlaser_offset");
  if (name == "robot_length") log.robot_length = fields.number("robot_length");
  if (name == "robot_width") log.robot_width = fields.number("robot_width");
}

/// The angle from the first beam to the last, or to where one more would be, and how many steps it has.
struct Fan {
  double width = kPi;
  double steps = 0.0;
};

/// As SICK scanners have it: 181 or 361 beams cover the half circle with both ends, 180 or 360 leave out the last one.
Fan half_circle(std::size_t beams) { return {kPi, static_cast<double>(beams % 2 == 1 ? beams - 1 : beams)}; }

bool is_usual(const Fan& fan) {
  constexpr std::array<double, 5> kUsual{90.0, 180.0, 360.0, 720.0, 1440.0};
  return std::find(kUsual.begin(), kUsual.end(), fan.steps) != kUsual.end();
}

/// What PARAM tells, where it goes with the number of beams.
std::optional<Fan> told_fan(const FrontLaser& laser, std::size_t beams) {
  Fan fan = half_circle(beams);
  const double half_steps = fan.steps;
  if (laser.field_of_view && laser.resolution) {
    const double told = *laser.field_of_view / *laser.resolution;
    const auto all = static_cast<double>(beams);
    fan.steps = std::abs(told - all) < std::abs(told - (all - 1.0)) ? all : all - 1.0;
    if (std::abs(told - fan.steps) > 0.6) return std::nullopt;
  }
  fan.width = laser.resolution ? *laser.resolution * fan.steps : *laser.field_of_view;
  if (fan.width > 2.0 * kPi + kCoarsestInRadians || fan.width < 1e-5 * fan.steps) return std::nullopt;
  // Rounded in the file.
  if (fan.steps == half_steps && std::abs(fan.width - kPi) < 1e-3) return half_circle(beams);
  // Logs of every other beam keep the head of the whole.
  if (!laser.field_of_view && is_usual(half_circle(beams))) return std::nullopt;
  return fan;
}

/// FLASER lines tell only how many beams they have.
void set_bearings(const FrontLaser& laser, const std::string& path, CarmenText& log) {
  const bool tells = laser.field_of_view || laser.resolution;
  for (CarmenRecord& record : log.records) {
    if (!record.is_scan) continue;
    const std::size_t beams = record.scan.ranges.size();
    const std::optional<Fan> told = tells ? told_fan(laser, beams) : std::nullopt;
    const Fan fan = told.value_or(half_circle(beams));
    record.scan.angle_min = -0.5 * fan.width;
    record.scan.angle_step = fan.width / fan.steps;
    if (told || !log.notes.empty() || (!tells && is_usual(fan))) continue;
    log.notes.push_back(path + ": " +
                        (tells
                             ? "laser_front_laser_fov or laser_front_laser_resolution does not go with FLASER lines of "
                             : "nothing tells the field of view of FLASER lines of ") +
                        std::to_string(beams) + " beams: 180 deg are assumed; " +
                        (tells ? "correct these PARAM lines"
                               : "if it is another, add the line: PARAM laser_front_laser_fov <degrees>"));
  }
}

}  // namespace

bool is_carmen(std::string_view text) {
  constexpr std::array<std::string_view, 9> kOpeners{"PARAM",       "SYNC",      "ODOM",    "FLASER", "RLASER",
                                                     "ROBOTLASER1", "RAWLASER1", "TRUEPOS", "NEFF"};
  TextLines lines(text);
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.empty() || line == "\r" || line[0] == '#') continue;
    const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
    return std::find(kOpeners.begin(), kOpeners.end(), word) != kOpeners.end();
  }
  return false;
}

CarmenText parse_carmen(std::string_view text, const std::string& path) {
  CarmenText log;
  FrontLaser laser;
  std::string_view scan_keyword;  // a log may carry each scan in both forms; the first one met is read
  TextLines lines(text);
  while (lines.next()) {
    TextFields fields(path, lines);
    if (fields.peek().empty() || fields.peek()[0] == '#') continue;
    const std::string_view keyword = fields.text("keyword");
    if (!is_keyword(keyword))
      fields.fail("'" + std::string(keyword.substr(0, 40)) +
                  "' is no CARMEN message (FLASER, ROBOTLASER1, ODOM, PARAM, ...); correct or delete the line");
    const bool is_scan = keyword == "FLASER" || keyword == "ROBOTLASER1";
    if (keyword == "PARAM") take_param(fields, log, laser);
    if (!is_scan && keyword != "ODOM") continue;
    if (is_scan && scan_keyword.empty()) scan_keyword = keyword;
    if (is_scan && keyword != scan_keyword) continue;
    CarmenRecord record;
    record.line = lines.number();
    if (keyword == "ODOM") take_odom(fields, record);
    if (keyword == "FLASER") take_flaser(fields, record);
    if (keyword == "ROBOTLASER1") take_robotlaser(fields, record);
    log.records.push_back(std::move(record));
  }
  if (scan_keyword.empty())
    throw InputError(path + ": the CARMEN log holds no FLASER or ROBOTLASER1 line; give a log with laser scans");
  if (scan_keyword == "FLASER") set_bearings(laser, path, log);
  return log;
}

}  // namespace rubble::robot
