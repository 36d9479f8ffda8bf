#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/trajectory.h"
#include "robot/robot.h"

namespace rubble::robot {

/// What the head of a log says about its origin.
struct LogHeader {
  RobotModel model;
  std::string note;  ///< free text, e.g. the resolved scenario
};

/// Wraps any robot and writes everything it reads and is commanded to an append-only log that survives a kill:
/// whole checked frames, handed to the system each second of log time; a torn last frame is dropped on reading.
/// An existing file is replaced. docs/robot.md describes the format. read() and flush() throw RunError that names
/// the path when nothing more can be written.
class RecordingRobot : public Robot {
 public:
  /// Throws RunError when `path` cannot be written.
  RecordingRobot(Robot& inner, const std::string& path, const std::string& note);
  ~RecordingRobot() override;
  const RobotModel& model() const override;
  std::optional<Inputs> read() override;
  void command(const Commands& commands) override;
  /// Writes out what is buffered. The destructor does so too, but cannot report a full disk: call this at the end.
  void flush();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Plays a log back, tick by tick; commands go nowhere. Formats by content: our own log, MRPT .rawlog (observation-only
/// and action/frame form), CARMEN .log (FLASER, ROBOTLASER1, ODOM), CoreSLAM .dat; each packed
/// with gzip or bzip2, or not.
class ReplayRobot : public Robot {
 public:
  /// Throws InputError with place and remedy: missing, unknown format, wrong line, cut in the middle (foreign formats).
  explicit ReplayRobot(const std::string& path);
  ~ReplayRobot() override;
  const RobotModel& model() const override;
  std::optional<Inputs> read() override;
  void command(const Commands& commands) override;

  /// "rubble log", "CARMEN log", ...
  const std::string& format() const;
  /// The note of our own log; empty for others.
  const std::string& note() const;
  /// The command in force after the tick that read() returned last: the answer to it (our own log only; else zero).
  const Commands& recorded_commands() const;
  /// T_map_base that came with the log (CARMEN: corrected poses; MRPT: `.GT.txt` beside it); empty when there are none.
  const Trajectory& reference() const;
  /// The trajectory of its scans under the stamps the log itself gives them, by which relations and other programs know
  /// them. Only CARMEN logs whose clock jitters are delivered with others; sorted, of equal stamps the first.
  Trajectory in_own_stamps(const Trajectory& trajectory) const;
  /// The same of one scan's stamp; one that no scan was delivered with stays.
  Stamp own_stamp(Stamp delivered) const;
  /// What was assumed where a log of others says nothing, or contradicts itself: a line each, with the path.
  const std::vector<std::string>& notes() const;
  /// True when a torn last frame of our own log was dropped.
  bool was_torn() const;
  /// Share of the log played so far, 0..1.
  double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::robot
