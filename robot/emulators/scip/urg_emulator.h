#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "robot/emulators/line_faults.h"
#include "robot/measurements.h"
#include "robot/model.h"

namespace rubble::robot {

struct UrgEmulatorConfig {
  std::string port;               ///< as serve_port takes it
  LaserModel laser;               ///< geometry and range; a URG-04LX says of itself what a real one says
  double jitter = 0.0;            ///< scans leave late by up to so much, evenly distributed [s]
  double clock_drift = 0.0;       ///< the device's clock runs slow by so much [s/s]
  std::uint32_t clock_start = 0;  ///< of the device's clock at power-up [ms]; it wraps at 2^24
  std::uint64_t seed = 1;         ///< of jitter and faults
  int baud = 0;  ///< bytes leave at this rate, and turns that end while the line is busy are left out, as on RS-232; 0:
                 ///< at once
  /// Called by the emulator's own thread when the last byte of a scan has been handed to the line.
  std::function<void(Stamp)> scan_sent;
};

/// The clock_start with which the clock wraps so long after power-up [s].
std::uint32_t clock_before_wrap(double seconds);

struct UrgEmulatorStatus {
  std::uint64_t clients = 0;    ///< that connected (TCP only)
  std::uint64_t sent = 0;       ///< blocks with scans sent
  std::uint64_t dropped = 0;    ///< replies or scans that the client did not take in time
  double worst_lateness = 0.0;  ///< of a scan handed over to the line, against the moment it was due [s]
};

/// A Hokuyo scanner on a port: a thread of its own answers clients and sends the turns that are published. SCIP 1.1 and
/// 2.0, see scip::Device.
class UrgEmulator {
 public:
  /// Opens the port. Throws InputError and RunError as serve_port does.
  explicit UrgEmulator(const UrgEmulatorConfig& config);
  ~UrgEmulator();

  /// The word for clients, with the true port number.
  const std::string& port() const;

  /// One finished turn, its stamp by host_now(). It is sent when the rotor has passed its last step, or at once if that
  /// is past. From any thread.
  void publish(const LaserScan& scan);

  /// For `duration` [s] every reply is spoilt so.
  void spoil(ByteFault fault, double duration);
  /// For `duration` [s] the device neither hears nor speaks.
  void fall_silent(double duration);
  /// The power fails for a moment: SCIP 1.1, clock at zero.
  void cycle_power();
  /// The plug is pulled and comes back after `duration` [s], the device restarted.
  void unplug(double duration);

  UrgEmulatorStatus status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::robot
