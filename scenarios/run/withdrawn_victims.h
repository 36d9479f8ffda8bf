#pragma once

#include <algorithm>
#include <vector>

#include "base/planar.h"
#include "explore/victim_report.h"

namespace rubble::scenarios {

/// Counts the victims that an explorer was sure of and later no more: whoever told a judge of them at once reported
/// them falsely. One that moves on the map stays itself, and one that it has under another number is there all the
/// same.
class WithdrawnVictims {
 public:
  static constexpr double kSame = 1.2;  ///< so near it is the same, as for the judge [m]

  /// What it is sure of now.
  void note(const std::vector<explore::VictimReport>& victims) {
    for (const explore::VictimReport& before : sure_of_)
      count_ += std::none_of(victims.begin(), victims.end(),
                             [&](const explore::VictimReport& now) {
                               return now.id == before.id || distance(now.p_map, before.p_map) <= kSame;
                             })
                    ? 1
                    : 0;
    sure_of_ = victims;
  }
  int count() const { return count_; }

 private:
  std::vector<explore::VictimReport> sure_of_;
  int count_ = 0;
};

}  // namespace rubble::scenarios
