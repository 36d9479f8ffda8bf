#pragma once

#include <cstddef>

#include "explore/plan/traversable.h"

namespace rubble::explore {

/// How much floor was known at a moment: what was given up then is worth another try once it has grown.
class KnownGround {
 public:
  void mark(const Traversable& floor);
  void forget() { cells_ = 0; }
  bool marked() const { return cells_ > 0; }
  /// At least 1 m^2 more is known now.
  bool grown(const Traversable& floor) const;
  /// Nothing was given up so far, or it has grown since.
  bool worth_a_try(const Traversable& floor) const { return !marked() || grown(floor); }

 private:
  std::size_t cells_ = 0;
};

}  // namespace rubble::explore
