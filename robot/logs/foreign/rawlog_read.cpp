#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "base/planar.h"
#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/mrpt_stamp.h"
#include "robot/logs/foreign/rawlog_facts.h"
#include "robot/logs/foreign/rawlog_own.h"
#include "robot/logs/foreign/text_fields.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;

constexpr double kFrameSpacing = 0.1;  // between scans that carry no time [s]

/// What the entries of a rawlog say, one scanner only: the one of the first scan.
struct Contents {
  std::optional<RobotModel> own_model;  ///< we wrote the file
  std::vector<MrptScan> scans;
  std::vector<Odometry> driven;  ///< actions added up, one entry a scan
  bool has_actions = false;
  std::vector<Odometry> observed;           ///< odometry entries
  std::vector<std::size_t> observed_frame;  ///< how many scans came before each
};

/// Label and place; the yaw may differ, as it takes up the bearings of scans that are not symmetric.
bool same_scanner(const MrptScan& a, const MrptScan& b) {
  const double tolerance = 1e-9;
  const mrpt::math::TPose3D p = a.T_base_sensor.asTPose();
  const mrpt::math::TPose3D q = b.T_base_sensor.asTPose();
  return a.label == b.label && std::abs(p.x - q.x) < tolerance && std::abs(p.y - q.y) < tolerance &&
         std::abs(p.z - q.z) < tolerance && std::abs(wrap_angle(p.pitch - q.pitch)) < tolerance &&
         std::abs(wrap_angle(p.roll - q.roll)) < tolerance;
}

class Collector : public RawlogVisitor {
 public:
  explicit Collector(const std::string& path) : path_(path) {}

  void comment(std::size_t entry, const std::string& text) override {
    try {
      if (auto model = model_of_comment(text)) contents.own_model = std::move(model);
    } catch (const BadPayload& e) {
      throw InputError(path_ + ": entry " + std::to_string(entry) + ": the comment with the robot model is damaged (" +
                       e.what() + "); export the log again");
    }
  }

  void movement(std::size_t, const Movement& movement) override {
    now_.pose = wrapped(now_.pose + movement.step);
    now_.v = movement.v;
    now_.w = movement.w;
    contents.has_actions = true;
  }

  void odometry(std::size_t, const Odometry& odometry) override {
    contents.observed.push_back(odometry);
    contents.observed_frame.push_back(contents.scans.size());
  }

  void scan(std::size_t, MrptScan scan) override {
    if (scan.ranges.size() < 2) return;
    if (!contents.scans.empty() && !same_scanner(scan, contents.scans.front())) return;
    now_.stamp = from_mrpt_time(scan.time);
    contents.scans.push_back(std::move(scan));
    contents.driven.push_back(now_);
  }

  Contents contents;

 private:
  const std::string& path_;
  Odometry now_;
};

/// Spreads scans without time stamps evenly, odometry along with the scan it came before.
void space_evenly(std::vector<LaserScan>& scans, Contents& contents) {
  const auto time_of = [](std::size_t frame) {
    return Stamp::from_seconds(static_cast<double>(frame) * kFrameSpacing);
  };
  for (std::size_t i = 0; i < scans.size(); ++i) scans[i].stamp = contents.driven[i].stamp = time_of(i);
  for (std::size_t i = 0; i < contents.observed.size(); ++i)
    contents.observed[i].stamp = time_of(contents.observed_frame[i]);
}

template <class T>
void check_times(const std::vector<T>& list, const std::string& path, const char* what) {
  Stamp latest = Stamp::never();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (latest != Stamp::never() && latest - list[i].stamp > kStampJitter)
      throw InputError(path + ": " + what + " " + std::to_string(i) + " (counted from 0) lies " +
                       std::to_string(latest - list[i].stamp) +
                       " s before an earlier one; sort the rawlog with: rawlog-edit --stamp-order, or cut it there");
    latest = std::max(latest, list[i].stamp);
  }
}

void check_finite(const std::vector<Odometry>& odometry, const std::string& path) {
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    const Odometry& o = odometry[i];
    if (!std::isfinite(o.pose.x + o.pose.y + o.pose.phi + o.v + o.w))
      throw InputError(path + ": odometry " + std::to_string(i) +
                       " (counted from 0) is not finite; cut the rawlog there with: rawlog-edit --cut");
  }
}

/// Foreign scans: what lies at the limit or beyond is no return, what is not finite is no measurement.
void clean_ranges(LaserScan& scan) {
  for (float& range : scan.ranges) {
    if (std::isnan(range) || range < 0.0f) range = LaserScan::kUnknown;
    if (static_cast<double>(range) >= scan.range_max) range = LaserScan::kMiss;
  }
}

/// Our own scans: gives back the numbers of the model that MRPT keeps as floats or not at all.
void restore_geometry(const LaserModel& laser, LaserScan& scan) {
  const double tolerance = 1e-6;
  const bool same = static_cast<int>(scan.ranges.size()) == laser.beams &&
                    std::abs(wrap_angle(scan.angle_min - laser.angle_min)) < tolerance &&
                    std::abs(scan.angle_step - laser.angle_step) < tolerance &&
                    std::abs(scan.range_max - laser.range_max) < tolerance * laser.range_max;
  if (!same) return;
  set_geometry(scan, laser);
}

ForeignLog own_log(const RobotModel& model, std::vector<LaserScan>& scans, std::vector<Odometry>& odometry) {
  ForeignLog log;
  log.model = model;
  for (LaserScan& scan : scans) restore_geometry(model.laser, scan);
  for (Odometry& o : odometry)
    if (o.w == kStraightTurnRate) o.w = 0.0;
  return log;
}

void start_at_zero(std::vector<Odometry>& odometry) {
  if (odometry.empty()) return;
  const TPose2D T_start_base = odometry.front().pose;
  for (Odometry& o : odometry) o.pose = wrapped(o.pose - T_start_base);
}

/// What no scanner measures is another unit or damage, and would make a map of the size of a town.
void refuse_impossible(const std::vector<LaserScan>& scans, const std::string& path) {
  constexpr double kFarthestRange = 1000.0;  // [m]
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const LaserScan& scan = scans[i];
    const bool fan = scan.ranges.size() < 2 || (std::abs(scan.angle_step) > 1e-6 && std::abs(scan.angle_step) <= kPi);
    if (scan.range_max > 0.0 && scan.range_max <= kFarthestRange && fan && std::isfinite(scan.angle_min)) continue;
    throw InputError(path + ": scan " + std::to_string(i) +
                     " (counted from 0) has a range limit that is not within 1000 m, or beams without an angle between"
                     " them; is it in another unit? Cut the rawlog there with: rawlog-edit --cut");
  }
}

ForeignLog others_log(const MrptScan& first, std::vector<LaserScan>& scans, std::vector<Odometry>& odometry) {
  ForeignLog log;
  for (LaserScan& scan : scans) clean_ranges(scan);
  take_as_misses(no_echo_from(scans), scans);
  start_at_zero(odometry);
  log.model.name = "rawlog";
  log.model.laser.name = first.label.empty() ? "MRPT laser" : first.label;
  log.model.T_base_laser = first.T_base_sensor.asTPose();
  describe_sensors(scans, odometry, log.model);
  return log;
}

}  // namespace

ForeignLog read_rawlog_bytes(std::string_view bytes, const std::string& path) {
  Collector collector(path);
  visit_rawlog(bytes, path, collector);
  Contents& contents = collector.contents;
  if (contents.scans.empty())
    throw InputError(path + ": the rawlog holds no 2D laser scan; give one with CObservation2DRangeScan entries");

  const MrptScan& first = contents.scans.front();
  const auto T_base_laser = contents.own_model ? contents.own_model->T_base_laser : first.T_base_sensor.asTPose();
  std::vector<LaserScan> scans;
  for (const auto& scan : contents.scans) scans.push_back(from_mrpt(scan, T_base_laser));
  const bool untimed =
      std::any_of(scans.begin(), scans.end(), [](const LaserScan& s) { return s.stamp == Stamp::never(); });
  if (untimed) space_evenly(scans, contents);
  std::vector<Odometry> odometry;
  if (!contents.observed.empty())
    odometry = std::move(contents.observed);
  else if (contents.has_actions)
    odometry = std::move(contents.driven);
  check_times(scans, path, "laser scan");
  check_times(odometry, path, "odometry");
  check_finite(odometry, path);
  refuse_impossible(scans, path);
  const mrpt::math::TPose3D mount = first.T_base_sensor.asTPose();
  if (!std::isfinite(mount.x + mount.y + mount.z + mount.yaw + mount.pitch + mount.roll))
    throw InputError(path + ": the first scan's mount on the robot is not finite; the file is damaged, copy it again");

  ForeignLog log =
      contents.own_model ? own_log(*contents.own_model, scans, odometry) : others_log(first, scans, odometry);
  log.format = "MRPT rawlog";
  log.reference = read_rawlog_reference(path);
  log.ticks = assemble_ticks(std::move(scans), std::move(odometry));
  return log;
}

std::vector<Inputs> read_rawlog(const std::string& path, RobotModel& model) {
  const std::string bytes = unpacked(read_file(path), path);
  if (!is_rawlog(bytes))
    throw InputError(path + ": byte 0: does not start with an MRPT object; give a .rawlog file of MRPT");
  ForeignLog log = read_rawlog_bytes(bytes, path);
  model = log.model;
  return std::move(log.ticks);
}

Trajectory read_rawlog_reference(const std::string& path) {
  const std::string truth = path + ".GT.txt";
  std::error_code error;
  if (!std::filesystem::exists(truth, error)) return {};
  const std::string text = read_input(truth);
  Trajectory reference;
  TextLines lines(text);
  while (lines.next()) {
    TextFields fields(truth, lines);
    if (fields.peek().empty() || fields.peek()[0] == '#' || fields.peek()[0] == '%') continue;
    StampedPose stamped;
    stamped.stamp = fields.stamp("time");
    stamped.pose.x = fields.number("x");
    stamped.pose.y = fields.number("y");
    stamped.pose.phi = wrap_angle(fields.number("phi"));
    if (!reference.empty() && stamped.stamp <= reference.back().stamp)
      throw InputError(at(truth, lines.number(), 1, "the time does not increase; sort the file by time"));
    reference.push_back(stamped);
  }
  return reference;
}

bool is_rawlog(std::string_view bytes) {
  // A serialized object starts with the length of its class name, top bit set, and the name.
  if (bytes.empty() || (static_cast<unsigned char>(bytes[0]) & 0x80u) == 0) return false;
  const std::size_t length = static_cast<unsigned char>(bytes[0]) & 0x7fu;
  const std::string_view name = bytes.substr(1, length);
  return length > 1 && name.size() == length && std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == ':';
         });
}

}  // namespace rubble::robot
