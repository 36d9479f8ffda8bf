// The payloads of our own log behind the checksums, which keep random bytes from coming so far.
#include "base/bytes.h"
#include "fuzz/harness.h"
#include "robot/logs/own/log_codec.h"

RUBBLE_FUZZ_TARGET {
  using namespace rubble::robot;
  const std::string_view payload = rubble::fuzz::text_of(data, size);
  if (payload.empty()) return 0;
  TickContext context;
  try {
    switch (static_cast<FrameKind>(payload.front())) {
      case FrameKind::Header:
        decode_header(payload);
        break;
      case FrameKind::Tick:
        decode_tick(payload, context);
        break;
      case FrameKind::Commands:
        decode_commands(payload);
        break;
      case FrameKind::Codes:
        decode_codes(payload);
        break;
      case FrameKind::Battery:
        decode_battery(payload);
        break;
    }
  } catch (const rubble::BadPayload&) {
  }
  return 0;
}
