#include "sim/rig.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "sim/body/world.h"

namespace rubble::sim {
namespace {

VictimSensorParameters victim_parameters(const SimConfig& config) {
  VictimSensorParameters parameters;
  parameters.sound.fitted = config.microphones;
  parameters.co2.fitted = config.co2_probe;
  return parameters;
}

}  // namespace

void check_step(const SimConfig& config, const robot::RobotModel& model) {
  // Servos advance in whole milliseconds, and a tick is a whole number of steps.
  const double milliseconds = config.physics_step * 1e3;
  const double steps = model.tick / config.physics_step;
  const bool fits = config.physics_step > 0.0 && std::abs(milliseconds - std::round(milliseconds)) < 1e-9 &&
                    std::abs(steps - std::round(steps)) < 1e-9;
  if (fits) return;
  throw InputError("sim: a physics step of " + std::to_string(config.physics_step) +
                   " s does not fit; use whole milliseconds that divide the robot's tick of " +
                   std::to_string(model.tick) + " s");
}

Rig::Rig(const arenas::Arena& arena, const robot::RobotModel& model, const SimConfig& config, const World& world,
         std::size_t index, std::uint64_t seed)
    : index_(index),
      model_(model),
      config_(config),
      laser_(arena, model, config.range_noise, config.sweep, seed),
      accelerometer_(model, {}, config.acceleration_noise, seed),
      victims_(arena.victims, victim_parameters(config), seed),
      odometry_clock_(model.odometry_period),
      unit_clock_(model.acceleration_period, model.acceleration_period),
      victim_clock_(victims_.period()),
      battery_(config.battery_wh),
      battery_clock_(1.0),
      rotor_clock_(model.laser.scan_period) {
  states_.push_back(world.state(index));
  truth_.push_back({Stamp{}, world.state(index).pose});
}

/// Keeps the states that the sweep in progress, or the next, can need.
void Rig::forget_old_states() {
  const Stamp needed = rotor_clock_.next + laser_.times().first_beam;
  while (states_.size() > 2 && states_[1].stamp <= needed) states_.erase(states_.begin());
}

void Rig::follow(World& world, robot::Inputs& inputs) {
  states_.push_back(world.state(index_));
  if (model_.has_levelling_unit) accelerometer_.step(world.state(index_), config_.physics_step);
  fail_in_time(world);
  draw_from_battery(world);
  measure(world, inputs);
}

/// Motors without current stand, whatever they are told.
void Rig::draw_from_battery(World& world) {
  if (config_.battery_wh <= 0.0) return;
  battery_.draw(world.firmware(index_).set_point(), config_.physics_step);
  if (!has_current()) world.firmware(index_).command({});
}

/// The levelling unit fails for good.
void Rig::fail_in_time(World& world) {
  if (config_.levelling_fault == fault_) return;
  const WorldState& state = world.state(index_);
  if (state.stamp.seconds() < config_.levelling_fault_from) return;
  if (std::hypot(state.aim.pitch, state.aim.roll) < config_.levelling_fault_tilt) return;
  fault_ = config_.levelling_fault;
  if (fault_ != LevellingFault::NoAccelerometer) world.servos(index_).jam();
}

void Rig::finish(Stamp end, const World& world, robot::Inputs& inputs) {
  inputs.now = end;
  inputs.command = in_force_;
  truth_.push_back({end, world.state(index_).pose});
}

void Rig::command(const robot::Commands& commands, World& world) {
  in_force_ = commands;
  world.firmware(index_).command(has_current() ? commands.drive : robot::Drive{});
  if (commands.brake) world.firmware(index_).brake();
  if (model_.has_levelling_unit) world.servos(index_).command(commands.aim);
}

void Rig::measure(World& world, robot::Inputs& inputs) {
  const WorldState& state = world.state(index_);
  if (odometry_clock_.due(state.stamp)) {
    inputs.odometry.push_back(world.firmware(index_).reckon(state.stamp));
    odometry_clock_.advance();
  }
  if (model_.has_levelling_unit && unit_clock_.due(state.stamp)) {
    const robot::Acceleration felt = accelerometer_.sample(state.stamp);
    const robot::LaserAim pulses = world.servos(index_).pulses();
    const bool silent = fault_ == LevellingFault::Silent;
    if (!silent && fault_ != LevellingFault::NoAccelerometer) inputs.accelerations.push_back(felt);
    if (!silent) inputs.aims.push_back({state.stamp, pulses.pitch, pulses.roll});
    unit_clock_.advance();
  }
  if (config_.battery_wh > 0.0 && battery_clock_.due(state.stamp)) {
    inputs.battery = {battery_.volts(), Battery::kLow};
    battery_clock_.advance();
  }
  if (victim_clock_.due(state.stamp)) {
    constexpr double kFarthest = 4.0;  // no sense reaches farther, with a robot's half length [m]
    inputs.cues = victims_.look(state, laser_.walk(), world.moving_faces(index_, kFarthest));
    victim_clock_.advance();
  }
  while (rotor_clock_.due(state.stamp - laser_.times().sent)) {
    constexpr double kAround = 1.0;  // what others and the laser's mount stick out, and more [m]
    inputs.scans.push_back(laser_.scan(rotor_clock_.next + laser_.times().first_beam, states_, world.spheres(),
                                       world.moving_faces(index_, model_.laser.range_max + kAround)));
    rotor_clock_.advance();
    forget_old_states();
  }
}

}  // namespace rubble::sim
