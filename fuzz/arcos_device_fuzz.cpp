// What a client may send to the emulated base, with measurements in between: never faster than its limits.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "robot/emulators/arcos_emulator.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rubble;
  using namespace rubble::robot;
  ArcosEmulator base{ArcosEmulatorSettings{}};
  Stamp now{0};
  base.client_came(now);
  Odometry odometry;
  for (std::size_t at = 0; at < size;) {
    const std::size_t length = data[at] % 64u;
    const std::uint8_t what = at + 1 < size ? data[at + 1] : std::uint8_t{0};
    at += 2;
    if (at >= size) break;
    const std::size_t piece = std::min(length, size - at);
    now = now + 0.001 * what;
    base.receive({reinterpret_cast<const char*>(data + at), piece}, now);
    at += piece;
    base.advance(now);
    const Drive& drive = base.motion();
    // The configuration's top values: 1.2 m/s and 300 deg/s.
    if (!(std::abs(drive.v) <= 1.2001 && std::abs(drive.w) <= 5.24)) std::abort();
    if (what % 2 == 0) {
      odometry.stamp = now;
      odometry.pose.x += 0.1 * drive.v;
      odometry.pose.phi = wrap_angle(odometry.pose.phi + 0.1 * drive.w);
      odometry.v = drive.v;
      odometry.w = drive.w;
      base.measure(odometry, now);
    }
    if (what == 0xFF) base.client_left(now);
    base.take_output();
    base.take_placed();
  }
  return 0;
}
