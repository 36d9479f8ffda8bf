#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "base/rng.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "sim/body/world_state.h"

namespace rubble::sim {

/// A two-axis ADXL202 (data sheet, Analog Devices) with 0.10 uF filters and a 1 MHz counter.
struct AccelerometerParameters {
  double bandwidth_hz = 50.0;        ///< single pole of the filter capacitor
  double noise_density = 500e-6;     ///< [g / sqrt(Hz)]
  double period_ticks = 10000.0;     ///< T2 at 1 MHz: 10 ms
  double zero_duty_spread = 0.05;    ///< sigma of the part's duty cycle at 0 g about 50 %
  double sensitivity_spread = 0.01;  ///< sigma of the part's duty cycle per g about 12.5 %
  double zero_residual = 0.002;      ///< sigma of what calibration leaves of the offset [g]
  double scale_residual = 0.001;     ///< sigma of what it leaves of the sensitivity, relative
};

/// Measures specific force, gravity and motion together, at its place on the platform (or the body): what tilts and
/// accelerates looks the same to it. One pulse a physics step; a sample sums the pulses since the last.
class Accelerometer {
 public:
  /// `noise` scales noise and residuals; 0: exact up to the counter's resolution.
  Accelerometer(const robot::RobotModel& model, const AccelerometerParameters& parameters, double noise,
                std::uint64_t seed);

  /// Feels one physics step that ended in `state`.
  void step(const WorldState& state, double dt);
  /// The mean over the pulses since the last sample, as the driver computes it from T1 and T2.
  robot::Acceleration sample(Stamp stamp);

 private:
  Eigen::Vector3d specific_force(const WorldState& state, double dt);

  struct Axis {
    double zero = 0.5;           ///< the part's true duty at 0 g
    double sensitivity = 0.125;  ///< the part's true duty per g
    double calibrated_zero = 0.5;
    double calibrated_sensitivity = 0.125;
    double filtered = 0.0;  ///< [g]
    std::int64_t t1 = 0;    ///< high time summed [ticks]
  };

  robot::RobotModel model_;
  AccelerometerParameters parameters_;
  double noise_;
  Rng rng_;
  Axis axes_[2];
  std::int64_t t2_ = 0;       ///< period summed [ticks]
  double dt_ = 0.0;           ///< of the last step [s]
  double blend_ = 0.0;        ///< how far the low pass goes in it
  int history_ = 0;           ///< states seen, up to 2
  Eigen::Vector3d lever_[2];  ///< base to sensor in world axes at the last two states [m]
  double height_[2] = {};     ///< of the base [m]
  PlanVelocity velocity_;     ///< at the last state
};

}  // namespace rubble::sim
