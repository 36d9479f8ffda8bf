#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

#include "base/stamp.h"
#include "explore/victim_report.h"
#include "robot/commands.h"
#include "robot/measurements.h"
#include "slam/mapper.h"

namespace rubble::explore {

enum class ExplorerState { Starting, Driving, Searching, BackingUp, GoingHome, Finished };

/// How a mission ended: still under way; nothing left to do; the same, or time running out, and back at the start; held
/// by something with every way out tried.
enum class MissionEnd { UnderWay, Explored, Home, Stuck };

/// Which senses for victims a robot has beside its cameras.
struct OtherSenses {
  bool microphones = false;
  bool co2_probe = false;
};

/// What the mission's frame asks of an explorer.
struct Mission {
  double time_limit = 0.0;  ///< from the first tick [s]; 0: none
  OtherSenses senses{};     ///< fitted
};

/// Why the explorer did what it did, one line.
struct Decision {
  Stamp stamp;
  std::string why;
};

/// Decides where to drive, from what a mapper knows and what the robot measured.
///
/// What an explorer promises:
/// - `next` is called once a tick, after the mapper has seen the same inputs, always with the same mapper. The answer
///   holds for the tick to come; its laser aim is zero, for levelling owns the laser.
/// - It asks for no motion while it cannot see: before the first mapped scan and while the scanner is silent.
/// - Deterministic: same robot, parameters and inputs give the same commands. It reads no clock but the inputs' and
///   knows nothing of the truth; simulated, replayed and real robots look the same.
/// - It accepts anything a mapper and a robot may deliver; poor data make a poor mission, never an exception.
/// - Once finished it stays finished, asks for no motion, and `reason` says in a few words why.
/// - Everything may be asked at any time; references stay valid, and what they show unchanged, until the next `next`.
class Explorer {
 public:
  virtual ~Explorer() = default;

  /// The command for the tick to come.
  virtual robot::Commands next(const slam::Mapper& mapper, const robot::Inputs& inputs) = 0;

  virtual bool finished() const = 0;
  /// Why it finished, for people; empty while it runs.
  virtual const std::string& reason() const = 0;
  virtual MissionEnd end() const = 0;
  virtual ExplorerState state() const = 0;
  /// All decisions so far, in order.
  virtual const std::vector<Decision>& decisions() const = 0;
  /// The path being followed, map frame, robot first.
  virtual const std::vector<mrpt::math::TPoint2D>& path() const = 0;
  /// The victims it is sure of, by id.
  virtual const std::vector<VictimReport>& victims() const = 0;
  /// Whether the victim sensors have looked at the floor at a place [map frame, m].
  virtual bool searched(const mrpt::math::TPoint2D& place) const { return static_cast<void>(place), false; }
  /// What it keeps of a mission's time for the way home, beside what the way itself takes: a time limit that is not
  /// longer explores nothing. 0: it does not drive home [s].
  virtual double time_for_home() const { return 0.0; }
};

}  // namespace rubble::explore
