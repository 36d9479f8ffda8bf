#include "robot/emulators/byte_faults.h"

#include <map>

namespace rubble::robot {
namespace {

constexpr double kSilence = 2.0;  ///< [s]
constexpr double kDamage = 1.0;   ///< the other faults last so long [s]
constexpr std::size_t kMostJunk = 40;

}  // namespace

std::optional<ByteFault> byte_fault(const std::string& name) {
  static const std::map<std::string, ByteFault> names = {
      {"lost", ByteFault::Lost}, {"split", ByteFault::Split}, {"doubled", ByteFault::Doubled},
      {"junk", ByteFault::Junk}, {"sums", ByteFault::Sums},   {"silence", ByteFault::Silence}};
  const auto found = names.find(name);
  return found == names.end() ? std::nullopt : std::optional<ByteFault>(found->second);
}

void ByteFaults::begin(ByteFault fault, Stamp now) {
  fault_ = fault;
  until_ = now + (fault == ByteFault::Silence ? kSilence : kDamage);
}

std::size_t ByteFaults::place(const std::string& bytes) { return rng_.below(static_cast<std::uint32_t>(bytes.size())); }

std::vector<std::string> ByteFaults::damage(const std::string& bytes, Stamp now) {
  if (fault_ && now >= until_) fault_.reset();
  if (!fault_ || bytes.empty()) return {bytes};
  std::string out = bytes;
  switch (*fault_) {
    case ByteFault::Silence:
      return {};
    case ByteFault::Doubled:
      return {bytes, bytes};
    case ByteFault::Lost: {
      out.erase(place(out), 1 + rng_.below(4));
      return {out};
    }
    case ByteFault::Sums: {
      const std::size_t at = place(out);
      out[at] = static_cast<char>(out[at] ^ (1 << rng_.below(7)));
      return {out};
    }
    case ByteFault::Junk: {
      std::string junk(1 + rng_.below(kMostJunk), '\0');
      for (char& c : junk) c = static_cast<char>(rng_.below(256));
      return {junk + out};
    }
    case ByteFault::Split:
      break;
  }
  std::vector<std::string> pieces;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t size = 1 + rng_.below(16);
    pieces.push_back(bytes.substr(at, size));
    at += size;
  }
  return pieces;
}

}  // namespace rubble::robot
