#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "robot/drivers/black_box.h"
#include "robot/drivers/descriptor.h"
#include "robot/drivers/device.h"
#include "robot/drivers/port.h"

namespace rubble::robot {

/// Runs one device's conversation on its port in a thread of its own. Opens the port again and again after it was lost.
class DeviceThread {
 public:
  /// `each_turn` is called under the lock before time is let pass in the device: every 20 ms at the latest;
  /// `turned` after it, when what the device had to say has been sent. Throws InputError on a bad port word.
  DeviceThread(std::string name, std::string port, Device& device, BlackBox* box,
               std::function<void(Stamp)> each_turn = {}, std::function<void(Stamp)> turned = {});
  /// Sends the device's farewell and ends.
  ~DeviceThread();
  /// The same while the object goes on; a second call does nothing. May be called from any other thread.
  void end();
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  /// Calls `use()` while the thread leaves the device alone.
  template <class Use>
  auto with(const Use& use) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return use();
  }
  /// Lets the thread look at the device at once.
  void wake() const;

  const std::string& name() const { return name_; }
  /// Why the port is not open; empty while it is.
  std::string error() const;
  /// It is not open because another program of this computer has it.
  bool busy() const;
  /// How often another program seemed to have it. Waits for nobody.
  int turned_away() const { return turned_away_; }

 private:
  void run();
  void converse();
  void send(const std::string& bytes, Stamp now);
  void set_baud(int baud);
  bool is_ending() const;

  std::string name_;
  std::string word_;
  Device& device_;
  BlackBox* box_;
  std::function<void(Stamp)> each_turn_;
  std::function<void(Stamp)> turned_;
  Descriptor wake_;
  mutable std::mutex mutex_;
  bool ending_ = false;
  std::string error_;
  bool busy_ = false;
  std::atomic<int> turned_away_{0};
  std::unique_ptr<Port> port_;
  int baud_ = 0;
  std::mutex ending_mutex_;
  std::thread thread_;
};

}  // namespace rubble::robot
