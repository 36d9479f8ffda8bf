#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rubble::scoring {

/// What the header of an image says, before anything is unpacked.
struct ImageHeader {
  std::int64_t width = 0;   ///< [pixels]
  std::int64_t height = 0;  ///< [pixels]
};

/// Width and height in the header of a PNG, JPEG, BMP or PNM file (its beginning is enough, of a JPEG all up to its
/// frame header). Nothing for other formats, or where the header is not whole.
std::optional<ImageHeader> image_header(std::string_view bytes);

/// Scans of a JPEG, all of whose bytes are given: each goes over the whole picture when it is unpacked, and an empty
/// one takes sixteen bytes.
std::size_t jpeg_scans(std::string_view bytes);

/// The name of another format that files begin like this: "a GIF", "a PDF"; empty: none that is known.
std::string other_format(std::string_view bytes);

}  // namespace rubble::scoring
