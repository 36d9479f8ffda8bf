#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "robot/drivers/descriptor.h"
#include "robot/emulators/emulated_device.h"
#include "robot/emulators/line_faults.h"
#include "robot/emulators/port_server.h"

namespace rubble::robot {

/// Serves an emulated device on a port, in a thread of its own.
class DeviceServer {
 public:
  /// Opens the port. Throws InputError and RunError as serve_port does.
  DeviceServer(const std::string& port, EmulatedDevice& device, std::uint64_t seed);
  ~DeviceServer();
  DeviceServer(const DeviceServer&) = delete;
  DeviceServer& operator=(const DeviceServer&) = delete;

  /// The word for clients, with the true port number.
  const std::string& port() const { return port_; }

  /// Calls `use()` while the thread leaves the device alone; what the device has to say then is sent at once.
  template <class Use>
  void with(const Use& use) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      use();
    }
    wake();
  }

  /// For `duration` [s] all that the device sends is spoilt so.
  void spoil(ByteFault fault, double duration);
  /// For `duration` [s] the device neither hears nor speaks.
  void fall_silent(double duration);
  /// For `duration` [s] every byte takes `way` [s] either way; the order of the bytes stays.
  void slow_down(double duration, double way = kSlowWay);
  static constexpr double kSlowWay = 0.5;  ///< [s]
  /// The plug is pulled and comes back after `duration` [s].
  void unplug(double duration);

 private:
  void run();
  void turn();
  void replug(Stamp now);
  void wake();
  void hear(std::string bytes, Stamp now);
  void queue(const std::vector<std::string>& pieces, Stamp now);
  void send(Stamp now);
  int wait_ms() const;

  /// What leaves at `due`, one after the other.
  struct Piece {
    Stamp due;
    std::string bytes;
  };

  EmulatedDevice& device_;
  std::unique_ptr<PortServer> server_;
  std::string port_;
  Descriptor wake_;
  std::mutex mutex_;
  bool ending_ = false;
  LineFaults faults_;
  Stamp unplug_until_ = Stamp::never();
  bool unplugged_ = false;
  Stamp slow_until_ = Stamp::never();
  double slow_way_ = kSlowWay;  ///< [s]
  std::deque<Piece> outgoing_;  ///< the thread's own
  std::deque<Piece> incoming_;  ///< the same, of the client's bytes
  std::thread thread_;
};

}  // namespace rubble::robot
