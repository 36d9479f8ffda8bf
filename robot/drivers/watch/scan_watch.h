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
/// beams at once it is the same to a robot: nothing shows what it drives into. But walls that go out of reach do so at
/// the edge of it, or of what the scanner looks at, and leave no echo; and the ground up to that edge was seen to be
/// free. May be asked by several threads.
class ScanWatch {
 public:
  static constexpr double kBlind = 1.0;        ///< so long no beam of any scan gives a range beyond kCover [s]
  static constexpr double kCover = 0.15;       ///< no robot is so small that all its beams end so near [m]
  static constexpr double kRepeats = 2.0;      ///< so long the same scan comes again [s]
  static constexpr double kRepeatsSoon = 0.5;  ///< the same while the wheels go by kMoved [s]
  static constexpr Drive kMoved{0.1, 0.1};     ///< [m], [rad]
  static constexpr int kEnough = 30;           ///< beams with a range: fewer may well give the same again
  static constexpr int kScans = 4;             ///< so many scans at least tell
  static constexpr std::size_t kFew = 5;       ///< so many beams are no wall that must be seen
  static constexpr double kEdge = 0.4;         ///< of the range: nearer walls do not go out of reach at once [m] ...
  static constexpr double kEdgeAngle = 0.26;   ///< ... nor do those farther within what it looks at [rad]
  static constexpr double kNoEchoShare = 0.9;  ///< so many beams without an echo are an empty hall

  /// When a scanner that sees nothing holds the robot.
  struct Settings {
    bool nothing_holds = true;  ///< it does; else it is only named
    double nothing_way = 8.0;   ///< so far the wheels may go where the walls went out of reach [m]
  };

  explicit ScanWatch(const Settings& settings) : settings_(settings) {}
  ScanWatch() : ScanWatch(Settings()) {}

  /// A scan that came at `now`.
  void see(const LaserScan& scan, Stamp now);
  /// What the wheels reported.
  void look(const std::vector<Odometry>& reports);

  /// What is wrong with the scans, in words; empty: nothing. Once something was, they must be well for a while
  /// (kKeepsUp).
  std::string trouble() const;
  bool is_well() const;
  /// Nothing may be driven by what it shows.
  bool holds() const;

 private:
  enum class Kind { Well, Blind, Repeats };
  Kind kind_of(Stamp now) const;
  void mind_walls(const LaserScan& scan, std::size_t ranges);

  mutable std::mutex mutex_;
  std::vector<float> ranges_;  ///< of the last scan
  const Settings settings_;
  std::size_t walls_ = kFew;  ///< beams of the last scan that showed some which the next one must show too
  bool seen_ = false;         ///< there was such a scan
  bool no_echo_ = false;      ///< the last scan has none of almost all beams
  double unseen_way_ = 0.0;   ///< gone by the wheels since something was seen [m]
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
