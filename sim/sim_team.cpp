#include "sim/sim_team.h"

#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "base/error.h"
#include "sim/body/world.h"
#include "sim/rig.h"

namespace rubble::sim {
namespace {

void check_team(const std::vector<TeamMember>& members, const SimConfig& config) {
  if (members.empty()) throw InputError("sim: a team needs at least one robot");
  for (std::size_t i = 0; i < members.size(); ++i) {
    check_step(config, members[i].model);
    if (members[i].model.tick != members[0].model.tick) {
      throw InputError("sim: robot " + std::to_string(i + 1) + " of the team has a tick of its own; give all the same");
    }
    for (std::size_t k = 0; k < i; ++k) {
      const double dx = members[i].start.x - members[k].start.x;
      const double dy = members[i].start.y - members[k].start.y;
      if (std::hypot(dx, dy) > members[i].model.swing_radius() + members[k].model.swing_radius()) continue;
      throw InputError("sim: robots " + std::to_string(k + 1) + " and " + std::to_string(i + 1) +
                       " of the team start in one place; move one of them");
    }
  }
}

std::vector<Entrant> entrants_of(const std::vector<TeamMember>& members) {
  std::vector<Entrant> entrants;
  for (const TeamMember& member : members) entrants.push_back({member.model, ServoParameters{}, member.start});
  return entrants;
}

}  // namespace

class SimTeam::Member : public robot::Robot {
 public:
  Member(Impl& team, std::size_t index) : team_(team), index_(index) {}
  const robot::RobotModel& model() const override;
  std::optional<robot::Inputs> read() override;
  void command(const robot::Commands& commands) override;

 private:
  Impl& team_;
  std::size_t index_;
};

struct SimTeam::Impl {
  Impl(const arenas::Arena& arena, const std::vector<TeamMember>& members, const SimConfig& sim_config,
       std::uint64_t seed)
      : config(sim_config), world(arena, entrants_of(members), config.physics_step), waiting(members.size()) {
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::uint64_t own_seed = seed + i * 0x9E3779B97F4A7C15ull;
      rigs.push_back(std::make_unique<Rig>(arena, members[i].model, config, world, i, own_seed));
      robots.push_back(std::make_unique<Member>(*this, i));
    }
  }

  /// One tick for all; false: the time is over.
  bool advance() {
    const Stamp end = now + rigs[0]->model().tick;
    if (end > Stamp::from_seconds(config.time_limit)) return false;
    std::vector<robot::Inputs> inputs(rigs.size());
    for (std::size_t i = 0; now.ns == 0 && i < rigs.size(); ++i) rigs[i]->measure(world, inputs[i]);
    while (world.state().stamp < end) {
      world.step();
      for (std::size_t i = 0; i < rigs.size(); ++i) rigs[i]->follow(world, inputs[i]);
    }
    now = end;
    for (std::size_t i = 0; i < rigs.size(); ++i) {
      rigs[i]->finish(end, world, inputs[i]);
      waiting[i].push_back(std::move(inputs[i]));
    }
    return true;
  }

  SimConfig config;
  World world;
  std::vector<std::unique_ptr<Rig>> rigs;
  std::vector<std::unique_ptr<Member>> robots;
  std::vector<std::deque<robot::Inputs>> waiting;  ///< ticks a robot has not read yet
  Stamp now;
};

const robot::RobotModel& SimTeam::Member::model() const { return team_.rigs[index_]->model(); }

std::optional<robot::Inputs> SimTeam::Member::read() {
  std::deque<robot::Inputs>& waiting = team_.waiting[index_];
  if (waiting.empty() && !team_.advance()) return std::nullopt;
  robot::Inputs inputs = std::move(waiting.front());
  waiting.pop_front();
  return inputs;
}

void SimTeam::Member::command(const robot::Commands& commands) { team_.rigs[index_]->command(commands, team_.world); }

SimTeam::SimTeam(const arenas::Arena& arena, const std::vector<TeamMember>& members, const SimConfig& config,
                 std::uint64_t seed) {
  check_team(members, config);
  impl_ = std::make_unique<Impl>(arena, members, config, seed);
}

SimTeam::~SimTeam() = default;

std::size_t SimTeam::size() const { return impl_->rigs.size(); }

robot::Robot& SimTeam::robot(std::size_t i) { return *impl_->robots.at(i); }

const Trajectory& SimTeam::truth(std::size_t i) const { return impl_->rigs.at(i)->truth(); }

}  // namespace rubble::sim
