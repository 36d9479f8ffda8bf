#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "explore/explorer.h"
#include "robot/levelling.h"
#include "robot/robot.h"
#include "scenarios/config/scenario.h"
#include "scenarios/run/first_seen.h"
#include "scenarios/run/withdrawn_victims.h"
#include "slam/map_base.h"
#include "slam/mapper.h"

namespace rubble::scenarios {

/// What a scenario asks of an explorer.
explore::Mission mission_of(const Scenario& scenario);

/// What drives a robot, whichever it is: mapper, levelling and (when asked to explore) explorer. It sees Inputs only.
class Core {
 public:
  /// `run_folder`: takes what the mapper writes itself (mapper.log). `base`: a map to go on with; null: an empty one.
  Core(const Scenario& scenario, const robot::RobotModel& model, bool explore, const std::string& run_folder,
       std::shared_ptr<const slam::MapBase> base = nullptr);

  /// Digests one tick and decides the commands for the next. Scans that run clockwise are turned round here: whatever
  /// comes behind takes them to be as LaserScan says.
  robot::Commands step(const robot::Inputs& inputs);

  const slam::Mapper& mapper() const { return *mapper_; }
  /// The robot says no more: the mapper ends what it put off.
  void finish() { mapper_->finish(); }
  bool finished() const { return explorer_ && explorer_->finished(); }
  /// Why the explorer finished; empty before.
  std::string reason() const { return explorer_ ? explorer_->reason() : std::string(); }
  std::vector<explore::VictimReport> victims() const;
  /// How often the motors reported a stall that was not reported before.
  int stalls() const { return stalls_; }
  /// How many victims it was sure of and later no more, under no number (WithdrawnVictims).
  int victims_withdrawn() const { return withdrawn_.count(); }
  /// When which place was mapped, while it explored [s since the first tick].
  const FirstSeen& first_seen() const { return first_seen_; }
  /// What the robot waited for in vain while it should explore; nothing: it has not had to wait long.
  const std::optional<explore::Decision>& waits() const { return waits_; }
  /// Null when only mapping.
  const explore::Explorer* explorer() const { return explorer_.get(); }

 private:
  std::unique_ptr<slam::Mapper> mapper_;
  robot::Levelling levelling_;
  void watch(const robot::Inputs& inputs);

  WithdrawnVictims withdrawn_;
  int stalls_ = 0;
  bool stalled_ = false;
  Stamp first_ = Stamp::never();
  FirstSeen first_seen_;
  Stamp next_noted_ = Stamp::never();
  Stamp first_scan_ = Stamp::never();
  std::optional<explore::Decision> waits_;
  std::unique_ptr<explore::Explorer> explorer_;  ///< null: only mapping
};

/// Area of which the map knows something [m^2].
double known_area(const slam::CountMap& map);

}  // namespace rubble::scenarios
