#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "base/angle.h"
#include "robot/commands.h"
#include "robot/emulators/emulated_device.h"
#include "robot/measurements.h"
#include "robot/protocols/arcos_commands.h"
#include "robot/protocols/arcos_packet.h"
#include "robot/protocols/arcos_reports.h"

namespace rubble::robot {

struct ArcosEmulatorSettings {
  arcos::Identity identity{"MobileSim", "Pioneer", "p3at-sh"};  ///< a simulator's name: clients skip what is hardware
  arcos::Configuration configuration;
  mrpt::math::TPose2D odometry_start;                 ///< what OPEN and SETO set the odometry to
  double half_track = arcos::Factors{}.half_track();  ///< wheel speeds are v -+ w * half_track [m]
  mrpt::math::TPose2D true_start;                     ///< where kSimReset puts the robot, arena frame
  bool is_simulator = true;                           ///< understands what only simulators do
};

/// The identity of a real robot: clients do not take it for a simulator, and it does not understand a simulator's
/// commands.
void play_hardware(ArcosEmulatorSettings& settings);

/// Acts as a Pioneer's firmware. It is fed the robot's dead reckoning and says what the motors shall do.
///
/// Speaks the handshake, the motion commands with their ramps and limits, the watchdog, the reports and the commands
/// that only simulators have. A packet of reports is sent with each odometry that is fed, that is, every 100 ms.
class ArcosEmulator : public EmulatedDevice {
 public:
  explicit ArcosEmulator(const ArcosEmulatorSettings& settings);

  void client_came(Stamp now) override;
  void client_left(Stamp now) override;
  void receive(std::string_view bytes, Stamp now) override;
  void advance(Stamp now) override;
  std::string take_output() override;
  /// `seto`: the odometry is set to zero, `stall`: both motors report a stall for a second, `reset`: the firmware
  /// starts anew and waits for SYNC0, `watchdog`: commands are not heard for 3 s, `button`: the emergency button is
  /// pressed for 2 s, `motors`: the motors are switched off at the robot, `stuck`: for 6 s the wheels stand whatever
  /// they are told, `runaway`: they go on as they did (0.2 m/s ahead from rest) until the motors are off, `encoders`:
  /// for 4 s they count nothing, whatever the wheels do, `battery`: it is nearly empty from then on.
  bool fail(DeviceFault fault, Stamp now) override;

  /// The robot's dead reckoning at `now`, in any frame that stays.
  void measure(const Odometry& odometry, Stamp now);
  /// A scan that will be over when its last beam is, for clients that ask a simulator for scans on this line; stamps by
  /// the clock of `now`.
  void measure(const LaserScan& scan) { scan_ = scan; }
  /// The robot's true pose, for clients that ask a simulator.
  void tell_truth(const mrpt::math::TPose2D& T_arena_base) { truth_ = T_arena_base; }

  /// What the motors shall do now.
  const Drive& motion() const { return motion_; }
  /// They shall do so at once, without a ramp: off, or in an emergency stop.
  bool brakes_hard() const { return braking_; }
  /// The true pose that a client has set; once.
  std::optional<mrpt::math::TPose2D> take_placed();

  bool open() const { return session_ == Session::Open; }
  bool motors_on() const { return motors_; }
  /// What it reports from then on [V].
  void set_battery(double volts) { battery_ = volts; }
  /// The watchdog holds the robot.
  bool is_held() const { return held_; }

 private:
  enum class Session { Sync0, Sync1, Sync2, Synchronised, Open };
  enum class Mode { Speed, Wheels, Head, Move };

  void start_anew();
  void hear(Stamp now);
  void obey(const arcos::Order& order, Stamp now);
  void synchronise(std::uint8_t number);
  void open_session(Stamp now);
  void move_by(const arcos::Order& order, Stamp now);
  void set_limit(const arcos::Order& order);
  void simulate(const arcos::Order& order);
  void set_laser(const arcos::Order& order);
  void send_scan();
  void place(const mrpt::math::TPose2D& T_arena_base);
  /// The client's odometry frame, so that the present pose becomes `start`.
  void set_origin(const mrpt::math::TPose2D& start);
  void report();
  void switch_motors(bool on);
  Drive gone(Stamp now) const;
  void aim_for(Mode mode, Stamp now);
  double still_to_go() const;
  void look_again(double dt);
  void give_way();
  Drive wanted() const;
  mrpt::math::TPose2D reckoned() const;
  double left_speed() const { return odometry_.v - odometry_.w * settings_.half_track; }
  double right_speed() const { return odometry_.v + odometry_.w * settings_.half_track; }
  void send(const std::string& payload) { output_ += arcos::packet(payload); }

  struct Limits {
    double v = 0.0;           ///< [m/s]
    double w = 0.0;           ///< [rad/s]
    double accel = 0.0;       ///< [m/s^2]
    double decel = 0.0;       ///< [m/s^2]
    double turn_accel = 0.0;  ///< [rad/s^2]
    double turn_decel = 0.0;  ///< [rad/s^2]
  };
  Limits flash() const;

  ArcosEmulatorSettings settings_;
  arcos::PacketParser parser_;
  std::string output_;
  Session session_ = Session::Sync0;

  Limits limits_;
  Mode mode_ = Mode::Speed;
  Drive target_;               ///< in mode Speed, and Head's forward speed
  double heading_target_ = 0;  ///< in mode Head [rad], odometry frame
  mrpt::math::TPose2D move_start_;
  double move_target_ = 0.0;   ///< in mode Move [m]
  double planned_left_ = 0.0;  ///< in modes Head and Move: what the set points still have to cover [rad] or [m]
  double rest_ = 0.0;          ///< the robot has stood still for so long [s]
  Drive motion_;
  bool motors_ = false;
  bool held_ = false;
  bool braking_ = false;  ///< an emergency stop, or motors switched off: at once
  Stamp heard_ = Stamp::never();
  Stamp advanced_ = Stamp::never();

  Odometry odometry_;  ///< as it was fed
  Stamp measured_at_ = Stamp::never();
  Drive motion_then_;           ///< what the motors were told when it was fed
  mrpt::math::TPose2D origin_;  ///< where the client's odometry frame lies in the fed one
  mrpt::math::TPose2D truth_;
  std::optional<mrpt::math::TPose2D> placed_;
  double battery_ = 12.8;  ///< [V]
  int encoders_ = 0;       ///< 0: not sent, 1: once, 2: always
  int status_ = 0;         ///< the same for the simulator's status
  /// What kSimLaserEnable and its kin ask for.
  struct LaserWish {
    int mode = 0;        ///< 0: off, 1, 2: the packets' kind
    double start = -90;  ///< [deg]
    double end = 90;     ///< [deg]
    double step = 1.0;   ///< [deg]
  };
  LaserWish laser_;
  std::optional<LaserScan> scan_;  ///< not yet over
  double left_travel_ = 0.0;       ///< [m]
  double right_travel_ = 0.0;      ///< [m]
  Stamp stalled_until_ = Stamp::never();
  Stamp deaf_until_ = Stamp::never();
  Stamp pressed_until_ = Stamp::never();  ///< the emergency button
  Stamp stuck_until_ = Stamp::never();
  Stamp uncounted_until_ = Stamp::never();
  std::optional<mrpt::math::TPose2D> uncounted_;  ///< from what the wheels did to what is counted
  std::optional<Drive> runaway_;                  ///< what the wheels do whatever they are told
};

}  // namespace rubble::robot
