#include "sim/sim_robot.h"

#include <cmath>
#include <deque>

#include "sim/accelerometer.h"
#include "sim/laser.h"
#include "sim/victim_sensor.h"
#include "sim/world.h"

namespace rubble::sim {
namespace {

/// Something that happens every `period`, counted in nanoseconds so that it never drifts.
struct Clock {
  explicit Clock(double period, double offset = 0.0)
      : period_ns(Stamp::from_seconds(period).ns), next(Stamp::from_seconds(offset)) {}
  bool due(Stamp now) const { return next <= now; }
  void advance() { next.ns += period_ns; }
  std::int64_t period_ns;
  Stamp next;
};

AccelerometerParameters accelerometer_parameters(const SimConfig& config) {
  AccelerometerParameters parameters;
  parameters.mount = config.accelerometer_mount;
  return parameters;
}

}  // namespace

struct SimRobot::Impl {
  Impl(const arenas::Arena& arena, const robot::RobotModel& robot_model, const SimConfig& sim_config,
       std::uint64_t seed)
      : model(robot_model),
        config(sim_config),
        world(arena, model, ServoParameters{}, config.physics_step),
        laser(arena, model, config.range_noise, config.sweep, seed),
        accelerometer(model, accelerometer_parameters(config), config.acceleration_noise, seed),
        victims(arena.victims, VictimSensorParameters{}, seed),
        odometry_clock(model.odometry_period),
        unit_clock(model.acceleration_period, model.acceleration_period),
        victim_clock(victims.period()),
        rotor_clock(model.laser.scan_period) {
    states.push_back(world.state());
    truth.push_back({Stamp{}, world.state().pose});
  }

  /// Keeps the states that the sweep in progress, or the next, can need.
  void forget_old_states() {
    const Stamp needed = rotor_clock.next + laser.times().first_beam;
    while (states.size() > 2 && states[1].stamp <= needed) states.erase(states.begin());
  }

  void measure(robot::Inputs& inputs) {
    const WorldState& state = world.state();
    if (odometry_clock.due(state.stamp)) {
      inputs.odometry.push_back(world.firmware().reckon(state.stamp));
      odometry_clock.advance();
    }
    if (model.has_levelling_unit && unit_clock.due(state.stamp)) {
      inputs.accelerations.push_back(accelerometer.sample(state.stamp));
      const robot::LaserAim pulses = world.servos().pulses();
      inputs.aims.push_back({state.stamp, pulses.pitch, pulses.roll});
      unit_clock.advance();
    }
    if (victim_clock.due(state.stamp)) {
      for (const robot::VictimCue& cue : victims.look(state, laser.walk())) inputs.cues.push_back(cue);
      victim_clock.advance();
    }
    if (rotor_clock.due(state.stamp - laser.times().sent)) {
      inputs.scans.push_back(
          laser.scan(rotor_clock.next + laser.times().first_beam, states, world.clutter().spheres()));
      rotor_clock.advance();
      forget_old_states();
    }
  }

  robot::RobotModel model;
  SimConfig config;
  World world;
  Laser laser;
  Accelerometer accelerometer;
  VictimSensor victims;
  Clock odometry_clock;
  Clock unit_clock;
  Clock victim_clock;
  Clock rotor_clock;  ///< next: the zero of the sweep that is delivered next
  std::vector<WorldState> states;
  Trajectory truth;
  Stamp now;
};

SimRobot::SimRobot(const arenas::Arena& arena, const robot::RobotModel& model, const SimConfig& config,
                   std::uint64_t seed)
    : impl_(std::make_unique<Impl>(arena, model, config, seed)) {}

SimRobot::~SimRobot() = default;

const robot::RobotModel& SimRobot::model() const { return impl_->model; }

std::optional<robot::Inputs> SimRobot::read() {
  Impl& sim = *impl_;
  const Stamp end = sim.now + sim.model.tick;
  if (end > Stamp::from_seconds(sim.config.time_limit)) return std::nullopt;
  robot::Inputs inputs;
  if (sim.now.ns == 0) sim.measure(inputs);  // the first odometry report is about the start
  while (sim.world.state().stamp < end) {
    sim.world.step();
    sim.states.push_back(sim.world.state());
    if (sim.model.has_levelling_unit) sim.accelerometer.step(sim.world.state(), sim.config.physics_step);
    sim.measure(inputs);
  }
  sim.now = end;
  inputs.now = end;
  sim.truth.push_back({end, sim.world.state().pose});
  return inputs;
}

void SimRobot::command(const robot::Commands& commands) {
  impl_->world.firmware().command(commands.drive);
  if (impl_->model.has_levelling_unit) impl_->world.servos().command(commands.aim);
}

const Trajectory& SimRobot::truth() const { return impl_->truth; }

std::vector<arenas::PaperBall> SimRobot::balls() const { return impl_->world.clutter().balls(); }

}  // namespace rubble::sim
