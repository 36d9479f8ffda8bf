#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/rng.h"

namespace rubble::robot {

/// What goes wrong with the bytes of a line.
enum class ByteFault { None, Lost, Split, Doubled, Junk, WrongSum };

/// The fault of that name: `lost`, `split`, `doubled`, `junk`, `sums`.
std::optional<ByteFault> byte_fault(const std::string& name);

/// Does to whole replies what a bad line does; which bytes it meets is drawn from the seed.
class BadLine {
 public:
  explicit BadLine(std::uint64_t seed) : rng_(seed, "bad line") {}

  /// The pieces that are sent in place of `bytes`; with Split they are to be sent with pauses between them.
  std::vector<std::string> spoil(const std::string& bytes, ByteFault fault);

 private:
  std::size_t somewhere(const std::string& bytes) { return rng_.below(static_cast<std::uint32_t>(bytes.size())); }
  std::string junk();

  Rng rng_;
};

}  // namespace rubble::robot
