#include "sim/sim_robot.h"

#include "sim/body/world.h"
#include "sim/rig.h"

namespace rubble::sim {

const std::vector<std::string>& levelling_faults() {
  static const std::vector<std::string> names = {"none", "silent", "no_accelerometer", "jammed"};
  return names;
}

struct SimRobot::Impl {
  Impl(const arenas::Arena& arena, const robot::RobotModel& model, const SimConfig& sim_config, std::uint64_t seed)
      : config(sim_config),
        world(arena, model, ServoParameters{}, config.physics_step),
        rig(arena, model, config, world, 0, seed) {}

  SimConfig config;
  World world;
  Rig rig;
  Stamp now;
};

SimRobot::SimRobot(const arenas::Arena& arena, const robot::RobotModel& model, const SimConfig& config,
                   std::uint64_t seed) {
  check_step(config, model);
  impl_ = std::make_unique<Impl>(arena, model, config, seed);
}

SimRobot::~SimRobot() = default;

const robot::RobotModel& SimRobot::model() const { return impl_->rig.model(); }

std::optional<robot::Inputs> SimRobot::read() {
  Impl& sim = *impl_;
  const Stamp end = sim.now + sim.rig.model().tick;
  if (end > Stamp::from_seconds(sim.config.time_limit)) return std::nullopt;
  robot::Inputs inputs;
  if (sim.now.ns == 0) sim.rig.measure(sim.world, inputs);  // the first odometry report is about the start
  while (sim.world.state().stamp < end) {
    sim.world.step();
    sim.rig.follow(sim.world, inputs);
  }
  sim.now = end;
  sim.rig.finish(end, sim.world, inputs);
  return inputs;
}

void SimRobot::command(const robot::Commands& commands) { impl_->rig.command(commands, impl_->world); }

void SimRobot::place(const mrpt::math::TPose2D& T_arena_base) { impl_->world.place(T_arena_base); }

const Trajectory& SimRobot::truth() const { return impl_->rig.truth(); }

std::vector<arenas::PaperBall> SimRobot::balls() const { return impl_->world.balls(); }

std::vector<arenas::LooseObject> SimRobot::objects() const { return impl_->world.objects(); }

}  // namespace rubble::sim
