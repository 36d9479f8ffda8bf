#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "base/stamp.h"

namespace rubble::robot {

/// What a bad line does to the bytes on it, whatever they mean.
enum class ByteFault { Lost, Split, Doubled, Junk, Sums, Silence };

/// `lost`, `split`, `doubled`, `junk`, `sums`, `silence`; nothing for another word.
std::optional<ByteFault> byte_fault(const std::string& name);

/// Damages what a device sends for a while after a fault began. One seed, one damage.
class ByteFaults {
 public:
  explicit ByteFaults(std::uint64_t seed) : rng_(seed, "byte faults") {}
  void begin(ByteFault fault, Stamp now);
  /// The pieces to send instead of `bytes`, each on its own.
  std::vector<std::string> damage(const std::string& bytes, Stamp now);

 private:
  std::size_t place(const std::string& bytes);

  Rng rng_;
  std::optional<ByteFault> fault_;
  Stamp until_ = Stamp::never();
};

}  // namespace rubble::robot
