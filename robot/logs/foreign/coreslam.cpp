#include "robot/logs/foreign/coreslam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "robot/logs/foreign/text_fields.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;

constexpr int kFirstRange = 24;
constexpr int kBeams = 683;
constexpr int kCentreBeam = 341;
constexpr int kFirstUseful = 62;  // outside, the robot's own body is in the way
constexpr int kLastUseful = 641;
constexpr int kFirstRealRange = 20;  // smaller numbers are the URG's codes [mm]
constexpr int kNothingCode = 0;      // no echo: nothing in range

constexpr double kWheelRadius = 0.077;    // [m]
constexpr double kHalfTrack = 0.165;      // [m]
constexpr double kTicksPerTurn = 2000.0;  // of a wheel
constexpr double kBeamPeriod = 0.1 / 1024.0;
// A line is stamped when the scan has come over the serial link. Measured: the turns that successive scans of exp1.dat
// show fit the wheels' turns best when the scans are taken to be this much older (docs/robot.md).
constexpr double kScanAge = 0.15;  // of the middle beam [s]

constexpr std::int64_t kMaxTicks = 1000000000000;

struct Line {
  Stamp stamp;
  double left = 0.0;   // [ticks]
  double right = 0.0;  // [ticks]
  LaserScan scan;
};

RobotModel mines_robot() {
  RobotModel model;
  model.name = "mines-paristech";
  model.wheel_radius = kWheelRadius;
  model.track = 2.0 * kHalfTrack;
  model.effective_track = model.track;
  model.T_base_laser.x = 0.145;
  model.laser.name = "URG-04LX";
  return model;
}

float range_of(std::int64_t mm, int beam) {
  const bool useful = beam >= kFirstUseful && beam <= kLastUseful;
  if (!useful) return LaserScan::kUnknown;
  if (mm == kNothingCode) return LaserScan::kMiss;
  if (mm < kFirstRealRange) return LaserScan::kUnknown;
  return static_cast<float>(static_cast<double>(mm) * 0.001);
}

Line take_line(TextFields& fields) {
  Line line;
  line.stamp.ns = fields.integer("time in us", 0, std::numeric_limits<std::int64_t>::max() / 4000) * 1000;
  fields.number("field 2");
  line.left = static_cast<double>(fields.integer("left encoder", -kMaxTicks, kMaxTicks));
  line.right = static_cast<double>(fields.integer("right encoder", -kMaxTicks, kMaxTicks));
  for (int i = 4; i < kFirstRange; ++i) fields.number("a number before the ranges");
  LaserScan& scan = line.scan;
  scan.angle_step = 2.0 * kPi / 1024.0;
  scan.angle_min = -kCentreBeam * scan.angle_step;
  scan.beam_period = kBeamPeriod;
  scan.range_min = 0.02;
  scan.range_max = 5.6;
  scan.ranges.reserve(kBeams);
  for (int beam = 0; beam < kBeams; ++beam)
    scan.ranges.push_back(range_of(fields.integer("range in mm", 0, 65535), beam));
  if (!fields.peek().empty()) {
    fields.text("end of line");
    fields.fail("more than 707 numbers in the line; correct or delete it");
  }
  return line;
}

/// All lines; where the clock jitters the stamps are sorted, the lines keep their order.
std::vector<Line> take_lines(std::string_view text, const std::string& path) {
  std::vector<Line> parsed;
  std::vector<Stamp> stamps;
  Stamp latest;
  TextLines lines(text);
  while (lines.next()) {
    TextFields fields(path, lines);
    if (fields.peek().empty()) continue;
    parsed.push_back(take_line(fields));
    stamps.push_back(parsed.back().stamp);
    latest = std::max(latest, stamps.back());
    if (latest - stamps.back() > kStampJitter)
      throw InputError(at(path, lines.number(), 1, "the time jumps back; delete the line or cut the log here"));
  }
  stamps = sorted_stamps(std::move(stamps));
  for (std::size_t i = 0; i < parsed.size(); ++i) parsed[i].stamp = stamps[i];
  return parsed;
}

/// Differential drive; the chord of an arc points along the mean heading.
void drive(const Line& from, const Line& to, Odometry& odometry) {
  const double metres_per_tick = kWheelRadius * 2.0 * kPi / kTicksPerTurn;
  const double left = (to.left - from.left) * metres_per_tick;
  const double right = (to.right - from.right) * metres_per_tick;
  const double distance = 0.5 * (left + right);
  const double turn = (right - left) / (2.0 * kHalfTrack);
  const double heading = odometry.pose.phi + 0.5 * turn;
  odometry.pose.x += distance * std::cos(heading);
  odometry.pose.y += distance * std::sin(heading);
  odometry.pose.phi = wrap_angle(odometry.pose.phi + turn);
  const double dt = to.stamp - from.stamp;
  odometry.v = dt > 0.0 ? distance / dt : 0.0;
  odometry.w = dt > 0.0 ? turn / dt : 0.0;
}

}  // namespace

bool is_coreslam(std::string_view text) {
  TextLines lines(text.substr(0, std::size_t{1} << 16));
  if (!lines.next()) return false;
  int numbers = 0;
  const std::string_view line = lines.line();
  if (line.find_first_not_of("0123456789+-.eE \t\r") != std::string_view::npos) return false;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos; ++numbers)
    at = std::min(line.find_first_of(" \t\r", at), line.size());
  return numbers >= 100;
}

ForeignLog read_coreslam(std::string_view text, const std::string& path) {
  const std::vector<Line> parsed = take_lines(text, path);
  ForeignLog log;
  log.format = "CoreSLAM log";
  log.model = mines_robot();
  std::vector<LaserScan> scans;
  std::vector<Odometry> odometry;
  Odometry now;
  for (std::size_t i = 0; i < parsed.size(); ++i) {
    if (i > 0) drive(parsed[i - 1], parsed[i], now);
    now.stamp = parsed[i].stamp;
    odometry.push_back(now);
    scans.push_back(parsed[i].scan);
    scans.back().stamp = parsed[i].stamp - kScanAge - kBeamPeriod * (kBeams / 2);
  }
  describe_sensors(scans, odometry, log.model);
  log.ticks = assemble_ticks(std::move(scans), std::move(odometry));
  return log;
}

}  // namespace rubble::robot
