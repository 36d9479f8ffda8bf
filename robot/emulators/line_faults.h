#pragma once

#include <string>
#include <vector>

#include "base/stamp.h"
#include "robot/emulators/byte_faults.h"

namespace rubble::robot {

/// A line that is bad for a while: spoilt bytes, or none at all.
class LineFaults {
 public:
  explicit LineFaults(std::uint64_t seed) : line_(seed) {}

  void spoil(ByteFault fault, Stamp until);
  /// Nothing passes, either way.
  void fall_silent(Stamp until) { silent_until_ = until; }
  bool is_silent(Stamp now) const { return now < silent_until_; }
  /// The pieces that arrive in place of `bytes`.
  std::vector<std::string> pass(const std::string& bytes, Stamp now);

 private:
  BadLine line_;
  ByteFault fault_ = ByteFault::None;
  Stamp until_ = Stamp::never();
  Stamp silent_until_ = Stamp::never();
};

}  // namespace rubble::robot
