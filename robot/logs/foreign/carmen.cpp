#include "robot/logs/foreign/carmen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "base/planar.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;
using Records = std::vector<CarmenRecord>;

constexpr double kSameLength = 0.3;    ///< scan and odometry poses of one frame agree within this [m]
constexpr double kSameAngle = 0.2;     ///< and this [rad]
constexpr double kFixedLength = 0.05;  ///< a laser keeps its place on the robot within this [m]
constexpr double kFixedAngle = 0.05;   ///< and this [rad]
constexpr double kNoMount = 0.001;     ///< one pose written for robot and laser, by who knows no mount [m, rad]

bool repeats_scan_before(const Records& records, std::size_t i) {
  return i > 0 && !records[i].is_scan && records[i - 1].is_scan && identical(records[i].robot, records[i - 1].robot);
}

/// A scan matcher's log: each scan carries the corrected pose, and right behind it an ODOM line with a meaningless
/// stamp repeats that pose, from where the raw increments go on.
bool is_reanchored(const Records& records) {
  std::size_t scans = 0;
  std::size_t marks = 0;
  std::size_t marks_back_in_time = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].is_scan) ++scans;
    if (!repeats_scan_before(records, i)) continue;
    ++marks;
    if (records[i].measured < records[i - 1].measured) ++marks_back_in_time;
  }
  return marks > 0 && 20 * (scans - marks) <= scans && 2 * marks_back_in_time > marks;
}

/// Composes the raw increments again: ODOM to ODOM as they stand, none from ODOM to scan. Returns the corrected poses;
/// the restart marks are dropped.
std::vector<TPose2D> undo_reanchoring(Records& records) {
  std::vector<TPose2D> corrected;
  Records kept;
  TPose2D T_odom_base(0, 0, 0);
  TPose2D T_anchor_base = records.front().robot;
  for (std::size_t i = 0; i < records.size(); ++i) {
    CarmenRecord& record = records[i];
    if (repeats_scan_before(records, i)) continue;
    const TPose2D T_map_base = record.robot;
    if (record.is_scan)
      corrected.push_back(T_map_base);
    else
      T_odom_base = wrapped(T_odom_base + (T_map_base - T_anchor_base));
    T_anchor_base = T_map_base;
    kept.push_back(record);
    kept.back().robot = T_odom_base;
  }
  records = std::move(kept);
  return corrected;
}

double worst_step_back(const Records& records, Stamp CarmenRecord::*clock, int& line) {
  double worst = 0.0;
  Stamp latest = Stamp::never();
  for (const CarmenRecord& record : records) {
    const Stamp stamp = record.*clock;
    if (latest != Stamp::never() && latest - stamp > worst) {
      worst = latest - stamp;
      line = record.line;
    }
    latest = std::max(latest, stamp);
  }
  return worst;
}

/// The sender's clock where it runs, else the logger's. Throws InputError when both jump back.
Stamp CarmenRecord::*choose_clock(const Records& records, const std::string& path) {
  int line = 0;
  int unused = 0;
  const bool stands =
      records.size() > 1 && std::all_of(records.begin(), records.end(), [&](const CarmenRecord& record) {
        return record.measured == records.front().measured;
      });
  const double back = worst_step_back(records, &CarmenRecord::measured, line);
  if (!stands && back <= kStampJitter) return &CarmenRecord::measured;
  if (worst_step_back(records, &CarmenRecord::logged, unused) <= kStampJitter) return &CarmenRecord::logged;
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3f", back);
  throw InputError(at(path, line, 1,
                      std::string("the time jumps back by ") + seconds +
                          " s; cut the log here, or sort its lines by time if two recordings were joined"));
}

/// Gives every record the stamp it is delivered with. The clocks of such logs jitter, and the order of the lines is the
/// truth: scans share out their own stamps sorted. ODOM lines are held between the scans around them, behind the one
/// before, so that none takes the place of the odometry that a scan itself carries.
void order_stamps(Records& records, Stamp CarmenRecord::*clock) {
  std::vector<Stamp> scans;
  for (const CarmenRecord& record : records)
    if (record.is_scan) scans.push_back(record.*clock);
  scans = sorted_stamps(std::move(scans));

  std::size_t next = 0;
  Stamp newest = Stamp::never();
  for (std::size_t i = 0; i < records.size();) {
    if (records[i].is_scan) {
      records[i++].stamp = newest = scans[next++];
      continue;
    }
    std::vector<Stamp> between;
    std::size_t end = i;
    for (; end < records.size() && !records[end].is_scan; ++end) between.push_back(records[end].*clock);
    between = sorted_stamps(std::move(between));
    for (const Stamp stamp : between) {
      // The odometry that the scan behind it carries too, told once more.
      const bool is_of_scan = end < records.size() && records[i].*clock == records[end].*clock &&
                              identical(records[i].robot, records[end].robot);
      const Stamp after = newest == Stamp::never() ? stamp : std::max(stamp, Stamp{newest.ns + 1000});
      const bool held = next < scans.size() && (is_of_scan || scans[next] < after);
      records[i++].stamp = newest = held ? scans[next] : after;
    }
  }
}

/// Whether the robot poses of the scans lie on the path of the ODOM lines (median of distances and of turns).
bool scans_follow_odometry(const Records& records) {
  Trajectory path;
  for (const CarmenRecord& record : records)
    if (!record.is_scan) path.push_back({record.stamp, record.robot});
  std::vector<double> distances;
  std::vector<double> turns;
  for (const CarmenRecord& record : records) {
    if (!record.is_scan) continue;
    const auto odometry = pose_at(path, record.stamp);
    if (!odometry) continue;
    distances.push_back(std::hypot(record.robot.x - odometry->x, record.robot.y - odometry->y));
    turns.push_back(std::abs(wrap_angle(record.robot.phi - odometry->phi)));
  }
  if (distances.empty()) return true;
  const auto middle = static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), distances.begin() + middle, distances.end());
  std::nth_element(turns.begin(), turns.begin() + middle, turns.end());
  return distances[static_cast<std::size_t>(middle)] <= kSameLength &&
         turns[static_cast<std::size_t>(middle)] <= kSameAngle;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Where the laser sits on the robot, by the poses of both in each scan.
struct SeenMount {
  TPose2D T_base_laser;  ///< median
  bool fixed = false;    ///< all scans agree with it
};

SeenMount seen_mount(const Records& records) {
  std::vector<TPose2D> mounts;
  for (const CarmenRecord& record : records)
    if (record.is_scan) mounts.push_back(record.laser - record.robot);
  std::vector<double> x, y, turns;
  for (const TPose2D& mount : mounts) {
    if (!std::isfinite(mount.x + mount.y + mount.phi)) return {};
    x.push_back(mount.x);
    y.push_back(mount.y);
    turns.push_back(wrap_angle(mount.phi - mounts.front().phi));
  }
  if (mounts.empty()) return {};
  SeenMount seen;
  seen.T_base_laser = {median(x), median(y), wrap_angle(mounts.front().phi + median(turns))};
  seen.fixed = std::all_of(mounts.begin(), mounts.end(), [&](const TPose2D& mount) {
    return std::hypot(mount.x - seen.T_base_laser.x, mount.y - seen.T_base_laser.y) <= kFixedLength &&
           std::abs(wrap_angle(mount.phi - seen.T_base_laser.phi)) <= kFixedAngle;
  });
  return seen;
}

/// PARAM tells how far ahead the laser sits; the rest is told by the poses of the scans where they keep together, and
/// are two. Poses that were corrected apart tell no mount.
void place_laser(const std::optional<double>& ahead, const SeenMount& seen, const std::string& path, ForeignLog& log) {
  mrpt::math::TPose3D& mount = log.model.T_base_laser;
  const TPose2D& T_base_laser = seen.T_base_laser;
  mount.x = ahead.value_or(seen.fixed ? T_base_laser.x : 0.0);
  const bool one_pose =
      std::hypot(T_base_laser.x, T_base_laser.y) <= kNoMount && std::abs(T_base_laser.phi) <= kNoMount;
  if (!seen.fixed || (ahead && one_pose)) return;
  mount.y = T_base_laser.y;
  mount.yaw = wrap_angle(T_base_laser.phi);
  if (std::abs(mount.x - T_base_laser.x) <= kFixedLength) return;
  char note[200];
  std::snprintf(note, sizeof note,
                ": robot_frontlaser_offset puts the laser %.2f m ahead, the poses of its scans %.2f m: %.2f m is taken;"
                " where the scans are right, delete the PARAM line",
                mount.x, T_base_laser.x, mount.x);
  log.notes.push_back(path + note);
}

}  // namespace

ForeignLog read_carmen(std::string_view text, const std::string& path) {
  CarmenText carmen = parse_carmen(text, path);
  Records& records = carmen.records;

  const SeenMount seen = seen_mount(records);
  const bool reanchored = is_reanchored(records);
  const std::vector<TPose2D> corrected = reanchored ? undo_reanchoring(records) : std::vector<TPose2D>{};
  Stamp CarmenRecord::*const clock = choose_clock(records, path);
  order_stamps(records, clock);
  const bool scans_are_raw = reanchored || scans_follow_odometry(records);

  ForeignLog log;
  log.format = "CARMEN log";
  log.notes = std::move(carmen.notes);
  log.model.name = "carmen";
  if (carmen.robot_length && *carmen.robot_length > 0.0) log.model.length = *carmen.robot_length;
  if (carmen.robot_width && *carmen.robot_width > 0.0) log.model.width = *carmen.robot_width;
  place_laser(carmen.front_laser_offset, seen, path, log);
  log.model.laser.name = "CARMEN laser";

  const mrpt::math::TPose3D& mount = log.model.T_base_laser;
  const TPose2D T_laser_base = TPose2D(0, 0, 0) - TPose2D(mount.x, mount.y, mount.yaw);
  std::vector<LaserScan> scans;
  std::vector<Odometry> odometry;
  std::optional<TPose2D> T_start_base;
  double v = 0.0;
  double w = 0.0;
  for (CarmenRecord& record : records) {
    if (!record.is_scan || record.v != 0.0 || record.w != 0.0) {
      v = record.v;
      w = record.w;
    }
    if (record.is_scan) {
      if (reanchored)
        log.reference.push_back({record.stamp, wrapped(corrected[scans.size()])});
      else if (!scans_are_raw)
        log.reference.push_back({record.stamp, wrapped(record.robot)});
      else if (!seen.fixed)
        log.reference.push_back({record.stamp, wrapped(record.laser + T_laser_base)});
      record.scan.stamp = record.stamp;
      log.own_stamps.push_back({record.stamp, record.*clock});
      scans.push_back(std::move(record.scan));
    }
    if (record.is_scan && !scans_are_raw) continue;
    if (!T_start_base) T_start_base = record.robot;
    odometry.push_back({record.stamp, wrapped(record.robot - *T_start_base), v, w, false});
  }
  take_as_misses(no_echo_from(scans), scans);
  describe_sensors(scans, odometry, log.model);
  log.ticks = assemble_ticks(std::move(scans), std::move(odometry));
  return log;
}

}  // namespace rubble::robot
