#pragma once

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/hardware_units.h"

namespace rubble::sim {

/// RC servo of the Hitec HS-422 class. The last three are the unit's own faults, which a controller that sees the
/// platform's tilt takes out; zero by default.
struct ServoParameters {
  double pulse_step = robot::kServoStep;  ///< turn per microsecond of pulse [rad]
  double frame = robot::kServoFrame;      ///< a new pulse is taken every frame [s]
  double dead_band = deg_to_rad(0.3);     ///< smaller errors do not move it [rad]
  double response = robot::kServoTime;    ///< speed = error / response [s]
  double max_rate = deg_to_rad(300.0);    ///< [rad/s]
  double max_angle = deg_to_rad(30.0);    ///< travel either way [rad]
  double centre_offset = 0.0;             ///< where it stands at 1500 us [rad]
  double scale = 1.0;                     ///< turn per commanded turn
  double backlash = 0.0;                  ///< play of the gears, full width [rad]
};

/// One servo, advanced in steps of 1 ms.
class Servo {
 public:
  explicit Servo(const ServoParameters& parameters) : parameters_(parameters) {}

  void command(double angle);
  /// Advances by whole milliseconds.
  void step(int milliseconds);
  /// The angle the pulse being output asks for: all that the microcontroller knows [rad].
  double pulse() const { return latched_; }
  /// Where the horn really stands [rad].
  double angle() const { return horn_; }
  /// From now on the horn stays where it is.
  void jam() { jammed_ = true; }

 private:
  double target() const;
  bool is_settled() const;

  ServoParameters parameters_;
  double commanded_ = 0.0;
  double latched_ = 0.0;
  int frame_ms_ = 0;   ///< since the last frame
  double gear_ = 0.0;  ///< the motor side
  double horn_ = 0.0;
  bool started_ = false;
  bool jammed_ = false;
};

/// Two servos, one stack: the outer tilts the inner in pitch, the inner carries the platform and tilts it in roll.
class Servos {
 public:
  explicit Servos(const ServoParameters& parameters) : pitch_(parameters), roll_(parameters) {}
  void command(const robot::LaserAim& aim);
  void step(int milliseconds);
  void jam() {
    pitch_.jam();
    roll_.jam();
  }
  robot::LaserAim pulses() const { return {pitch_.pulse(), roll_.pulse()}; }
  robot::LaserAim angles() const { return {pitch_.angle(), roll_.angle()}; }

 private:
  Servo pitch_;
  Servo roll_;
};

}  // namespace rubble::sim
