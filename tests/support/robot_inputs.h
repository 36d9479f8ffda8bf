#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"
#include "robot/logs/foreign/foreign_log.h"
#include "robot/logs/log.h"
#include "robot/robot.h"

namespace rubble::robot::testing {

constexpr float kMiss = std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// A folder of its own that goes with the test.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rubble_test_XXXXXX").string();
    path_ = ::mkdtemp(&pattern[0]);
  }
  ~TempFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string file(const std::string& name) const { return (std::filesystem::path(path_) / name).string(); }

 private:
  std::string path_;
};

inline std::vector<LaserScan> scans_of(const ForeignLog& log) {
  std::vector<LaserScan> scans;
  for (const Inputs& tick : log.ticks) scans.insert(scans.end(), tick.scans.begin(), tick.scans.end());
  return scans;
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
}

/// Folder of the public data; empty when the environment does not name it.
inline std::string data_folder() {
  const char* folder = std::getenv("RUBBLE_DATA");
  return folder == nullptr ? "" : folder;
}

/// A robot that delivers given ticks and remembers its commands.
class ScriptedRobot : public Robot {
 public:
  explicit ScriptedRobot(std::vector<Inputs> ticks, RobotModel model = {})
      : ticks_(std::move(ticks)), model_(std::move(model)) {}
  const RobotModel& model() const override { return model_; }
  std::optional<Inputs> read() override {
    if (next_ == ticks_.size()) return std::nullopt;
    return ticks_[next_++];
  }
  void command(const Commands& commands) override { received.push_back(commands); }

  std::vector<Commands> received;

 private:
  std::vector<Inputs> ticks_;
  RobotModel model_;
  std::size_t next_ = 0;
};

inline std::vector<Inputs> play(Robot& robot) {
  std::vector<Inputs> ticks;
  while (auto inputs = robot.read()) ticks.push_back(std::move(*inputs));
  return ticks;
}

inline std::vector<Inputs> play(const std::string& path) {
  ReplayRobot replay(path);
  return play(replay);
}

inline void record(const std::vector<Inputs>& ticks, const std::string& path, const std::string& note = "") {
  ScriptedRobot robot(ticks);
  RecordingRobot recorder(robot, path, note);
  while (recorder.read()) {
  }
}

/// Bits, so that NaN equals itself and 0 differs from -0.
inline bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
inline bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}
inline bool same(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.phi, b.phi);
}
inline bool same(const LaserScan& a, const LaserScan& b) {
  return a.stamp == b.stamp && same(a.angle_min, b.angle_min) && same(a.angle_step, b.angle_step) &&
         same(a.beam_period, b.beam_period) && same(a.range_min, b.range_min) && same(a.range_max, b.range_max) &&
         same(a.ranges, b.ranges);
}
inline bool same(const Odometry& a, const Odometry& b) {
  return a.stamp == b.stamp && same(a.pose, b.pose) && same(a.v, b.v) && same(a.w, b.w) && a.stalled == b.stalled;
}
inline bool same(const Acceleration& a, const Acceleration& b) {
  return a.stamp == b.stamp && same(a.x, b.x) && same(a.y, b.y);
}
inline bool same(const AimState& a, const AimState& b) {
  return a.stamp == b.stamp && same(a.pitch, b.pitch) && same(a.roll, b.roll);
}
inline bool same(const VictimCue& a, const VictimCue& b) {
  return a.stamp == b.stamp && a.kind == b.kind && same(a.bearing, b.bearing) && same(a.range, b.range) &&
         same(a.confidence, b.confidence);
}
bool same(const Inputs& a, const Inputs& b);

template <class T>
bool same_list(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same(a[i], b[i])) return false;
  return true;
}
inline bool same(const Inputs& a, const Inputs& b) {
  return a.now == b.now && same_list(a.scans, b.scans) && same_list(a.odometry, b.odometry) &&
         same_list(a.accelerations, b.accelerations) && same_list(a.aims, b.aims) && same_list(a.cues, b.cues);
}
inline bool same(const Commands& a, const Commands& b) {
  return same(a.drive.v, b.drive.v) && same(a.drive.w, b.drive.w) && same(a.aim.pitch, b.aim.pitch) &&
         same(a.aim.roll, b.aim.roll) && a.brake == b.brake;
}

/// Any double there is: numbers of common size, and now and then any bit pattern.
inline double random_double(Rng& rng) {
  if (rng.below(8) != 0) return rng.uniform(-100.0, 100.0);
  const std::uint64_t high = rng.next_u32();
  const std::uint64_t low = rng.next_u32();
  const std::uint64_t bits = (high << 32) | low;
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

inline float random_range(Rng& rng) {
  const std::uint32_t sort = rng.below(10);
  const double metres = rng.uniform(0.0, 6.0);
  const std::uint32_t bits = rng.next_u32();
  if (sort == 0) return kMiss;
  if (sort == 1) return kUnknown;
  if (sort == 2) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  if (sort == 3) return static_cast<float>(metres);
  return static_cast<float>(std::floor(metres * 1000.0) * 0.001);
}

inline Stamp random_stamp(Rng& rng, Stamp now) {
  if (rng.below(50) == 0) return Stamp::never();
  return {now.ns - static_cast<std::int64_t>(rng.below(200000000))};
}

/// A tick that no real robot would deliver, but the types allow.
inline Inputs random_inputs(Rng& rng, Stamp now) {
  Inputs inputs;
  inputs.now = now;
  inputs.scans.resize(rng.below(3));
  for (LaserScan& scan : inputs.scans) {
    scan.stamp = random_stamp(rng, now);
    for (double* value : {&scan.angle_min, &scan.angle_step, &scan.beam_period, &scan.range_min, &scan.range_max})
      *value = random_double(rng);
    const std::uint32_t beams = rng.below(4) == 0 ? rng.below(3) : rng.below(700);
    for (std::uint32_t i = 0; i < beams; ++i) scan.ranges.push_back(random_range(rng));
    if (rng.below(2) == 0) inputs.scans.front().angle_min = 1.0;
  }
  inputs.odometry.resize(rng.below(3));
  for (Odometry& o : inputs.odometry) {
    o.stamp = random_stamp(rng, now);
    for (double* value : {&o.pose.x, &o.pose.y, &o.pose.phi, &o.v, &o.w}) *value = random_double(rng);
    o.stalled = rng.below(2) == 1;
  }
  inputs.accelerations.resize(rng.below(4));
  for (Acceleration& a : inputs.accelerations) {
    a.stamp = random_stamp(rng, now);
    a.x = random_double(rng);
    a.y = random_double(rng);
  }
  inputs.aims.resize(rng.below(3));
  for (AimState& a : inputs.aims) {
    a.stamp = random_stamp(rng, now);
    a.pitch = random_double(rng);
    a.roll = random_double(rng);
  }
  inputs.cues.resize(rng.below(2));
  for (VictimCue& c : inputs.cues) {
    c.stamp = random_stamp(rng, now);
    c.kind = static_cast<CueKind>(rng.below(4));
    for (double* value : {&c.bearing, &c.range, &c.confidence}) *value = random_double(rng);
  }
  return inputs;
}

inline std::vector<Inputs> random_ticks(Rng& rng, std::size_t count) {
  std::vector<Inputs> ticks;
  Stamp now{static_cast<std::int64_t>(rng.below(1000000)) * 1000000};
  for (std::size_t i = 0; i < count; ++i) {
    now.ns += static_cast<std::int64_t>(rng.below(100000000));
    ticks.push_back(random_inputs(rng, now));
  }
  return ticks;
}

inline Commands random_commands(Rng& rng) {
  Commands commands;
  for (double* value : {&commands.drive.v, &commands.drive.w, &commands.aim.pitch, &commands.aim.roll})
    *value = random_double(rng);
  return commands;
}

/// What a URG-04LX in the middle of a room of half width `half` sees from (x, y, phi) without noise, in whole mm.
inline LaserScan room_scan(Stamp stamp, double x, double y, double phi, double half, const LaserModel& laser) {
  LaserScan scan;
  scan.stamp = stamp;
  set_geometry(scan, laser);
  for (int i = 0; i < laser.beams; ++i) {
    const double bearing = phi + scan.bearing(static_cast<std::size_t>(i));
    const double c = std::cos(bearing);
    const double s = std::sin(bearing);
    const double to_x = c > 0 ? (half - x) / c : (c < 0 ? (-half - x) / c : 1e9);
    const double to_y = s > 0 ? (half - y) / s : (s < 0 ? (-half - y) / s : 1e9);
    const double mm = std::round(std::min(to_x, to_y) * 1000.0);
    scan.ranges.push_back(mm * 0.001 > laser.range_max ? kMiss : static_cast<float>(mm * 0.001));
  }
  return scan;
}

/// What() of the exception of type E that `work` throws; a failure when it throws none.
template <class E, class Work>
std::string message_of(Work&& work) {
  try {
    work();
  } catch (const E& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

}  // namespace rubble::robot::testing
