#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/stamp.h"
#include "robot/drivers/port.h"

namespace rubble::robot {

/// One device's protocol apart from its port and from any clock: bytes and time go in, bytes and measurements come out.
/// So the same code runs on a port, on the bytes of a black box and in tests.
class Device {
 public:
  virtual ~Device() = default;
  /// A port to the device has just been opened: the conversation starts anew.
  virtual void opened(Stamp now, LineKind line) = 0;
  /// Bytes that had arrived at `now`.
  virtual void receive(std::string_view bytes, Stamp now) = 0;
  /// Does what is due at `now`: asks again, refreshes, gives up.
  virtual void advance(Stamp now) = 0;
  /// Bytes to send at `now`.
  virtual std::string take_output(Stamp now) = 0;
  /// What to send before the port is closed, so that the device comes to rest: each entry on its own, kPause apart.
  virtual std::vector<std::string> farewell() { return {}; }
  static constexpr double kPause = 0.005;  ///< [s]
  /// When advance() or take_output() wants to be called again at the latest.
  virtual Stamp deadline() const = 0;
  /// The bit rate the serial line shall have; 0: leave it.
  virtual int baud() const { return 0; }
  /// It identified itself and has begun to report.
  virtual bool ready() const = 0;
  /// When it reported last.
  virtual Stamp last_report() const = 0;
  /// How far it is, for people: "asks who is there at 9600 baud".
  virtual std::string state() const = 0;
};

}  // namespace rubble::robot
