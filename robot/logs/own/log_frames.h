#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rubble::robot {

/// First line of our log; the number is the format's version.
constexpr std::string_view kLogMagic = "RUBBLE LOG 1\n";
constexpr std::string_view kLogMagicStem = "RUBBLE LOG ";

/// Opens a frame at the end of `out`; the payload is appended to `out` next. Returns the place close_frame() needs.
std::size_t open_frame(std::string& out);
/// Fills in length and checks of the frame opened at `start`.
void close_frame(std::string& out, std::size_t start);

struct Frames {
  std::vector<std::string_view> payloads;
  std::vector<std::size_t> ends;  ///< byte offset behind each frame
  bool torn = false;              ///< a last frame that was being written when the run died is left out
};

/// Splits the bytes of a log behind its magic line into whole, checked frames. Throws InputError with byte offset and
/// remedy: other version, damage before the last frame.
Frames split_frames(std::string_view bytes, const std::string& path);

}  // namespace rubble::robot
