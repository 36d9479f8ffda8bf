#include "robot/emulators/line_faults.h"

namespace rubble::robot {

void LineFaults::spoil(ByteFault fault, Stamp until) {
  fault_ = fault;
  until_ = until;
}

std::vector<std::string> LineFaults::pass(const std::string& bytes, Stamp now) {
  if (bytes.empty() || is_silent(now)) return {};
  return now < until_ ? line_.spoil(bytes, fault_) : std::vector<std::string>{bytes};
}

}  // namespace rubble::robot
