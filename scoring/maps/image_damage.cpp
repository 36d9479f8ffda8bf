#include "scoring/maps/image_damage.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <string_view>

#include "base/text/input_file.h"

namespace rubble::scoring {
namespace {

/// Big-endian number of `count` bytes.
std::size_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
  return value;
}

bool has_png_end(std::string_view bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    if (bytes.substr(at + 4, 4) == "IEND") return true;
    at += 12 + number_at(bytes, at, 4);
  }
  return false;
}

/// Walks from marker to marker (ITU-T T.81, B.1): previews inside of segments have an EOI of their own.
bool has_jpeg_end(std::string_view bytes) {
  constexpr unsigned char kEndOfImage = 0xD9;
  constexpr unsigned char kTemporary = 0x01;
  for (std::size_t at = 2; at + 2 <= bytes.size();) {
    const auto byte = static_cast<unsigned char>(bytes[at]);
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (byte != 0xFF || marker == 0xFF) {  // coded pixels, fill bytes
      ++at;
    } else if (marker == kEndOfImage) {
      return true;
    } else if (marker == 0x00 || marker == kTemporary || (marker >= 0xD0 && marker <= 0xD8)) {  // no segment follows
      at += 2;
    } else {
      if (at + 4 > bytes.size()) return false;
      at += 2 + number_at(bytes, at + 2, 2);
    }
  }
  return false;
}

}  // namespace

bool is_cut_short(const std::string& path) {
  InputFile file(path, image_rules());
  std::string bytes(8, '\0');
  bytes.resize(file.read(bytes.data(), 8));
  const bool is_png = bytes == "\x89PNG\r\n\x1a\n";
  const bool is_jpeg = bytes.compare(0, 3, "\xFF\xD8\xFF") == 0;
  if (!is_png && !is_jpeg) return false;
  bytes += file.rest();
  return is_png ? !has_png_end(bytes) : !has_jpeg_end(bytes);
}

StderrCapture::StderrCapture() {
  std::fflush(stderr);
  file_ = memfd_create("stderr", MFD_CLOEXEC);
  if (file_ < 0) return;
  stderr_ = dup(STDERR_FILENO);
  if (stderr_ >= 0) dup2(file_, STDERR_FILENO);
}

StderrCapture::~StderrCapture() {
  std::fflush(stderr);
  if (stderr_ >= 0) {
    dup2(stderr_, STDERR_FILENO);
    close(stderr_);
  }
  if (file_ >= 0) close(file_);
}

std::string StderrCapture::text() const {
  std::fflush(stderr);
  std::string out;
  char buffer[4096];
  for (ssize_t n = 0; file_ >= 0 && (n = pread(file_, buffer, sizeof buffer, static_cast<off_t>(out.size()))) > 0;)
    out.append(buffer, static_cast<std::size_t>(n));
  return out;
}

bool tells_of_damage(const std::string& printed) {
  for (const char* words : {"Corrupt JPEG data", "Premature end", "Bogus", "bad Huffman code", "Invalid SOS",
                            "Inconsistent progression", "libpng error", "CRC error"})
    if (printed.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace rubble::scoring
