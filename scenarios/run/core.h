#pragma once

#include <memory>
#include <optional>

#include "explore/explorer.h"
#include "robot/levelling.h"
#include "robot/robot.h"
#include "scenarios/config/scenario.h"
#include "slam/mapper.h"

namespace rubble::scenarios {

/// What drives a robot, whichever it is: mapper, levelling and (when asked to explore) explorer. It sees Inputs only.
class Core {
 public:
  Core(const Scenario& scenario, const robot::RobotModel& model, bool explore);

  /// Digests one tick and decides the commands for the next.
  robot::Commands step(const robot::Inputs& inputs);

  const slam::Mapper& mapper() const { return *mapper_; }
  /// The robot says no more: the mapper ends what it put off.
  void finish() { mapper_->finish(); }
  bool finished() const { return explorer_ && explorer_->finished(); }
  /// Why the explorer finished; empty before.
  std::string reason() const { return explorer_ ? explorer_->reason() : std::string(); }
  std::vector<explore::VictimReport> victims() const;
  /// Null when it was not asked to explore.
  const explore::Explorer* explorer() const { return explorer_ ? &*explorer_ : nullptr; }

 private:
  std::unique_ptr<slam::Mapper> mapper_;
  robot::Levelling levelling_;
  std::optional<explore::Explorer> explorer_;
};

}  // namespace rubble::scenarios
