#pragma once

#include <string>
#include <vector>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/drivers/answer_timer.h"
#include "robot/drivers/clock_map.h"
#include "robot/drivers/device.h"
#include "robot/hardware_units.h"
#include "robot/measurements.h"
#include "robot/protocols/levelling_line.h"

namespace rubble::robot {

/// One axis of the accelerometer: duty cycle at 0 g and per g (data sheet of the ADXL202: 50 % and 12.5 %, but every
/// part is different).
struct AxisCalibration {
  double zero = 0.5;
  double sensitivity = 0.125;  ///< [1/g]
};

/// One servo: the pulse at which it holds the laser level, and its turn per microsecond.
struct ServoCalibration {
  double centre_us = 1500.0;
  double radians_per_us = kServoStep;
};

struct LevellingUnitSettings {
  AxisCalibration x;  ///< forward
  AxisCalibration y;  ///< left
  ServoCalibration pitch;
  ServoCalibration roll;
  int rate = 50;          ///< reports a second asked for
  int watchdog_ms = 500;  ///< the unit holds its servos after so long a silence
  double delay = 0.0;     ///< age of a report when it arrives [s]
  double silence = 0.5;   ///< without reports for so long it is asked anew [s]
  bool passive = false;   ///< only listened to: servo power and settings stay as they are
};

/// Client of the levelling unit: a microcontroller with a two-axis accelerometer and two servos.
class LevellingUnit : public Device {
 public:
  explicit LevellingUnit(const LevellingUnitSettings& settings) : settings_(settings) {}

  void opened(Stamp now, LineKind line) override;
  void receive(std::string_view bytes, Stamp now) override;
  void advance(Stamp now) override;
  std::string take_output(Stamp now) override;
  Stamp deadline() const override;
  int baud() const override { return 115200; }
  /// It reports, and how late it is is known: by an answer of this connection, or by none for so long that it seems not
  /// to know the question.
  bool ready() const override { return reports() && (answer_timer_.known() || settings_.passive); }
  Stamp last_report() const override { return last_report_; }
  std::string state() const override;

  /// Angles the servos shall hold; refreshed until replaced. While the accelerometer gives no signal the last ones
  /// stay.
  void aim(const LaserAim& aim);

  std::vector<Acceleration> take_accelerations();
  std::size_t waiting_accelerations() const { return accelerations_.size(); }
  std::vector<AimState> take_aims();

  const LevellingIdentity& identity() const { return identity_; }
  /// To `E,1`, which changes nothing: reports come unasked, and what they and the servos are late by shows in answers.
  Answers answers(Stamp now) const;
  bool sensor_fault() const { return (flags_ & LevellingReport::kSensorFault) != 0; }
  /// Damaged ones, by their sums or their numbers.
  std::size_t bad_lines() const { return lines_.bad_lines() + unsound_; }
  /// Reports that never arrived, by their numbers.
  std::size_t missing() const { return missing_; }

 private:
  bool reports() const { return identified_ && last_report_ != Stamp::never(); }
  void digest(const std::vector<std::string>& fields, Stamp now);
  bool is_sound(const LevellingReport& report) const;
  void follow(const LevellingReport& report, Stamp now);
  Stamp stamp_of(const LevellingReport& report, Stamp now);
  void restart_clock();
  int pulse(double angle, const ServoCalibration& servo) const;

  LevellingUnitSettings settings_;
  LevellingLines lines_;
  LevellingIdentity identity_;
  bool identified_ = false;
  Stamp asked_ = Stamp::never();
  std::string output_;
  LaserAim aim_;
  bool aimed_ = false;  ///< aim() was called once
  bool aim_due_ = false;
  Stamp aim_sent_ = Stamp::never();
  LineKind line_ = LineKind::Tcp;
  WrappingClock counter_{1u << 31, 2e-6};  ///< every second microsecond of 2^32
  ClockMap clock_{ClockMapConfig{}};
  AnswerTimer answer_timer_;
  Stamp unanswered_ = Stamp::never();  ///< asked first then in this connection, and no answer yet
  Stamp last_stamp_ = Stamp::never();
  Stamp last_report_ = Stamp::never();
  int sequence_ = -1;
  int flags_ = 0;
  std::size_t missing_ = 0;
  std::size_t unsound_ = 0;
  std::vector<Acceleration> accelerations_;
  std::vector<AimState> aims_;
};

}  // namespace rubble::robot
