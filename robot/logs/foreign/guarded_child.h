#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace rubble::robot {

/// Limits of a guarded child.
struct ChildLimits {
  std::size_t memory = std::size_t{256} << 20;  ///< beyond what the parent holds [bytes]
  unsigned cpu_s = 60;                          ///< processor time [s]
  int silence_s = 60;                           ///< longest wait for the next record [s]
};

/// Runs `work` in a child process with bounded memory and time, for libraries that trust the lengths in a file: what
/// would end or starve the program then ends only the child. `work` hands records to its argument, `receive` gets them
/// in the parent, in order. The child prints nothing and cannot be interrupted but with the parent.
/// Returns nothing when the child ended well, else how it ended ("took more than 256 MB", "crashed").
/// Throws RunError when no process can be started; what `receive` throws ends the child and passes through.
std::string run_guarded(const ChildLimits& limits,
                        const std::function<void(const std::function<void(std::string_view)>&)>& work,
                        const std::function<void(std::string_view)>& receive);

}  // namespace rubble::robot
