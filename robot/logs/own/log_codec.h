#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "robot/commands.h"
#include "robot/logs/log.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// Kinds of frames; the first byte of a payload. Readers pass over kinds they do not know.
enum class FrameKind : char { Header = 'H', Tick = 'T', Commands = 'C', Codes = 'K', Battery = 'B' };

/// Appends one whole frame each.
void append_header_frame(std::string& out, const LogHeader& header);
void append_commands_frame(std::string& out, const Commands& commands);

/// Times and scan geometry are written relative to the tick before, so encoder and decoder each keep a little state.
struct TickContext {
  Stamp last_now;
  LaserScan last_geometry;  ///< without ranges
};
/// The codes of the scans of the tick that is appended next; nothing where no scan has any. Written as runs.
void append_codes_frame(std::string& out, const Inputs& inputs);
/// What was told of the battery in the tick that is appended next; nothing where there was none.
void append_battery_frame(std::string& out, const Inputs& inputs);
void append_tick_frame(std::string& out, const Inputs& inputs, TickContext& context);

/// The inverse; `payload` with its kind byte. Throws BadPayload.
LogHeader decode_header(std::string_view payload);
Commands decode_commands(std::string_view payload);
/// One list a scan of the tick that follows.
std::vector<std::vector<std::uint8_t>> decode_codes(std::string_view payload);
/// Of the tick that follows.
BatteryState decode_battery(std::string_view payload);
Inputs decode_tick(std::string_view payload, TickContext& context);

}  // namespace rubble::robot
