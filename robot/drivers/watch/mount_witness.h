#pragma once

#include <mrpt/math/TPose2D.h>

#include <deque>
#include <optional>
#include <string>

#include "base/stamp.h"
#include "robot/drivers/hindrance.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// Holds the way that wheels report against the way that scans show, to find out a robot file that is not of this
/// robot: a scanner that looks elsewhere or hangs upside down, wheels of another size or track. Also wheels that turn
/// while the scanner stands: right behind a break of the line they may be those of another robot.
///
/// Slip is none of it, though scans show less than wheels then: what slips does so now and then, and by another share
/// each time. Where no wall is in reach, or all look alike, nothing is said.
class MountWitness {
 public:
  static constexpr int kVotes = 3;               ///< so many stretches in a row tell of a mount
  static constexpr std::size_t kScaleVotes = 6;  ///< of a scale; twice as many where it may be slip
  static constexpr double kScale = 1.6;          ///< is more than floors and tyres explain, either way
  static constexpr double kForget = 30.0;        ///< a vote counts no longer, nor does a break of the line [s]
  static constexpr double kForgetWay = 60.0;     ///< the same of ways and scales: who turns to and fro goes little [s]
  static constexpr double kSoon = 0.15;        ///< a scanner that clearly looks back is told by such a way already [m]
  static constexpr double kWay = 0.25;         ///< of a stretch, by the wheels [m] ...
  static constexpr double kTurn = 0.35;        ///< ... or [rad]
  static constexpr double kLongestTime = 8.0;  ///< of a stretch [s]

  /// `T_base_laser`: where the scanner sits by the robot file.
  explicit MountWitness(const mrpt::math::TPose2D& T_base_laser) : T_base_laser_(T_base_laser) {}

  /// A report that came at `now`; some take milliseconds.
  void look(const Odometry& odometry, Stamp now);
  /// A scan that came at `now`.
  void see(const LaserScan& scan, Stamp now);
  /// The line to the base broke and is there again: it may lead to another one.
  void broke(Stamp now) { broke_ = now; }
  /// All that was seen counts no longer; that the line broke does.
  void clear();

  /// What is wrong, and of which device; nothing: the robot is as its file says. Stays until clear().
  const std::optional<Hindrance>& finding() const { return finding_; }
  /// That is that the wheels seem to be another robot's.
  bool is_other() const { return is_other_; }

 private:
  /// Where a stretch begins.
  struct Begin {
    LaserScan scan;
    mrpt::math::TPose2D pose;  ///< of the wheels
    Stamp when;
    bool looked = false;       ///< once at the scans: they showed a robot that stood
    bool looked_soon = false;  ///< after kSoon
  };
  struct Vote {
    Stamp when;
    double value = 0.0;
  };

  void step(const LaserScan& scan, const mrpt::math::TPose2D& pose, Stamp now);
  bool judge(const Begin& begin, const LaserScan& scan, const mrpt::math::TPose2D& motion, Stamp now);
  bool judge_way(const Begin& begin, const LaserScan& scan, const mrpt::math::TPose2D& motion, Stamp now);
  bool judge_soon(const Begin& begin, const LaserScan& scan, const mrpt::math::TPose2D& motion, Stamp now);
  void vote_elsewhere(double aside, double ahead, Stamp now);
  bool judge_turn(const Begin& begin, const LaserScan& scan, const mrpt::math::TPose2D& motion, Stamp now);
  bool judge_standing(const Begin& begin, const mrpt::math::TPose2D& motion, Stamp now);
  void judge_scale(std::deque<Vote>& ratios, double ratio, bool turns, Stamp now);
  bool doubted(Stamp now) const { return broke_ != Stamp::never() && now - broke_ <= kForget; }
  void vote(std::deque<Vote>& votes, double value, Stamp now) const;
  void find(const char* name, const char* format, double a, double b = 0.0);

  mrpt::math::TPose2D T_base_laser_;
  std::deque<Odometry> reports_;  ///< of the last second
  std::optional<LaserScan> waiting_;
  std::optional<Begin> begin_;
  std::deque<Vote> ways_;         ///< into which scans show it to go instead of ahead [rad]
  std::deque<Vote> turns_;        ///< seen the other way round
  std::deque<Vote> stands_;       ///< while the wheels turn
  std::deque<Vote> way_ratios_;   ///< seen to reported
  std::deque<Vote> turn_ratios_;  ///< the same
  Stamp broke_ = Stamp::never();
  std::optional<Hindrance> finding_;
  bool is_other_ = false;
};

}  // namespace rubble::robot
