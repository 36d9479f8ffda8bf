#include "scenarios/run/core.h"

#include <algorithm>
#include <utility>

#include "robot/beam_order.h"

namespace rubble::scenarios {
namespace {

constexpr double kNoted = 5.0;     ///< what is known is noted this often [s]
constexpr double kPatient = 10.0;  ///< from the first scan on; our own mappers take less to map one [s]

}  // namespace

double known_area(const slam::CountMap& map) {
  std::size_t cells = 0;
  for (int y = 0; y < map.frame().height; ++y)
    map.for_seen(y, 0, map.frame().width, [&](int, int count, const std::uint16_t* seen, const std::uint16_t*) {
      for (int i = 0; i < count; ++i) cells += seen[i] != 0 ? 1u : 0u;
    });
  return static_cast<double>(cells) * map.frame().resolution * map.frame().resolution;
}

explore::Mission mission_of(const Scenario& scenario) {
  return {scenario.time_limit, {scenario.sim.microphones, scenario.sim.co2_probe}};
}

Core::Core(const Scenario& scenario, const robot::RobotModel& model, bool explore, const std::string& run_folder,
           std::shared_ptr<const slam::MapBase> base)
    : mapper_(scenario.mapper.make(robot::counter_clockwise(model), {scenario.seed, run_folder, std::move(base)})),
      levelling_(scenario.levelling, model) {
  if (explore) explorer_ = scenario.explorer.make(model, mission_of(scenario));
}

robot::Commands Core::step(const robot::Inputs& inputs) {
  if (std::any_of(inputs.scans.begin(), inputs.scans.end(), robot::is_clockwise))
    return step(robot::counter_clockwise(inputs));
  mapper_->update(inputs);
  watch(inputs);
  robot::Commands commands;
  if (explorer_) {
    commands = explorer_->next(*mapper_, inputs);
    withdrawn_.note(explorer_->victims());
  }
  commands.aim = levelling_.update(inputs);
  return commands;
}

/// Keeps what only the running core sees of a mission.
void Core::watch(const robot::Inputs& inputs) {
  for (const robot::Odometry& odometry : inputs.odometry) {
    stalls_ += odometry.stalled && !stalled_ ? 1 : 0;
    stalled_ = odometry.stalled;
  }
  if (first_ == Stamp::never()) first_ = inputs.now;
  if (!explorer_) return;
  if (first_scan_ == Stamp::never() && !inputs.scans.empty()) first_scan_ = inputs.now;
  if (!waits_ && first_scan_ != Stamp::never() && inputs.now - first_scan_ >= kPatient && mapper_->counts().mapped == 0)
    waits_ = {inputs.now,
              "waits for the mapper: it has mapped no scan yet (answers `mapped N`, docs/mapper_protocol.md)"};
  if (inputs.now < next_noted_) return;
  next_noted_ = inputs.now + kNoted;
  first_seen_.note(mapper_->map(), inputs.now - first_);
}

std::vector<explore::VictimReport> Core::victims() const {
  return explorer_ ? explorer_->victims() : std::vector<explore::VictimReport>();
}

}  // namespace rubble::scenarios
