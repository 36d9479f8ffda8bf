#pragma once

#include <mrpt/core/Clock.h>

#include "base/stamp.h"

namespace rubble::robot {

/// MRPT counts 100 ns since 1601 (0: no time); 1970 is this many of them later.
constexpr std::int64_t kMrptTicksTo1970 = 116444736000000000;

inline mrpt::Clock::time_point to_mrpt_time(Stamp stamp) {
  if (stamp == Stamp::never()) return mrpt::Clock::time_point{};
  const std::int64_t down = stamp.ns >= 0 ? stamp.ns / 100 : -((99 - stamp.ns) / 100);
  return mrpt::Clock::time_point(mrpt::Clock::duration(down + kMrptTicksTo1970));
}

/// No time at all, or one within 146 years of 1970: what fits into a Stamp, with room for differences.
inline bool is_plausible(mrpt::Clock::time_point time) {
  const std::int64_t ticks = time.time_since_epoch().count();
  constexpr std::int64_t kFarthest = (std::int64_t{1} << 62) / 100;
  return ticks == 0 || (ticks > kMrptTicksTo1970 - kFarthest && ticks < kMrptTicksTo1970 + kFarthest);
}

/// The time must be plausible.
inline Stamp from_mrpt_time(mrpt::Clock::time_point time) {
  const std::int64_t ticks = time.time_since_epoch().count();
  if (ticks == 0) return Stamp::never();
  return Stamp{(ticks - kMrptTicksTo1970) * 100};
}

}  // namespace rubble::robot
