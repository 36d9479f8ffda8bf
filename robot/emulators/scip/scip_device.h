#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/drivers/scip/scip_reply.h"

namespace rubble::robot::scip {

/// What an emulated scanner says of itself.
struct DeviceIdentity {
  std::string model = "URG-04LX";
  std::string serial = "H0000001";
  Geometry geometry{1024, 44, 725, 384, 20, 5600, 600};
  int last_of_all = 768;  ///< steps 0 to this exist; those that do not measure give code 19
};

/// The identity of a scanner of this geometry. Throws InputError when its beams do not lie on whole steps of a turn.
DeviceIdentity identity_of(const LaserModel& laser);

/// The device's side of SCIP 1.1 and 2.0 as a state machine: bytes in, whole replies out, each to be sent in one piece.
/// Time is the device's own: seconds since it was switched on. It starts as a URG-04LX does, in SCIP 1.1 with the laser
/// on; a switch to SCIP 2.0 holds until the power is cut. Motor levels are remembered and told, but the revolution
/// stays that of the scenario.
class Device {
 public:
  explicit Device(const DeviceIdentity& identity);

  /// Digests what a client sent; returns the replies, in order.
  std::vector<std::string> receive(const std::uint8_t* bytes, std::size_t size, double time);
  /// A turn that began at `began` is over. values: [mm] or codes of the steps 0 to last_of_all. Returns what is sent.
  std::vector<std::string> turn(double began, const std::vector<std::uint32_t>& values);
  /// Power off and on: SCIP 1.1, laser on, clock at zero.
  void cycle_power(double time);
  /// The client's end was closed: nothing is sent until the next one asks.
  void client_left();

  bool is_scip2() const { return scip2_; }
  bool laser_is_on() const { return laser_; }
  const DeviceIdentity& identity() const { return identity_; }
  /// Sets the clock to `milliseconds`.
  void set_clock(double time, std::uint32_t milliseconds);

 private:
  /// The part of a turn that was asked for, and how.
  struct Question {
    std::string echo;  ///< the command as it came, string included
    int first = 0, last = 0, cluster = 1;
    std::size_t characters = 3;
    double since = 0.0;  ///< a turn that began earlier does not answer
    int skip = 0;        ///< stream: turns left out between two that are sent
    int left = -1;       ///< stream: turns still to be sent; -1: until QT
    int passed = 0;      ///< stream: turns left out since the last one sent
  };
  struct Turn {
    double began = 0.0;
    std::vector<std::uint32_t> values;
    bool asked_for = false;
  };

  std::string answer(const std::string& line, double time);
  std::string answer_scip1(const std::string& line, double time);
  std::string answer_scip2(const std::string& line, double time);
  std::string ask_scip1(const std::string& line, double time);
  std::string ask_once(const std::string& line, const std::string& digits, double time);
  std::string ask_stream(const std::string& line, const std::string& digits, double time);
  std::string laser_on(const std::string& line, double time);
  std::string clock_mode(const std::string& line, const std::string& digits, double time);
  std::string bit_rate(const std::string& line, const std::string& digits);
  std::string motor(const std::string& line, const std::string& digits);
  std::string sensitivity(const std::string& line, const std::string& digits);
  std::string versions(const std::string& line) const;
  std::string parameters(const std::string& line) const;
  std::string state(const std::string& line, double time) const;
  std::string range_trouble(std::string_view digits, Question& question) const;
  std::string once(Question question);
  std::string block(const Question& question, const Turn& turn, const std::string& status) const;
  std::optional<std::string> stream_block(const Turn& turn);
  std::uint32_t clock(double time) const;
  void reset(double time);
  void set_laser(bool on, double time);

  DeviceIdentity identity_;
  std::string line_;
  bool line_too_long_ = false;
  bool scip2_ = false;
  bool laser_ = true;
  bool asking_time_ = false;
  bool high_sensitivity_ = false;
  int baud_ = 19200;
  int motor_level_ = 0;
  double clock_zero_ = 0.0;
  double laser_since_ = 0.0;
  std::optional<Question> stream_;
  std::deque<Question> waiting_;  ///< single turns asked for
  std::optional<Turn> latest_;
};

}  // namespace rubble::robot::scip
