// What a client may send to the emulated scanner, with turns in between: whole replies only, and never a crash.
#include <cstdlib>

#include "robot/emulators/scip/scip_device.h"

namespace {

using namespace rubble::robot;

void require_whole(const std::vector<std::string>& replies) {
  for (const std::string& reply : replies)
    if (reply.size() < 4 || reply.compare(reply.size() - 2, 2, "\n\n") != 0) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scip::Device device{scip::DeviceIdentity{}};
  double time = 1.0;
  std::size_t at = 0;
  // A byte above 0x7F is no letter of a client: it stands for time, turns and what else happens to a device.
  for (std::size_t i = 0; i <= size; ++i) {
    if (i < size && data[i] < 0x80) continue;
    require_whole(device.receive(data + at, i - at, time));
    at = i + 1;
    if (i == size) break;
    time += 0.001 * (data[i] & 0x3F);
    if (data[i] < 0xF0) require_whole(device.turn(time, std::vector<std::uint32_t>(data[i] * 6u, data[i] * 37u)));
    if (data[i] == 0xF0) device.client_left();
    if (data[i] == 0xF1) device.cycle_power(time);
    if (data[i] == 0xF2) device.set_clock(time, (1u << 24) - 5);
  }
  return 0;
}
