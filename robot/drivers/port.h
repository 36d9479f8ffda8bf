#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/stamp.h"
#include "robot/drivers/descriptor.h"
#include "robot/robot.h"

namespace rubble::robot {

/// What lies behind a port. On all but Tcp a bit rate can be set, but only on an Uart do bytes take their time by it: a
/// pty and USB's own class of serial lines (ttyACM) pass them on at once.
enum class LineKind { Tcp, Pty, Usb, Uart };

/// How long `bytes` take over such a line at `baud` (8N1: ten bits a byte) [s].
inline double time_on_line(LineKind kind, double bytes, int baud) {
  return kind == LineKind::Uart && baud > 0 ? 10.0 * bytes / baud : 0.0;
}

/// How many bytes a read() took, and when: the one time by which a driver and the black box go, however long the thread
/// was kept waiting between the two.
struct Arrival {
  std::size_t size = 0;
  Stamp stamp;
};

/// Another program of this computer has the line. Whoever waits for it would take the device over when that one ends,
/// so nobody does before a run.
class PortBusy : public DeviceLost {
 public:
  using DeviceLost::DeviceLost;
};

/// The other side of a TCP connection hung up soon after it was made. Unless the device itself had answered by then,
/// another program has it (a serial server turns the second client away, some with a line of text), or none is
/// connected there.
class TurnedAway : public DeviceLost {
 public:
  TurnedAway(const std::string& what, std::string otherwise) : DeviceLost(what), otherwise_(std::move(otherwise)) {}
  /// What to say in what()'s place when the device had answered.
  const std::string& otherwise() const { return otherwise_; }

 private:
  std::string otherwise_;
};

/// A line to a device: bytes either way. One thread may read while another writes.
class Port {
 public:
  virtual ~Port() = default;
  /// Waits up to `timeout` [s] for bytes and takes at most `size` of them; size 0: none came. Throws DeviceLost
  /// when the device is gone.
  virtual Arrival read(std::uint8_t* to, std::size_t size, double timeout) = 0;
  /// Sends all bytes; `now` is what the sender took for the time when it decided to. Throws DeviceLost when the device
  /// is gone or takes nothing for half a second.
  virtual void write(const std::uint8_t* from, std::size_t size, Stamp now) = 0;
  /// For poll(): readable when bytes wait or the device is gone.
  virtual int descriptor() const = 0;
  /// The word that opened it, `tcp:127.0.0.1:10940`.
  virtual const std::string& name() const = 0;
  /// Bit rate of a serial line, 8N1; without effect on TCP. Throws InputError on a rate that no serial line has.
  virtual void set_baud(int baud) = 0;
  virtual LineKind kind() const = 0;
  /// Whether a bit rate can be set: a serial line or a pty.
  bool is_serial() const { return kind() != LineKind::Tcp; }
  /// When it was opened.
  virtual Stamp opened() const = 0;
};

/// Opens the device side's other end: `/dev/ttyUSB0` (any path of a serial line), `pty:PATH` or `tcp:HOST:PORT`. A
/// serial line is raw, 8N1, without flow control, at 115200 baud, and what waited in it is thrown away. A line belongs
/// to one program of this computer; a device on TCP turns others away by itself, which read() and write() tell
/// (TurnedAway). Throws InputError on a word of another form, PortBusy when another program has it and DeviceLost when
/// nothing answers there.
std::unique_ptr<Port> open_port(const std::string& word);

/// The line belongs to this program for as long as the claim lives, also while its device is unplugged; without one,
/// only for as long as it is open. Other programs are known by the same path, or TCP address and number. May be moved.
class PortClaim {
 public:
  /// Throws PortBusy when another program of this computer has the line, or this one has claimed it; what cannot be
  /// opened at all is no matter here.
  explicit PortClaim(const std::string& word);
  ~PortClaim();
  PortClaim(PortClaim&& other) noexcept = default;
  PortClaim& operator=(PortClaim&&) = delete;

 private:
  std::vector<std::string> names_;
  std::vector<Descriptor> locks_;
};

/// Throws InputError unless `word` names a port that open_port can be asked for; opens nothing. Number 0 is for ports
/// that are served.
void check_port_word(const std::string& word);

}  // namespace rubble::robot
