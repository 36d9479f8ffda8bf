#include "scoring/maps/image_header.h"

#include <algorithm>
#include <cstdlib>

namespace rubble::scoring {
namespace {

std::int64_t byte_at(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

std::int64_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = 256 * value + byte_at(bytes, at + i);
  return value;
}

std::int64_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::int64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = 256 * value + byte_at(bytes, at + i);
  return value;
}

std::optional<ImageHeader> png(std::string_view bytes) {
  if (bytes.size() < 24 || bytes.substr(12, 4) != "IHDR") return std::nullopt;
  return ImageHeader{big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
}

/// ITU-T T.81, B.2.2: SOF0 to SOF15 without DHT, JPG and DAC.
bool is_frame(std::int64_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

std::optional<ImageHeader> jpeg(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    const std::int64_t marker = byte_at(bytes, at + 1);
    if (byte_at(bytes, at) != 0xFF || marker == 0xFF) {
      ++at;
    } else if (is_frame(marker)) {
      return ImageHeader{big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
    } else if (marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD8)) {
      at += 2;
    } else {
      at += 2 + static_cast<std::size_t>(big_endian(bytes, at + 2, 2));
    }
  }
  return std::nullopt;
}

std::optional<ImageHeader> bmp(std::string_view bytes) {
  if (bytes.size() < 26) return std::nullopt;
  if (little_endian(bytes, 14, 4) == 12) return ImageHeader{little_endian(bytes, 18, 2), little_endian(bytes, 20, 2)};
  const auto number = [&](std::size_t at) {
    return std::int64_t{static_cast<std::int32_t>(static_cast<std::uint32_t>(little_endian(bytes, at, 4)))};
  };
  return ImageHeader{number(18), std::abs(number(22))};  // rows from the top down have a height below 0
}

/// Width and height in decimal behind the magic, between them white space and comments.
std::optional<ImageHeader> pnm(std::string_view bytes) {
  std::int64_t numbers[2] = {0, 0};
  std::size_t at = 2;
  for (std::int64_t& number : numbers) {
    while (at < bytes.size() && (bytes[at] == '#' || bytes[at] == ' ' || (bytes[at] >= '\t' && bytes[at] <= '\r'))) {
      if (bytes[at] == '#') at = std::min(bytes.find('\n', at), bytes.size() - 1);
      ++at;
    }
    if (at >= bytes.size() || bytes[at] < '0' || bytes[at] > '9') return std::nullopt;
    for (; at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9'; ++at)
      number = std::min<std::int64_t>(10 * number + (bytes[at] - '0'), std::int64_t{1} << 40);
  }
  return ImageHeader{numbers[0], numbers[1]};
}

}  // namespace

std::optional<ImageHeader> image_header(std::string_view bytes) {
  if (bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n") return png(bytes);
  if (bytes.substr(0, 3) == "\xFF\xD8\xFF") return jpeg(bytes);
  if (bytes.substr(0, 2) == "BM") return bmp(bytes);
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return pnm(bytes);
  return std::nullopt;
}

std::size_t jpeg_scans(std::string_view bytes) {
  constexpr std::int64_t kStartOfScan = 0xDA;
  std::size_t scans = 0;
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    const std::int64_t marker = byte_at(bytes, at + 1);
    if (byte_at(bytes, at) != 0xFF || marker == 0xFF) {
      ++at;  // what a scan holds, or filling
    } else if (marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD9)) {
      at += 2;
    } else {
      scans += marker == kStartOfScan ? 1 : 0;
      at += 2 + static_cast<std::size_t>(big_endian(bytes, at + 2, 2));
    }
  }
  return scans;
}

std::string other_format(std::string_view bytes) {
  const auto has = [&](std::size_t at, std::string_view magic) {
    return bytes.size() >= at && bytes.substr(at, magic.size()) == magic;
  };
  const auto begins = [&](std::string_view magic) { return has(0, magic); };
  if (begins("GIF8")) return "a GIF";
  if (begins("RIFF") && has(8, "WEBP")) return "a WebP picture";
  if (has(4, "jP  ") || begins("\xFF\x4F\xFF\x51")) return "a JPEG 2000 picture";
  if (begins("\x59\xA6\x6A\x95")) return "a Sun raster";
  if (begins("%PDF")) return "a PDF";
  if (begins("%!PS")) return "PostScript";
  if (begins("8BPS")) return "a Photoshop file";
  if (begins("gimp xcf")) return "a GIMP file";
  if (begins("\x76\x2F\x31\x01")) return "an OpenEXR picture";
  if (begins("#?RADIANCE")) return "a Radiance picture";
  if (begins("P7")) return "a PAM";
  if (begins("PF\n") || begins("Pf\n")) return "a PFM";
  if (begins("II*") || begins("II+") || begins(std::string_view("MM\0*", 4)))
    return "a TIFF that is not called .tif or .tiff";
  if (begins("PK\x03\x04")) return "a ZIP archive";
  if (has(4, "ftyp")) return "a HEIF or AVIF picture";
  if (bytes.substr(0, 512).find("<svg") != std::string_view::npos) return "an SVG drawing";
  // Targa has no magic: types of colour map and picture, and bits a pixel.
  if (bytes.size() > 18) {
    const std::int64_t map = byte_at(bytes, 1), type = byte_at(bytes, 2), bits = byte_at(bytes, 16);
    const bool is_type = type == 1 || type == 2 || type == 3 || type == 9 || type == 10 || type == 11;
    if (map <= 1 && is_type && (bits == 8 || bits == 16 || bits == 24 || bits == 32)) return "a Targa picture";
  }
  return "";
}

}  // namespace rubble::scoring
