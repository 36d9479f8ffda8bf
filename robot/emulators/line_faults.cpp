#include "robot/emulators/line_faults.h"

#include <algorithm>

namespace rubble::robot {

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

void LineFaults::spoil(ByteFault fault, Stamp until) {
  fault_ = fault;
  until_ = until;
}

std::vector<std::string> LineFaults::pass(const std::string& bytes, Stamp now) {
  if (bytes.empty() || is_silent(now)) return {};
  return now < until_ ? line_.spoil(bytes, fault_) : std::vector<std::string>{bytes};
}

}  // namespace rubble::robot
