#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace rubble {

/// A point in time: whole nanoseconds since the start of the run (simulator) or since 1970 (logs, hardware).
/// There is no `now()` here on purpose: time enters the program only through Robot::read.
struct Stamp {
  std::int64_t ns = 0;

  static Stamp from_seconds(double seconds) { return {static_cast<std::int64_t>(std::llround(seconds * 1e9))}; }
  static constexpr Stamp never() { return {std::numeric_limits<std::int64_t>::min()}; }
  double seconds() const { return static_cast<double>(ns) * 1e-9; }

  friend constexpr bool operator==(Stamp a, Stamp b) { return a.ns == b.ns; }
  friend constexpr bool operator!=(Stamp a, Stamp b) { return a.ns != b.ns; }
  friend constexpr bool operator<(Stamp a, Stamp b) { return a.ns < b.ns; }
  friend constexpr bool operator<=(Stamp a, Stamp b) { return a.ns <= b.ns; }
  friend constexpr bool operator>(Stamp a, Stamp b) { return a.ns > b.ns; }
  friend constexpr bool operator>=(Stamp a, Stamp b) { return a.ns >= b.ns; }
};

/// Time from b to a [s].
inline double operator-(Stamp a, Stamp b) { return static_cast<double>(a.ns - b.ns) * 1e-9; }
inline Stamp operator+(Stamp a, double seconds) { return {a.ns + Stamp::from_seconds(seconds).ns}; }
inline Stamp operator-(Stamp a, double seconds) { return {a.ns - Stamp::from_seconds(seconds).ns}; }

}  // namespace rubble
