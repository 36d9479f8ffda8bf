#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "slam/process/message.h"

namespace rubble::slam {

/// A process that talks over its standard input and output, and ends with this object.
class ChildProcess : public ByteSource {
 public:
  /// It did not answer: it ended, or was silent for too long. what() says which, without naming the process.
  class Lost : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
  };

  /// `log`: file that takes its standard error; empty: goes where ours goes. Throws RunError.
  ChildProcess(const std::vector<std::string>& argv, const std::string& log);
  ~ChildProcess() override;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// From now on it has so many seconds for what is sent and read.
  void give_time(double seconds);
  /// Throws Lost.
  void send(std::string_view text);
  /// Throws Lost; never returns 0.
  std::size_t read(char* to, std::size_t at_most) override;
  /// Closes its input and waits until it has ended, or the time is over.
  void close_input();

 private:
  /// The one clock of slam. It only ends a run whose mapper hangs, and never decides what a result is.
  using Clock = std::chrono::steady_clock;

  int left_ms() const;
  [[noreturn]] void lost_by_time() const;
  [[noreturn]] void lost_by_end();
  void wait_for(bool writable, bool readable);
  bool drain();

  pid_t guardian_ = -1;
  int lifeline_ = -1;
  int to_ = -1;
  int from_ = -1;
  double seconds_ = 0.0;
  Clock::time_point deadline_;
  std::string early_;  ///< what it said while we were still sending
};

}  // namespace rubble::slam
