#include "scenarios/run/core.h"

#include <utility>

namespace rubble::scenarios {
namespace {

constexpr double kAreaPeriod = 5.0;  ///< the known area is measured this often [s]

}  // namespace

double known_area(const slam::CountMap& map) {
  std::size_t cells = 0;
  for (int y = 0; y < map.frame().height; ++y) {
    const std::uint16_t* seen = map.seen_row(y);
    for (int x = 0; x < map.frame().width; ++x) cells += seen[x] != 0 ? 1u : 0u;
  }
  return static_cast<double>(cells) * map.frame().resolution * map.frame().resolution;
}

Core::Core(const Scenario& scenario, const robot::RobotModel& model, bool explore, const std::string& run_folder,
           std::shared_ptr<const slam::MapBase> base)
    : mapper_(scenario.mapper.make(model, {scenario.seed, run_folder, std::move(base)})),
      levelling_(scenario.levelling, model) {
  if (explore) explorer_ = scenario.explorer.make(model, {scenario.time_limit});
}

robot::Commands Core::step(const robot::Inputs& inputs) {
  mapper_->update(inputs);
  watch(inputs);
  robot::Commands commands;
  if (explorer_) commands = explorer_->next(*mapper_, inputs);
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
  const double time = inputs.now - first_;
  if (!explorer_ || (!known_.empty() && time < known_.back().time + kAreaPeriod)) return;
  known_.push_back({time, known_area(mapper_->map())});
}

double Core::area_per_minute() const {
  if (known_.empty()) return 0.0;
  const double most = known_.back().area;
  for (const KnownArea& at : known_)
    if (at.area >= 0.95 * most && at.time > 0.0) return at.area / (at.time / 60.0);
  return 0.0;
}

std::vector<explore::VictimReport> Core::victims() const {
  return explorer_ ? explorer_->victims() : std::vector<explore::VictimReport>();
}

}  // namespace rubble::scenarios
