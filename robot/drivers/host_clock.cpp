#include "robot/drivers/host_clock.h"

#include <time.h>

#include <cerrno>

namespace rubble::robot {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

/// From the monotonic clock to the time since 1970 [ns].
std::int64_t offset() {
  static const std::int64_t value = read_clock(CLOCK_REALTIME) - read_clock(CLOCK_MONOTONIC);
  return value;
}

}  // namespace

Stamp host_now() {
  const std::int64_t since_1970 = offset();
  return {since_1970 + read_clock(CLOCK_MONOTONIC)};
}

double time_asleep() { return 1e-9 * static_cast<double>(read_clock(CLOCK_BOOTTIME) - read_clock(CLOCK_MONOTONIC)); }

void sleep_until(Stamp when) {
  const std::int64_t target = when.ns - offset();
  const timespec until{target / kSecond, target % kSecond};
  if (target <= 0) return;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace rubble::robot
