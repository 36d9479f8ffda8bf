#pragma once

#include <algorithm>
#include <mutex>
#include <optional>

#include "base/stamp.h"

namespace rubble::robot {

constexpr double kKeepsUp = 1.0;  ///< what was too old must be fresh for so long [s]

/// Whether what comes is fresh enough to drive by. Once it was not, it must be so for a while: at the very edge the
/// robot would stop and go with every scan. May be asked by several threads.
class Freshness {
 public:
  /// `age`: of the newest scan, or by how much answers are late [s]; `most` of it is fresh. `missing`: there was none
  /// at all for so long.
  void look(double age, double most, Stamp now, bool missing = false) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (age > most) {
      stale_ = true;
      stale_at_ = std::max(stale_at_, now);
      age_ = age;
      missing_ = missing;
    } else if (stale_ && now - stale_at_ >= kKeepsUp) {
      stale_ = false;
    }
  }
  /// The age that was too much [s]; nothing: it is fresh.
  std::optional<double> stale() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stale_ ? std::optional(age_) : std::nullopt;
  }
  /// The same, of what was missing.
  bool missing() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stale_ && missing_;
  }

 private:
  mutable std::mutex mutex_;
  bool stale_ = false;
  bool missing_ = false;
  Stamp stale_at_ = Stamp::never();  ///< when it was so last
  double age_ = 0.0;                 ///< [s]
};

}  // namespace rubble::robot
