#pragma once

#include <string>
#include <vector>

namespace rubble::scenarios {

/// How much of what a drive recorded came out of its raw bytes again.
struct RawReplay {
  struct Kind {
    std::string name;          ///< "scans", ...
    std::size_t recorded = 0;  ///< in the log
    std::size_t replayed = 0;  ///< out of the bytes: more, for they begin before the first tick
    std::size_t same = 0;      ///< of the recorded: with the same bits and stamp, in their order
  };
  std::vector<Kind> kinds;
  std::size_t bad_sums = 0;   ///< of the base
  std::size_t jumps = 0;      ///< of its odometry
  std::size_t bad_lines = 0;  ///< of the levelling unit
  std::size_t damaged_scans = 0;
  bool identical = true;  ///< all that was recorded came out again
};

/// Plays devices.bytes of a run folder to the drivers and compares with the folder's log. Numbers and stamps
/// must be the same bits. Throws InputError, also where nothing was recorded that could be compared.
RawReplay replay_raw(const std::string& run_folder);

}  // namespace rubble::scenarios
