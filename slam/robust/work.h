#pragma once

#include <cstdint>

namespace rubble::slam {

/// Effort, counted by what is done and never by a clock, so that the same measurements cost the same everywhere. One
/// unit takes about a nanosecond of a small server's core.
using Work = std::int64_t;

}  // namespace rubble::slam
