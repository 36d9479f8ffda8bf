#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/clock_map.h"
#include "robot/drivers/port.h"
#include "robot/drivers/scanner.h"
#include "robot/drivers/scip/scip_receiver.h"
#include "robot/drivers/scip/scip_reply.h"

namespace rubble::robot::scip {

/// The device answered, but not as a scanner that works: what() names the port and the remedy.
class Refused : public RunError {
 public:
  using RunError::RunError;
};

/// It answers too late to talk with.
class TooLate : public Refused {
 public:
  using Refused::Refused;
};

/// Between which moments the device read its clock for an answer to TM1: question and answer take their time on an
/// Uart.
std::pair<Stamp, Stamp> when_read(Stamp asked, Stamp answered, LineKind line, int baud);

/// One connection to a SCIP device: question and answer, the handshake, the stream. Every call may throw DeviceLost;
/// those that need an answer throw Refused without one.
class Link {
 public:
  explicit Link(std::unique_ptr<Port> port);

  /// Whether a scanner answers, at any bit rate and in either protocol; perhaps too late to talk with it.
  bool knock();
  /// Finds bit rate and protocol, switches to SCIP 2.0 where the device can, and asks who it is. `only_scip1`: does not
  /// switch.
  void shake_hands(bool only_scip1);
  /// Asks the device's clock some ten times; nothing to do in SCIP 1.1.
  void ask_time(WrappingClock& clock, ClockMap& map);
  /// Laser on, and every turn is sent from now on (SCIP 1.1: each has to be asked for, see next_sweep).
  void start();
  /// What the device says of its health; empty in SCIP 1.1 and where it does not say.
  std::string state();
  /// Waits up to `timeout` [s] for the next turn; nothing when none came. What is damaged is counted and passed over.
  std::optional<Sweep> next_sweep(double timeout);
  /// Laser off, nothing is sent any more. Throws nothing.
  void stop();

  /// It has said something that only a scanner says.
  bool answered() const { return answered_; }
  bool is_scip2() const { return scip2_; }
  const Geometry& geometry() const { return geometry_; }
  const ScannerInfo& info() const { return info_; }
  /// Arrival of the first and of the last byte of the last sweep.
  Stamp begun() const { return begun_; }
  Stamp ended() const { return ended_; }
  std::uint64_t damaged() const { return damaged_ + receiver_.broken(); }

 private:
  std::optional<Reply> ask(const std::string& command, double timeout);
  Reply insist(const std::string& command);
  void send(const std::string& command);
  void pull(double timeout);
  void drain(double silence);
  void mind_late_answer(const Reply& reply);
  [[noreturn]] void refuse_late() const;
  bool find_device();
  bool find_at(int baud);
  void switch_to_scip2();
  void identify();
  void identify_scip1();
  Stamp next_question() const;
  std::optional<Sweep> check_stream(const Reply& reply);
  [[noreturn]] void refuse(const std::string& what) const;

  std::unique_ptr<Port> port_;
  Receiver receiver_;
  bool scip2_ = false;
  bool answered_ = false;
  int baud_ = 115200;
  std::string stream_;  ///< the command of the stream, without the number of scans that ends it
  Geometry geometry_;
  ScannerInfo info_;
  Stamp begun_, ended_;
  Stamp asked_;                                          ///< when the last question left
  std::vector<std::pair<std::string, Stamp>> given_up_;  ///< questions that nobody answered in time, and when they left
  int late_ = 0;                                         ///< answers that came after they had been given up
  double latest_ = 0.0;                                  ///< the longest that one of them took [s]
  Stamp heard_ = Stamp::never();                         ///< when the last byte came
  Stamp ask_at_ = Stamp::never();                        ///< SCIP 1.1: when the next turn is to be asked for
  std::uint64_t damaged_ = 0;
};

}  // namespace rubble::robot::scip
