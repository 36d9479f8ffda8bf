#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/logs/own/log_bytes.h"

namespace rubble::robot {

/// First line of our log; the number is the format's version.
constexpr std::string_view kLogMagic = "RUBBLE LOG 1\n";
constexpr std::string_view kLogMagicStem = "RUBBLE LOG ";

/// Opens a frame at the end of `out`; the payload is appended to `out` next. Returns the place close_frame() needs.
std::size_t open_frame(std::string& out);
/// Fills in length and checks of the frame opened at `start`.
void close_frame(std::string& out, std::size_t start);

/// Goes through the frames of a log behind its magic line, each checked.
class FrameReader {
 public:
  /// `bytes` is kept by the caller. Throws InputError with byte offset and remedy: not our log, another version.
  FrameReader(LogBytes& bytes, std::string path);
  /// The payload of the next whole frame, valid until the next call; nothing at the end. Throws InputError: damage
  /// before the last frame.
  std::optional<std::string_view> next();
  /// Where the frame that next() gave last begins, and ends [bytes].
  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }
  /// A last frame that was being written when the run died is left out.
  bool torn() const { return torn_; }

 private:
  bool zeros_from(std::size_t offset);

  LogBytes* bytes_;
  std::string path_;
  std::size_t begin_;
  std::size_t end_;
  bool torn_ = false;
};

struct Frames {
  std::vector<std::string_view> payloads;
  std::vector<std::size_t> ends;  ///< byte offset behind each frame
  bool torn = false;              ///< a last frame that was being written when the run died is left out
};

/// All frames of a log that is held, as a FrameReader finds them.
Frames split_frames(std::string_view bytes, const std::string& path);

}  // namespace rubble::robot
