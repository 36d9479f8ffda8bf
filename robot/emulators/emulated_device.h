#pragma once

#include <string>
#include <string_view>

#include "base/stamp.h"

namespace rubble::robot {

/// What may befall a device itself, apart from its line; docs/hardware.md says what each does.
enum class DeviceFault {
  Reset,
  ClockWrap,
  SetOrigin,
  Stall,
  Watchdog,
  Button,
  Motors,
  Stuck,
  Runaway,
  Encoders,
  Battery,
  Sensor
};

/// The device's side of a protocol apart from its port and from any clock: bytes of the client, time and measurements
/// go in, bytes and set points come out. Whoever owns the port and the robot moves them.
class EmulatedDevice {
 public:
  virtual ~EmulatedDevice() = default;
  /// A client has come (never told on a pty).
  virtual void client_came(Stamp now) = 0;
  /// The client is gone, or the plug was pulled.
  virtual void client_left(Stamp now) = 0;
  virtual void receive(std::string_view bytes, Stamp now) = 0;
  /// Lets time pass: watchdog, ramps, reports that are due.
  virtual void advance(Stamp now) = 0;
  /// Bytes for the client.
  virtual std::string take_output() = 0;
  /// A fault of the device itself begins. False: this device does not know it.
  virtual bool fail(DeviceFault /*fault*/, Stamp /*now*/) { return false; }
};

}  // namespace rubble::robot
