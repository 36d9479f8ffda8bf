// Both ends of the levelling unit's line, each fed with whatever a wire brings.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "robot/drivers/levelling_unit.h"
#include "robot/emulators/levelling_emulator.h"

namespace {

void require(bool law) {
  if (!law) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rubble;
  using namespace rubble::robot;
  LevellingUnit driver{LevellingUnitSettings{}};
  LevellingEmulator unit{LevellingEmulatorSettings{}};
  Stamp now{1'000'000'000};
  driver.opened(now, LineKind::Uart);
  unit.client_came(now);
  Stamp last = Stamp::never();
  for (std::size_t at = 0; at < size;) {
    const std::size_t length = data[at] % 128u;
    now = now + 0.001 * (at + 1 < size ? data[at + 1] : 0);
    at += 2;
    if (at >= size) break;
    const std::size_t piece = std::min(length, size - at);
    const std::string_view bytes{reinterpret_cast<const char*>(data + at), piece};
    at += piece;
    driver.receive(bytes, now);
    unit.receive(bytes, now);
    driver.aim({0.01 * static_cast<double>(length), 0.0});
    driver.advance(now);
    unit.advance(now);
    unit.measure({now, 0.1, -0.1}, {now, unit.aim().pitch, unit.aim().roll}, now);
    driver.take_output(now);
    unit.take_output();
    require(std::abs(unit.aim().pitch) < 1.0 && std::abs(unit.aim().roll) < 1.0);
    for (const Acceleration& a : driver.take_accelerations()) {
      require(std::isfinite(a.x) && std::isfinite(a.y) && a.stamp <= now);
      require(last == Stamp::never() || a.stamp > last);
      last = a.stamp;
    }
    driver.take_aims();
  }
  return 0;
}
