#include "scenarios/hardware/raw_replay.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "robot/drivers/black_box_replay.h"
#include "robot/drivers/scip/scip_replay.h"
#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/log.h"
#include "scenarios/hardware/robot_file.h"

namespace rubble::scenarios {
namespace {

bool same(const robot::LaserScan& a, const robot::LaserScan& b) {
  return a.stamp == b.stamp && a.ranges.size() == b.ranges.size() && a.codes == b.codes &&
         std::memcmp(a.ranges.data(), b.ranges.data(), a.ranges.size() * sizeof(float)) == 0;
}
bool same(const robot::Odometry& a, const robot::Odometry& b) {
  return a.stamp == b.stamp && a.pose.x == b.pose.x && a.pose.y == b.pose.y && a.pose.phi == b.pose.phi && a.v == b.v &&
         a.w == b.w && a.stalled == b.stalled;
}
bool same(const robot::Acceleration& a, const robot::Acceleration& b) {
  return a.stamp == b.stamp && a.x == b.x && a.y == b.y;
}
bool same(const robot::AimState& a, const robot::AimState& b) {
  return a.stamp == b.stamp && a.pitch == b.pitch && a.roll == b.roll;
}

/// Finds each recorded entry among the replayed ones, in order.
template <class T>
RawReplay::Kind compared(const std::string& name, const std::vector<T>& recorded, const std::vector<T>& replayed) {
  RawReplay::Kind kind;
  kind.name = name;
  kind.recorded = recorded.size();
  kind.replayed = replayed.size();
  auto next = replayed.begin();
  for (const T& then : recorded) {
    const auto found = std::find_if(next, replayed.end(), [&](const T& now) { return same(then, now); });
    if (found == replayed.end()) continue;
    ++kind.same;
    next = found + 1;
  }
  return kind;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

RawReplay replay_raw(const std::string& run_folder) {
  for (const char* name : {"robot.yaml", "devices.bytes"})
    if (!std::filesystem::exists(run_folder + "/" + name))
      throw InputError(run_folder + ": has no bytes of devices (no " + name +
                       " in it); give a folder that 'rubble drive' wrote");
  const RobotFile file = load_robot_file(run_folder + "/robot.yaml");
  const std::vector<robot::BlackBoxEntry> entries = robot::read_black_box(run_folder + "/devices.bytes");
  robot::Inputs recorded;
  require_input(run_folder + "/log.rlog", robot::log_rules());
  robot::ReplayRobot log(run_folder + "/log.rlog");
  while (const auto inputs = log.read()) {
    append(recorded.scans, inputs->scans);
    append(recorded.odometry, inputs->odometry);
    append(recorded.accelerations, inputs->accelerations);
    append(recorded.aims, inputs->aims);
  }

  RawReplay result;
  if (file.lidar.driver == LidarDriver::Scip) {  // MRPT opens its port itself: its bytes are not there
    robot::ReplayedScans scans =
        robot::replay_scanner(entries, {file.settings.robot.laser.range_max, file.lidar.no_echo_is_miss});
    for (robot::LaserScan& scan : scans.scans) as_mounted(file.lidar, scan);
    result.kinds.push_back(compared("scans", recorded.scans, scans.scans));
    result.damaged_scans = scans.damaged;
  }
  const robot::ReplayedBox box =
      robot::replay_black_box(entries, file.robot.base_driver, file.robot.base, file.robot.levelling);
  result.kinds.push_back(compared("odometry", recorded.odometry, box.odometry));
  result.kinds.push_back(compared("accelerations", recorded.accelerations, box.accelerations));
  result.kinds.push_back(compared("servo angles", recorded.aims, box.aims));
  result.bad_sums = box.bad_sums;
  result.jumps = box.jumps;
  result.bad_lines = box.bad_lines;
  std::size_t recorded_in_all = 0;
  for (const RawReplay::Kind& kind : result.kinds) {
    result.identical = result.identical && kind.same == kind.recorded;
    recorded_in_all += kind.recorded;
  }
  if (recorded_in_all == 0)
    throw InputError(run_folder + (entries.empty() ? ": no bytes were recorded" : ": no measurement was recorded") +
                     ", so there is nothing to compare; give a drive whose devices have reported");
  return result;
}

}  // namespace rubble::scenarios
