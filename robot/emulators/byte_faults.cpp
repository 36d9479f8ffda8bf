#include "robot/emulators/byte_faults.h"

#include <algorithm>

namespace rubble::robot {

std::optional<ByteFault> byte_fault(const std::string& name) {
  if (name == "lost") return ByteFault::Lost;
  if (name == "split") return ByteFault::Split;
  if (name == "doubled") return ByteFault::Doubled;
  if (name == "junk") return ByteFault::Junk;
  if (name == "sums") return ByteFault::WrongSum;
  return std::nullopt;
}

std::string BadLine::junk() {
  std::string bytes(1 + rng_.below(40), '\0');
  for (char& c : bytes) c = static_cast<char>(rng_.below(256));
  return bytes;
}

std::vector<std::string> BadLine::spoil(const std::string& bytes, ByteFault fault) {
  if (bytes.empty()) return {};
  std::string changed = bytes;
  switch (fault) {
    case ByteFault::None:
      return {bytes};
    case ByteFault::Lost: {
      const std::size_t at = somewhere(bytes);
      changed.erase(at, 1 + rng_.below(8));
      return changed.empty() ? std::vector<std::string>{} : std::vector<std::string>{changed};
    }
    case ByteFault::Split: {
      std::size_t cut[2] = {somewhere(bytes), somewhere(bytes)};
      std::sort(cut, cut + 2);
      std::vector<std::string> pieces = {bytes.substr(0, cut[0]), bytes.substr(cut[0], cut[1] - cut[0]),
                                         bytes.substr(cut[1])};
      pieces.erase(std::remove(pieces.begin(), pieces.end(), std::string()), pieces.end());
      return pieces;
    }
    case ByteFault::Doubled: {
      const std::size_t at = somewhere(bytes), size = 1 + rng_.below(8);
      changed.insert(at, bytes.substr(at, size));
      return {changed};
    }
    case ByteFault::Junk:
      changed.insert(somewhere(bytes), junk());
      return {junk() + changed};
    case ByteFault::WrongSum: {
      const std::size_t at = somewhere(bytes);
      changed[at] = static_cast<char>(changed[at] ^ 1);
      return {changed};
    }
  }
  return {bytes};
}

}  // namespace rubble::robot
