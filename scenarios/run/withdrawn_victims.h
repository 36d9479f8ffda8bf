#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "explore/victim_report.h"

namespace rubble::scenarios {

/// Counts the victims that an explorer was sure of and later no more: whoever told a judge of them at once reported
/// them falsely. One that moves on the map stays itself.
class WithdrawnVictims {
 public:
  /// What it is sure of now.
  void note(const std::vector<explore::VictimReport>& victims) {
    std::vector<int> now;
    for (const explore::VictimReport& victim : victims) now.push_back(victim.id);
    for (const int id : sure_of_) count_ += std::find(now.begin(), now.end(), id) == now.end() ? 1 : 0;
    sure_of_ = std::move(now);
  }
  int count() const { return count_; }

 private:
  std::vector<int> sure_of_;  ///< by id
  int count_ = 0;
};

}  // namespace rubble::scenarios
