#pragma once

#include <mrpt/math/TPose2D.h>

#include <deque>
#include <string>
#include <vector>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/drivers/answer_timer.h"
#include "robot/drivers/base_driver.h"
#include "robot/drivers/cycle_clock.h"
#include "robot/drivers/rate_dither.h"
#include "robot/measurements.h"
#include "robot/protocols/arcos_packet.h"
#include "robot/protocols/arcos_reports.h"

namespace rubble::robot {

/// Client of ARCOS and its kin, the firmware of Pioneer robots.
///
/// Searches the bit rate, synchronises, opens, asks for the configuration, sets limits; then unwraps the reports into
/// odometry that never jumps, and keeps the set points fresh so that the robot's watchdog does not stop it. Turn rates
/// are whole degrees a second on the wire and dithered. Without reports it waits settings.silence before it connects
/// anew: OPEN sets the odometry to zero, while a report after a gap still tells all the motion within it. A base whose
/// motors stay on though they were switched off again and again is stopped hard, closed and not spoken to until its
/// watchdog must have stopped it; as long as it reports them on the same is said again from time to time.
///
/// With settings.listen it first waits for reports that somebody else's connection brings. Where they come it only
/// reads them, from then on over all connections (but for the emergency stop, which is always said); where none come it
/// connects as ever. With settings.passive a connection of its own says nothing once it is open.
class Pioneer : public BaseDriver {
 public:
  explicit Pioneer(const BaseSettings& settings) : settings_(settings) {}

  void opened(Stamp now, LineKind line) override;
  void receive(std::string_view bytes, Stamp now) override;
  void advance(Stamp now) override;
  std::string take_output(Stamp now) override;
  std::vector<std::string> farewell() override;
  Stamp deadline() const override;
  int baud() const override;
  bool ready() const override { return step_ == Step::Running && last_report_ != Stamp::never(); }
  Stamp last_report() const override { return last_report_; }
  std::string state() const override;

  void drive(const Drive& drive) override;
  void brake() override;
  void enable(bool on) override;
  Hold hold() const override { return hold_; }
  void rearm() override;
  void stop() override;
  void emergency_stop() override;
  std::vector<Odometry> take_odometry() override;
  /// To ENCODER, whose answer is the shortest: even at 9600 baud it holds up nothing.
  Answers answers(Stamp now) const override {
    return times_answers() ? Answers{answer_timer_.late(now), answer_timer_.missing(now)} : Answers{};
  }

  Drive own_ramp() const override;
  /// By CONFIG; one without a watchdog is waited for as long as the usual one.
  double watchdog() const override {
    return configuration_.watchdog_ms > 0 ? 1e-3 * configuration_.watchdog_ms : BaseDriver::watchdog();
  }
  bool slow() const override { return !ready() && echo_late_ > 0.0; }

  const arcos::Identity& identity() const { return identity_; }
  /// Its defaults where the robot has not told any.
  const arcos::Configuration& configuration() const { return configuration_; }
  bool configured() const { return configured_; }
  double battery() const override { return information_.battery; }
  std::string who() const override;
  bool motors_on() const override { return (information_.flags & arcos::kMotorsOn) != 0; }
  bool emergency_button() const { return (information_.flags & arcos::kEmergencyButton) != 0; }
  std::size_t bad_sums() const override { return parser_.bad_sums(); }
  std::size_t jumps() const override { return jumps_; }

 private:
  static constexpr double kLeftAlone = 1.0;  ///< so much longer than its watchdog waits it is not spoken to [s]
  enum class Step { Closed, Listening, Sync0, Sync1, Sync2, Closing, Refused, Opening, Running };

  void go(Step step, Stamp now);
  void ask(Stamp now);
  void try_next_rate(Stamp now);
  void listen_on(Stamp now);
  double patience() const;
  Stamp heard() const;
  void mind_silence(Stamp now);
  void digest(const std::string& payload, Stamp now, std::size_t behind);
  void open(Stamp now);
  void follow(const arcos::StandardInformation& report, Stamp stamp);
  void mind_hold();
  bool stays_on(Stamp now);
  void leave_to_its_watchdog(Stamp now);
  double left_alone() const { return watchdog() + kLeftAlone; }
  void disconnect();
  void forget_motion();
  void forget_questions();
  void refresh(Stamp now);
  void send(const std::string& packet) { queue_.push_back(packet); }
  bool times_answers() const;
  void mind_answer(std::size_t bytes, Stamp now);
  void mind_late_echo(Stamp now);
  std::string late_echoes() const;
  Stamp sampled(std::size_t bytes, Stamp received) const;

  BaseSettings settings_;
  arcos::PacketParser parser_;
  Step step_ = Step::Closed;
  LineKind line_ = LineKind::Tcp;
  std::size_t rate_ = 0;  ///< which of the bit rates
  int tries_ = 0;
  bool listening_ = false;        ///< nothing is said: the reports are somebody else's
  bool overheard_ = false;        ///< they came once: whoever has the base may come back and is not spoken between
  bool opened_ = false;           ///< a connection of our own was opened
  Stamp since_ = Stamp::never();  ///< of the step, or of its last question
  std::deque<std::string> queue_;
  Stamp sent_ = Stamp::never();  ///< when a packet went out last

  arcos::Identity identity_;
  arcos::Factors factors_;
  std::string refusal_;  ///< why the robot is not opened; empty: it is, or has not told who it is
  arcos::Configuration configuration_;
  arcos::StandardInformation information_;
  bool configured_ = false;

  Drive target_;
  bool motors_ = false;
  bool switched_off_ = false;  ///< having been switched on
  bool obeyed_ = false;        ///< the robot has reported the motors on since they were asked for
  Hold hold_ = Hold::None;
  Stamp asked_motors_ = Stamp::never();
  RateDither turn_;
  Stamp turn_decided_ = Stamp::never();
  int v_sent_ = 0;
  int w_sent_ = 0;
  bool v_due_ = false;
  bool w_due_ = false;
  Stamp refreshed_ = Stamp::never();

  AnswerTimer answer_timer_;
  std::size_t report_bytes_ = 0;      ///< of the last report on the line
  double reply_ = 0.0;                ///< an echo comes within this time [s]
  double echo_late_ = 0.0;            ///< so late one came at least; 0: all in time [s]
  Stamp asked_ = Stamp::never();      ///< when SYNC0 was said last
  double closed_for_ = 0.0;           ///< so long nothing is said behind CLOSE [s]
  Stamp closed_at_ = Stamp::never();  ///< left to its watchdog then
  bool stands_ = false;               ///< since
  bool roused_ = false;               ///< from its rest, by being spoken to
  Stamp on_since_ = Stamp::never();   ///< its motors are on though switched off
  CycleClock clock_;
  bool based_ = false;  ///< information_ is the reference for the next report
  Stamp last_report_ = Stamp::never();
  Stamp last_stamp_ = Stamp::never();
  mrpt::math::TPose2D pose_;  ///< T_odom_base
  std::vector<Odometry> odometry_;
  std::size_t jumps_ = 0;
};

}  // namespace rubble::robot
