#include "scenarios/run/core.h"

namespace rubble::scenarios {

Core::Core(const Scenario& scenario, const robot::RobotModel& model, bool explore)
    : mapper_(scenario.mapper.make(model, scenario.seed)), levelling_(scenario.levelling, model.accelerometer_mount) {
  if (explore) explorer_.emplace(model, scenario.explorer);
}

robot::Commands Core::step(const robot::Inputs& inputs) {
  mapper_->update(inputs);
  robot::Commands commands;
  if (explorer_) commands = explorer_->next(*mapper_, inputs);
  commands.aim = levelling_.update(inputs);
  return commands;
}

std::vector<explore::VictimReport> Core::victims() const {
  return explorer_ ? explorer_->victims() : std::vector<explore::VictimReport>();
}

}  // namespace rubble::scenarios
