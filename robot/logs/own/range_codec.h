#pragma once

#include <string>
#include <vector>

#include "base/bytes.h"

namespace rubble::robot {

/// Appends a scan's ranges, bit-exact, about one byte a beam on smooth walls: whole millimetres are coded as the
/// difference to the last one, misses and missing measurements as runs, everything else as four raw bytes.
/// docs/robot.md lists the codes.
void encode_ranges(const std::vector<float>& ranges, std::string& out);

/// Takes `beams` ranges back. Throws BadPayload.
std::vector<float> decode_ranges(ByteReader& bytes, std::size_t beams);

}  // namespace rubble::robot
