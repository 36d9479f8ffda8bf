#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rng.h"
#include "base/stamp.h"

namespace rubble::robot {

constexpr double kSplitPause = 0.005;  ///< between the pieces of a split reply [s]

/// What goes wrong with the bytes of a line.
enum class ByteFault { None, Lost, Split, Doubled, Junk, WrongSum };

/// Does to whole replies what a bad line does; which bytes it meets is drawn from the seed.
class BadLine {
 public:
  explicit BadLine(std::uint64_t seed) : rng_(seed, "bad line") {}

  /// The pieces that are sent in place of `bytes`; with Split they are to be sent kSplitPause apart.
  std::vector<std::string> spoil(const std::string& bytes, ByteFault fault);

 private:
  std::size_t somewhere(const std::string& bytes) { return rng_.below(static_cast<std::uint32_t>(bytes.size())); }
  std::string junk();

  Rng rng_;
};

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
