#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"
#include "robot/levelling.h"

namespace rubble::levelling_test {

/// What the robot's body does at a time [s].
struct Body {
  double pitch = 0.0;         ///< nose up [rad]
  double acceleration = 0.0;  ///< forward [m/s^2]
  double v = 0.0;             ///< [m/s]
  double w = 0.0;             ///< [rad/s]
};

struct Sample {
  double t;
  double plane_pitch;  ///< of the laser plane against the horizon [rad]
  double aim_pitch;    ///< commanded [rad]
};

/// A hobby servo: pulses of whole microseconds latched every 20 ms, 0.09 deg/us, dead band 0.3 deg, 40 ms, 300 deg/s.
class Servo {
 public:
  void command(double angle) { next_ = std::round(rad_to_deg(angle) / 0.09) * 0.09; }
  /// Advances by a millisecond.
  void step(int ms) {
    if (ms % 20 == 0) target_ = next_;
    if (std::abs(target_ - angle_) < 0.3) return;
    angle_ += std::clamp((target_ - angle_) / 0.04, -300.0, 300.0) * 1e-3;
    angle_ = std::clamp(angle_, -30.0, 30.0);
  }
  double angle() const { return deg_to_rad(angle_); }

 private:
  double next_ = 0.0, target_ = 0.0, angle_ = 0.0;  // [deg]
};

/// The whole loop in steps of a millisecond: body, servo, accelerometer that averages 20 ms and arrives 7 ms later,
/// odometry every 100 ms, controller every 20 ms, command 5 ms on its way, `late_ms` longer over a slow line.
inline std::vector<Sample> run(const robot::LevellingConfig& config, double seconds,
                               const std::function<Body(double)>& body_at,
                               robot::AccelerometerMount mount = robot::AccelerometerMount::Platform,
                               double noise_deg = 0.1, int late_ms = 0) {
  robot::RobotModel model;
  model.accelerometer_mount = mount;
  robot::Levelling levelling(config, model);
  Servo servo;
  Rng noise(1, "accelerometer");
  std::vector<Sample> samples;
  std::deque<std::pair<int, robot::Acceleration>> on_its_way;
  std::deque<std::pair<int, double>> commands;
  robot::Inputs inputs;
  double sum = 0.0;
  double aim = 0.0;
  const double g = 9.80665;
  for (int ms = 0; ms < static_cast<int>(seconds * 1000.0); ++ms) {
    const double t = ms * 1e-3;
    const Stamp stamp{ms * 1000000ll};
    const Body body = body_at(t);
    while (!commands.empty() && commands.front().first <= ms) {
      servo.command(commands.front().second);
      commands.pop_front();
    }
    servo.step(ms);
    const double plane = body.pitch + servo.angle();
    const double felt = mount == robot::AccelerometerMount::Platform ? plane : body.pitch;
    sum += g * std::sin(felt) + body.acceleration * std::cos(felt);
    if (ms % 20 == 19) {
      const double error = noise.gaussian(g * deg_to_rad(noise_deg));
      on_its_way.push_back({ms + 7, {stamp, sum / 20.0 + error, 0.0}});
      sum = 0.0;
    }
    while (!on_its_way.empty() && on_its_way.front().first <= ms) {
      inputs.accelerations.push_back(on_its_way.front().second);
      on_its_way.pop_front();
    }
    if (ms % 100 == 0) inputs.odometry.push_back({stamp, {}, body.v, body.w, false});
    if (ms % 20 == 0) {
      inputs.now = stamp;
      aim = levelling.update(inputs).pitch;
      commands.push_back({ms + 5 + late_ms, aim});
      inputs = {};
    }
    samples.push_back({t, plane, aim});
  }
  return samples;
}

/// Last time at which the plane was off by more than `limit`.
inline double settled_after(const std::vector<Sample>& samples, double limit) {
  double last = 0.0;
  for (const Sample& s : samples) {
    if (std::abs(s.plane_pitch) > limit) last = s.t;
  }
  return last;
}

inline double largest(const std::vector<Sample>& samples, double from, double to) {
  double most = 0.0;
  for (const Sample& s : samples) {
    if (s.t >= from && s.t <= to) most = std::max(most, std::abs(s.plane_pitch));
  }
  return most;
}

}  // namespace rubble::levelling_test
