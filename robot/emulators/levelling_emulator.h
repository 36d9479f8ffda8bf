#pragma once

#include <string>
#include <vector>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/emulators/emulated_device.h"
#include "robot/hardware_units.h"
#include "robot/measurements.h"
#include "robot/protocols/levelling_line.h"

namespace rubble::robot {

struct LevellingEmulatorSettings {
  LevellingIdentity identity;
  int most_rate = 100;  ///< reports a second: no more than measurements are fed
  double zero_x = 0.5;  ///< the part's duty cycle at 0 g
  double zero_y = 0.5;
  double sensitivity = 0.125;  ///< duty cycle per g
  double radians_per_us = kServoStep;
};

/// Acts as the levelling unit's microcontroller. It is fed accelerations and servo angles as the robot has them, and
/// says at which angles the servos shall stand.
class LevellingEmulator : public EmulatedDevice {
 public:
  explicit LevellingEmulator(const LevellingEmulatorSettings& settings);

  void client_came(Stamp now) override;
  void client_left(Stamp /*now*/) override {}
  void receive(std::string_view bytes, Stamp now) override;
  void advance(Stamp now) override;
  std::string take_output() override;
  /// `reset`: it starts anew and says who it is, `sensor`: the accelerometer gives no edge for a second.
  bool fail(DeviceFault fault, Stamp now) override;

  /// What the unit's sensor feels and where its servos stand; `now` is its own clock.
  void measure(const Acceleration& acceleration, const AimState& aim, Stamp now);

  /// Where the servos shall stand.
  LaserAim aim() const;
  bool servos_on() const { return servos_on_; }

 private:
  void start_anew(Stamp now);
  void obey(const std::vector<std::string>& fields, Stamp now);
  void set_pulses(const std::vector<std::string>& fields);
  void say(const std::string& body) { output_ += levelling_line(body); }
  void report(Stamp now);
  double angle(double pulse_us) const { return (pulse_us - 1500.0) * settings_.radians_per_us; }

  LevellingEmulatorSettings settings_;
  LevellingLines lines_;
  std::string output_;
  Stamp started_ = Stamp::never();
  Stamp advanced_ = Stamp::never();
  Stamp heard_ = Stamp::never();
  Stamp next_report_ = Stamp::never();
  Stamp dead_sensor_until_ = Stamp::never();
  int rate_ = 50;
  int watchdog_ms_ = 500;
  double slew_ = 0.0;  ///< [us/s]; 0: none
  bool servos_on_ = false;
  bool tripped_ = false;
  bool clipped_ = false;
  double wanted_us_[2] = {1500.0, 1500.0};  ///< pitch, roll
  double pulse_us_[2] = {1500.0, 1500.0};   ///< after the slew limit
  long t1x_ = 0;
  long t1y_ = 0;
  long t2_ = 0;
  Stamp measured_ = Stamp::never();
  Stamp window_ = Stamp::never();  ///< when the sums began
  AimState last_aim_;
  int sequence_ = 0;
};

}  // namespace rubble::robot
