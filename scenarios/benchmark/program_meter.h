#pragma once

#include <sys/types.h>

#include <optional>
#include <vector>

namespace rubble::scenarios {

/// CPU time and memory of a mapper that is another program, with all processes of its own: those below the guardian
/// that stands between it and this process (slam/process/guardian.h), found in /proc. This process must
/// have no other children meanwhile.
class ProgramMeter {
 public:
  /// Before the program is started.
  ProgramMeter();

  /// Looks at it as it is now, which costs time of this process alone.
  void look();
  /// The same once it has ended.
  void look_back();

  /// Up to the last look, never less than at the one before; nothing: none was found [s].
  const std::optional<double>& cpu_seconds() const { return cpu_seconds_; }
  /// The most that its processes held, each at its own time; the most of any look.
  const std::optional<double>& peak_mb() const { return peak_mb_; }

 private:
  void find();
  void note(double cpu_seconds);

  std::vector<pid_t> children_;   ///< guardians
  std::vector<pid_t> processes_;  ///< what lives below them
  double earlier_ = 0.0;          ///< what children before it took [s]
  long newest_ = -1;              ///< process of the machine, as of the last search
  std::optional<double> cpu_seconds_;
  std::optional<double> peak_mb_;
};

}  // namespace rubble::scenarios
