#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/stamp.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/port.h"

namespace rubble::robot {

/// First line of a black box; the number is the format's version.
constexpr const char* kBlackBoxMagic = "RUBBLE BYTES 1\n";

/// Turn: the thread of the device looked at the line, had nothing to read, and did what was due. Boxes of older
/// versions have none.
enum class Direction : std::uint8_t { FromDevice = 0, ToDevice = 1, Opened = 2, Lost = 3, BitRate = 4, Turn = 5 };

/// Some bytes on the line of a device.
struct BlackBoxEntry {
  std::string device;
  Direction direction = Direction::FromDevice;
  Stamp stamp;
  /// Of Opened the port's name, a line feed and what kind of line it is (see line_kind); of Lost the reason; of BitRate
  /// the rate in decimal digits.
  std::string bytes;
};

/// Keeps all raw bytes of all devices with their times, so that what happened in the field can be played to the drivers
/// again. A thread of its own writes them as they come, so that no driver, and no stop, waits for a slow disk; a torn
/// last entry is dropped on reading. For any number of threads.
class BlackBox {
 public:
  /// An existing file is replaced. Throws RunError when `path` cannot be written.
  explicit BlackBox(const std::string& path);
  /// Waits until all is written.
  ~BlackBox();
  /// Failures to write are kept quiet: a full disk must not stop a robot's drivers, nor may one that takes nothing for
  /// long fill the memory (kMostWaiting). `failure()` tells.
  void add(const std::string& device, Direction direction, std::string_view bytes, Stamp stamp);
  /// Whether so many bytes of a device may be kept: kMostRate for ever, kMostBurst at once. Whatever sends more is none
  /// of the devices, and would fill the disk.
  bool admits(const std::string& device, std::size_t bytes, Stamp now);
  /// Why something was lost, and what to do about it; empty: nothing was. Waits until all that was added is written.
  std::string failure();
  bool failed() { return !failure().empty(); }
  /// The devices of which bytes were left out since they sent too many (see admits).
  std::vector<std::string> cut_short();

  static constexpr double kMostRate = 1e6;   ///< [bytes/s]; serial lines and the devices send a tenth of it
  static constexpr double kMostBurst = 2e6;  ///< [bytes]
  static constexpr std::size_t kMostWaiting = 16u << 20;  ///< [bytes]: ten minutes of all devices

 private:
  void write();

  std::mutex mutex_;
  std::condition_variable changed_;
  Descriptor file_;
  struct Allowance {
    double bytes = kMostBurst;
    bool exceeded = false;
    Stamp at = Stamp::never();
  };
  std::map<std::string, Allowance> allowances_;  ///< by device, over all its connections
  std::string waiting_;
  bool writing_ = false;
  bool ending_ = false;
  std::string failure_;
  std::thread writer_;
};

/// All whole entries of a black box in their order. Throws InputError: missing, of another kind.
std::vector<BlackBoxEntry> read_black_box(const std::string& path);

/// What kind of line an entry Opened tells of.
LineKind line_kind(const BlackBoxEntry& opened);

/// Opens a port whose bytes go to `box` (null: nowhere) under the device's name.
std::unique_ptr<Port> open_recorded(const std::string& word, const std::string& device, BlackBox* box);

}  // namespace rubble::robot
