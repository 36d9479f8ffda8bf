#pragma once

#include <mrpt/math/TPose2D.h>

#include <deque>
#include <string>
#include <vector>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/drivers/cycle_clock.h"
#include "robot/drivers/device.h"
#include "robot/drivers/rate_dither.h"
#include "robot/measurements.h"
#include "robot/protocols/arcos_packet.h"
#include "robot/protocols/arcos_reports.h"

namespace rubble::robot {

/// How the base is driven and its dead reckoning read.
struct PioneerSettings {
  std::vector<int> bauds{9600, 38400, 19200, 115200, 57600};  ///< tried in turn on a serial line
  double max_v = 0.7;                                         ///< no command exceeds it [m/s]
  double max_w = deg_to_rad(100.0);                           ///< [rad/s]
  double max_accel = 0.3;                                     ///< [m/s^2]
  double max_turn_accel = deg_to_rad(100.0);                  ///< [rad/s^2]
  double distance_scale = 1.0;                                ///< true distance per reckoned distance
  double turn_scale = 1.0;                                    ///< true turn per reckoned turn
  double delay = 0.0;    ///< age of a report when its first byte leaves the robot [s]
  bool passive = false;  ///< reports are read, but somebody else drives
  /// Without reports for so long the connection is made anew [s]. Not sooner: OPEN sets the odometry to zero, while a
  /// report after a gap still tells all the motion within it. Standing still meanwhile is the caller's business.
  double silence = 3.0;
};

/// Client of ARCOS and its kin, the firmware of Pioneer robots.
///
/// Searches the bit rate, synchronises, opens, asks for the configuration, sets limits; then unwraps the reports into
/// odometry that never jumps, and keeps the set points fresh so that the robot's watchdog does not stop it. Turn rates
/// are whole degrees a second on the wire and dithered.
class Pioneer : public Device {
 public:
  explicit Pioneer(const PioneerSettings& settings) : settings_(settings) {}

  void opened(Stamp now, bool serial) override;
  void receive(std::string_view bytes, Stamp now) override;
  void advance(Stamp now) override;
  std::string take_output(Stamp now) override;
  std::string farewell() override;
  Stamp deadline() const override;
  int baud() const override;
  bool ready() const override { return step_ == Step::Running && last_report_ != Stamp::never(); }
  Stamp last_report() const override { return last_report_; }
  std::string state() const override;

  /// Set points, kept within the limits; they hold until replaced.
  void drive(const Drive& drive);
  /// Motors on or off; off also forgets the set points. Asked for again until the robot reports it. A held base stays
  /// off.
  void enable(bool on);
  /// Somebody at the robot stopped it: its emergency button is pressed, or its motors went off though nobody here asked
  /// for it. It is not switched on again until rearm().
  enum class Hold { None, EmergencyButton, MotorsOff };
  Hold hold() const { return hold_; }
  /// The operator lets the base go again. While the button is pressed it stays held.
  void rearm();
  /// Stops and switches the motors off.
  void stop();
  /// Stops as hard as the robot can and switches the motors off.
  void emergency_stop();

  /// Odometry since the last call, in one frame over all connections.
  std::vector<Odometry> take_odometry();

  const arcos::Identity& identity() const { return identity_; }
  const arcos::Configuration& configuration() const { return configuration_; }
  double battery() const { return information_.battery; }  ///< [V]
  bool motors_on() const { return (information_.flags & arcos::kMotorsOn) != 0; }
  bool emergency_button() const { return (information_.flags & arcos::kEmergencyButton) != 0; }
  /// Packets with a wrong sum and reports that jumped (the origin was set anew), since the start.
  std::size_t bad_sums() const { return parser_.bad_sums(); }
  std::size_t jumps() const { return jumps_; }

 private:
  enum class Step { Closed, Sync0, Sync1, Sync2, Closing, Opening, Running };

  void go(Step step, Stamp now);
  void ask(Stamp now);
  void try_next_rate(Stamp now);
  void digest(const std::string& payload, Stamp now);
  void open(Stamp now);
  void follow(const arcos::StandardInformation& report, Stamp stamp);
  void mind_hold();
  void refresh(Stamp now);
  void send(const std::string& packet) { queue_.push_back(packet); }
  Stamp sampled(std::size_t bytes, Stamp received) const;

  PioneerSettings settings_;
  arcos::PacketParser parser_;
  Step step_ = Step::Closed;
  bool serial_ = false;
  std::size_t rate_ = 0;  ///< which of the bit rates
  int tries_ = 0;
  Stamp since_ = Stamp::never();  ///< of the step, or of its last question
  std::deque<std::string> queue_;
  Stamp sent_ = Stamp::never();  ///< when a packet went out last

  arcos::Identity identity_;
  arcos::Configuration configuration_;
  arcos::StandardInformation information_;
  bool configured_ = false;

  Drive target_;
  bool motors_ = false;
  bool obeyed_ = false;  ///< the robot has reported the motors on since they were asked for
  Hold hold_ = Hold::None;
  Stamp asked_motors_ = Stamp::never();
  RateDither turn_;
  Stamp turn_decided_ = Stamp::never();
  int v_sent_ = 0;
  int w_sent_ = 0;
  bool v_due_ = false;
  bool w_due_ = false;
  Stamp refreshed_ = Stamp::never();

  CycleClock clock_;
  bool based_ = false;  ///< information_ is the reference for the next report
  Stamp last_report_ = Stamp::never();
  Stamp last_stamp_ = Stamp::never();
  mrpt::math::TPose2D pose_;  ///< T_odom_base
  std::vector<Odometry> odometry_;
  std::size_t jumps_ = 0;
};

}  // namespace rubble::robot
