#include "robot/logs/foreign/foreign_log.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/lists.h"

namespace rubble::robot {
namespace {

void keep_last_of_equal_stamps(std::vector<Odometry>& odometry) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    if (i + 1 < odometry.size() && odometry[i + 1].stamp == odometry[i].stamp) continue;
    odometry[kept++] = odometry[i];
  }
  odometry.resize(kept);
}

void stand_still_before_first_odometry(const std::vector<LaserScan>& scans, std::vector<Odometry>& odometry) {
  Odometry resting;
  if (odometry.empty()) {
    for (const LaserScan& scan : scans) {
      resting.stamp = scan.middle();
      odometry.push_back(resting);
    }
  } else if (!scans.empty() && scans.front().middle() < odometry.front().stamp) {
    resting.stamp = scans.front().middle();
    resting.pose = odometry.front().pose;
    odometry.insert(odometry.begin(), resting);
  }
}

Stamp end_of(const LaserScan& scan) {
  return scan.ranges.empty() ? scan.stamp : scan.beam_stamp(scan.ranges.size() - 1);
}

template <class T>
double median_interval(const std::vector<T>& list, double fallback) {
  std::vector<Stamp> stamps;
  for (const T& entry : list) stamps.push_back(entry.stamp);
  std::sort(stamps.begin(), stamps.end());
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  if (intervals.empty()) return fallback;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle > 0.0 ? *middle : fallback;
}

}  // namespace

std::vector<Stamp> sorted_stamps(std::vector<Stamp> stamps) {
  std::sort(stamps.begin(), stamps.end());
  for (std::size_t i = 1; i < stamps.size(); ++i) stamps[i].ns = std::max(stamps[i].ns, stamps[i - 1].ns + 1000);
  return stamps;
}

std::vector<Inputs> assemble_ticks(std::vector<LaserScan> scans, std::vector<Odometry> odometry) {
  sort_by_stamp(scans);
  sort_by_stamp(odometry);
  stand_still_before_first_odometry(scans, odometry);
  keep_last_of_equal_stamps(odometry);

  std::vector<Inputs> ticks;
  std::size_t next_scan = 0;
  std::size_t next_odometry = 0;
  const auto close = [&ticks](Inputs& tick) {
    for (const LaserScan& scan : tick.scans) tick.now = std::max(tick.now, end_of(scan));
    for (const Odometry& odometry : tick.odometry) tick.now = std::max(tick.now, odometry.stamp);
    if (!ticks.empty()) tick.now = std::max(tick.now, Stamp{ticks.back().now.ns + 1});
    ticks.push_back(std::move(tick));
    tick = Inputs{};
    tick.now = Stamp::never();
  };
  Inputs tick;
  tick.now = Stamp::never();
  for (; next_odometry < odometry.size(); ++next_odometry) {
    const Stamp arrived = odometry[next_odometry].stamp;
    tick.odometry.push_back(odometry[next_odometry]);
    while (next_scan < scans.size() && scans[next_scan].middle() <= arrived)
      tick.scans.push_back(std::move(scans[next_scan++]));
    if (!tick.scans.empty()) close(tick);
  }
  while (next_scan < scans.size()) tick.scans.push_back(std::move(scans[next_scan++]));
  if (!tick.scans.empty() || !tick.odometry.empty()) close(tick);
  return ticks;
}

double no_echo_from(const std::vector<LaserScan>& scans) {
  constexpr double kPile = 0.985;  // of the largest reading; SICK scanners in their 8 m mode write 8.15 to 8.19
  constexpr double kBelow = 0.85;
  constexpr double kDensity = 4.0;
  constexpr std::size_t kLeast = 20;
  constexpr std::size_t kBeams = 5;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  float largest = 0.0f;
  for (const LaserScan& scan : scans)
    for (const float range : scan.ranges)
      if (std::isfinite(range)) largest = std::max(largest, range);
  const double limit = kPile * static_cast<double>(largest);
  const double foot = kBelow * static_cast<double>(largest);
  std::map<float, std::size_t> pile;
  std::set<std::size_t> beams;
  std::size_t piled = 0;
  std::size_t below = 0;
  for (const LaserScan& scan : scans)
    for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
      const float range = scan.ranges[beam];
      if (!std::isfinite(range) || static_cast<double>(range) < foot) continue;
      if (static_cast<double>(range) < limit) {
        ++below;
      } else {
        ++pile[range];
        ++piled;
        beams.insert(beam);
      }
    }
  std::size_t commonest = 0;
  for (const auto& [range, count] : pile) commonest = std::max(commonest, count);
  const double wide = (1.0 - kPile) / (kPile - kBelow);
  const bool dense = static_cast<double>(piled) >= kDensity * wide * static_cast<double>(below);
  return piled >= kLeast && beams.size() >= kBeams && 2 * commonest >= piled && dense ? limit : kNone;
}

void take_as_misses(double limit, std::vector<LaserScan>& scans) {
  for (LaserScan& scan : scans) {
    scan.range_max = std::min(scan.range_max, limit);
    for (float& range : scan.ranges)
      if (static_cast<double>(range) >= limit) range = LaserScan::kMiss;
  }
}

void describe_sensors(const std::vector<LaserScan>& scans, const std::vector<Odometry>& odometry, RobotModel& model) {
  model.has_levelling_unit = false;
  model.odometry_period = median_interval(odometry, model.odometry_period);
  if (scans.empty()) return;
  const LaserScan& first = scans.front();
  LaserModel& laser = model.laser;
  laser.beams = static_cast<int>(first.ranges.size());
  laser.angle_min = first.angle_min;
  laser.angle_step = first.angle_step;
  laser.range_min = first.range_min;
  laser.range_max = first.range_max;
  laser.beam_period = first.beam_period;
  laser.scan_period = median_interval(scans, laser.scan_period);
  model.tick = laser.scan_period;
}

}  // namespace rubble::robot
