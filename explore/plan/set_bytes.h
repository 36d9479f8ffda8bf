#pragma once

#include <cstdint>
#include <cstring>

#include "base/grid.h"

namespace rubble::explore {

/// Calls visit(i) for every byte of `bytes` that is not zero, in order; eight zeros at a time are passed over.
template <class Visit>
void for_each_set(const std::uint8_t* bytes, int count, Visit visit) {
  for (int i = 0; i < count;) {
    std::uint64_t eight = 1;
    if (i + 8 <= count) std::memcpy(&eight, bytes + i, 8);
    if (eight == 0) {
      i += 8;
      continue;
    }
    const int end = i + 8 < count ? i + 8 : count;
    for (; i < end; ++i)
      if (bytes[i] != 0) visit(i);
  }
}

/// Calls visit(x) for every occupied cell of a row in [from, to), in order. Of most floor few are: eight others at a
/// time are passed over.
template <class Visit>
void for_each_occupied(const Occupancy* row, int from, int to, Visit visit) {
  constexpr std::uint64_t kOccupied = 0x0101010101010101U * static_cast<std::uint64_t>(Occupancy::Occupied);
  static_assert(sizeof(Occupancy) == 1 && (kOccupied & static_cast<std::uint64_t>(Occupancy::Free)) == 0);
  for (int x = from; x < to;) {
    std::uint64_t eight = kOccupied;
    if (x + 8 <= to) std::memcpy(&eight, row + x, 8);
    if ((eight & kOccupied) == 0) {
      x += 8;
      continue;
    }
    const int end = x + 8 < to ? x + 8 : to;
    for (; x < end; ++x)
      if (row[x] == Occupancy::Occupied) visit(x);
  }
}

}  // namespace rubble::explore
