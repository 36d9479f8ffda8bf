#include "robot/logs/own/log_frames.h"

#include <zlib.h>

#include <algorithm>

#include "base/bytes.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/text/shell.h"

namespace rubble::robot {
namespace {

// Length and CRC of the payload, then the CRC of these eight bytes: a damaged length is told from a torn frame.
constexpr std::size_t kHeadSize = 12;

bool all_zero(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) { return c == 0; });
}

void check_magic(std::string_view bytes, const std::string& path) {
  if (bytes.substr(0, kLogMagic.size()) == kLogMagic) return;
  const std::size_t line = bytes.find('\n');
  if (line == kLogMagic.size() && bytes[line - 1] == '\r')
    throw InputError(
        path + ": byte 12: a transfer as text changed the ends of its lines; copy the log again as a binary file");
  if (line != std::string_view::npos && bytes.substr(0, kLogMagicStem.size()) == kLogMagicStem) {
    const std::string version(bytes.substr(kLogMagicStem.size(), line - kLogMagicStem.size()));
    throw InputError(path + ": byte 0: a log of version '" + version.substr(0, 20) +
                     "', but this program reads version 1; replay it with the release that recorded it");
  }
  throw InputError(path + ": byte 0: the first line is not 'RUBBLE LOG 1'; give a log that 'rubble' recorded");
}

[[noreturn]] void fail_damaged(const std::string& path, std::size_t offset, const std::string& what) {
  // The first frame describes the robot: without it nothing that precedes can be read.
  const std::string keep = offset <= kLogMagic.size()
                               ? ""
                               : ", or keep what precedes the damage: head -c " + std::to_string(offset) + " " +
                                     shell_word(path) + " > part.log";
  throw InputError(path + ": byte " + std::to_string(offset) + ": " + what + "; copy the log again" + keep);
}

}  // namespace

std::size_t open_frame(std::string& out) {
  const std::size_t start = out.size();
  out.append(kHeadSize, '\0');
  return start;
}

void close_frame(std::string& out, std::size_t start) {
  const std::string_view payload = std::string_view(out).substr(start + kHeadSize);
  std::string head;
  ByteWriter writer(head);
  writer.u32(static_cast<std::uint32_t>(payload.size()));
  writer.u32(crc32_of(payload));
  writer.u32(crc32_of(head));
  out.replace(start, kHeadSize, head);
}

FrameReader::FrameReader(LogBytes& bytes, std::string path)
    : bytes_(&bytes), path_(std::move(path)), begin_(kLogMagic.size()), end_(kLogMagic.size()) {
  constexpr std::size_t kLongestFirstLine = 100;
  check_magic(bytes.at(0, std::min(bytes.size(), kLongestFirstLine)), path_);
}

std::optional<std::string_view> FrameReader::next() {
  const std::size_t rest = bytes_->size() - end_;
  if (rest == 0 || torn_) return std::nullopt;
  // A power cut can leave a tail of zeros where the file system had reserved space.
  torn_ = rest < kHeadSize || zeros_from(end_);
  if (torn_) return std::nullopt;
  const std::string_view head_bytes = bytes_->at(end_, kHeadSize);
  ByteReader head(head_bytes);
  const std::size_t length = head.u32();
  const std::uint32_t payload_crc = head.u32();
  if (head.u32() != crc32_of(head_bytes.substr(0, kHeadSize - 4))) {
    torn_ = zeros_from(end_ + kHeadSize);
    if (torn_) return std::nullopt;
    fail_damaged(path_, end_, "the frame's head is damaged");
  }
  torn_ = length > rest - kHeadSize;
  if (torn_) return std::nullopt;
  const std::string_view payload = bytes_->at(end_ + kHeadSize, length);
  if (crc32_of(payload) != payload_crc) {
    torn_ = zeros_from(end_ + kHeadSize + length);  // nothing follows: it was being written
    if (torn_) return std::nullopt;
    fail_damaged(path_, end_, "the frame fails its check");
  }
  begin_ = end_;
  end_ += kHeadSize + length;
  return payload;
}

bool FrameReader::zeros_from(std::size_t offset) {
  constexpr std::size_t kStep = 4096;
  for (; offset < bytes_->size(); offset += kStep)
    if (!all_zero(bytes_->at(offset, std::min(kStep, bytes_->size() - offset)))) return false;
  return true;
}

Frames split_frames(std::string_view bytes, const std::string& path) {
  SeenBytes seen(bytes);
  FrameReader reader(seen, path);
  Frames frames;
  while (const auto payload = reader.next()) {
    frames.payloads.push_back(*payload);
    frames.ends.push_back(reader.end());
  }
  frames.torn = reader.torn();
  return frames;
}

}  // namespace rubble::robot
