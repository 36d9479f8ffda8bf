#include <algorithm>
#include <array>
#include <cctype>
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

// FLASER n r1 .. rn x y theta odom_x odom_y odom_theta ipc_timestamp ipc_hostname logger_timestamp
void take_flaser(TextFields& fields, CarmenRecord& record) {
  record.is_scan = true;
  const std::int64_t count = fields.integer("num_readings", 2, kMaxBeams);
  // 181 or 361 beams cover the half circle with both ends, 180 or 360 leave out the last one.
  const auto intervals = static_cast<double>(count % 2 == 1 ? count - 1 : count);
  record.scan.angle_min = -0.5 * kPi;
  record.scan.angle_step = kPi / intervals;
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

void take_param(TextFields& fields, CarmenText& log) {
  const std::string_view name = fields.text("parameter name");
  if (name == "robot_frontlaser_offset") log.front_laser_offset = fields.number("robot_frontlaser_offset");
  if (name == "robot_length") log.robot_length = fields.number("robot_length");
  if (name == "robot_width") log.robot_width = fields.number("robot_width");
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
    if (keyword == "PARAM") take_param(fields, log);
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
  return log;
}

}  // namespace rubble::robot
