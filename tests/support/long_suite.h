#pragma once

#include <cstddef>
#include <cstdlib>

namespace rubble {

/// Whether this combination of the entries of a test's lists (sum of their numbers) is tried. The long suite
/// (tests/nightly.sh sets RUBBLE_LONG) tries all; the daily one a third of them, in which each entry of a list stands
/// beside every third of each other (of pictures in windows a ninth).
inline bool is_tried(std::size_t sum) {
  static const bool all = std::getenv("RUBBLE_LONG") != nullptr;
  return all || sum % 3 == 0;
}

/// How many of `cases` of the long suite a daily one has at least.
inline int at_least(int cases) { return is_tried(1) ? cases : cases / 3; }

}  // namespace rubble
