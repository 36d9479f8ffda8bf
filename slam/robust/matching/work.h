#pragma once

#include <cstdint>

namespace rubble::slam {

/// Effort, counted by what is done and never by a clock, so that the same measurements cost the same everywhere. One
/// unit takes about a nanosecond of a small server's core.
using Work = std::int64_t;

inline constexpr Work kWorkPerDrawnFrame = 8000;  ///< a key frame's surfels drawn into a raster
inline constexpr Work kWorkPerJudged = 30;        ///< point and key frame that is asked whether it can be true

}  // namespace rubble::slam
