#pragma once

#include <cstdint>
#include <cstring>

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

}  // namespace rubble::explore
