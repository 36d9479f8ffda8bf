#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/stamp.h"
#include "robot/commands.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// Whether scans that come in time show anything to drive by: a scanner that is covered sends scans without one range
/// (or with that of its cover only), one that hangs sends the same one for ever. Where walls are out of reach for all
/// beams at once it is the same to a robot: nothing shows what it drives into. May be asked by several threads.
class ScanWatch {
 public:
  static constexpr double kBlind = 1.0;        ///< so long no beam of any scan gives a range beyond kCover [s]
  static constexpr double kCover = 0.15;       ///< no robot is so small that all its beams end so near [m]
  static constexpr double kRepeats = 2.0;      ///< so long the same scan comes again [s]
  static constexpr double kRepeatsSoon = 0.5;  ///< the same while the wheels go by kMoved [s]
  static constexpr Drive kMoved{0.1, 0.1};     ///< [m], [rad]
  static constexpr int kEnough = 30;           ///< beams with a range: fewer may well give the same again
  static constexpr int kScans = 4;             ///< so many scans at least tell

  /// A scan that came at `now`.
  void see(const LaserScan& scan, Stamp now);
  /// What the wheels reported.
  void look(const std::vector<Odometry>& reports);

  /// What is wrong with the scans, in words; empty: nothing. Once something was, they must be well for a while
  /// (kKeepsUp).
  std::string trouble() const;
  bool is_well() const;

 private:
  enum class Kind { Well, Blind, Repeats };
  Kind kind_of(Stamp now) const;

  mutable std::mutex mutex_;
  std::vector<float> ranges_;  ///< of the last scan
  Stamp blind_since_ = Stamp::never();
  int blind_scans_ = 0;  ///< in a row
  Stamp same_since_ = Stamp::never();
  int same_scans_ = 0;            ///< in a row, the first one not counted
  Drive gone_;                    ///< by the wheels, since then [m], [rad]
  std::optional<Odometry> last_;  ///< report
  Kind trouble_ = Kind::Well;
  Stamp wrong_at_ = Stamp::never();  ///< last
};

}  // namespace rubble::robot
