#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image/geotiff.h"

namespace rubble {

/// One of the few whole numbers that a file holds.
struct SampleLabel {
  double value = 0.0;
  std::uint8_t grey = 0;  ///< 0 (wall), 255 (free), 128 (neither) by what its samples usually mean; if they mean any
};

/// What a file says of its samples beside the colours made of them.
struct SampleNotes {
  std::vector<std::uint8_t> no_data;  ///< 1 where the file says that there is none; empty: nowhere
  std::string meaning;  ///< not empty: samples of this meaning became 0 (wall), 255 (free) and between (neither)
  /// Not empty: the samples are these few whole numbers, in order, and a pixel's grey is the place of its own.
  std::vector<SampleLabel> labels{};
  /// The samples are no colours.
  bool are_measured() const { return !meaning.empty() || !labels.empty(); }
};

/// A TIFF with what matters to maps of others only.
struct RichTiff {
  GeoTiff tiff;
  SampleNotes notes;
  int orientation = 1;  ///< TIFF Orientation: how a viewer turns the picture; 1: not at all
  int page = 1;         ///< the one read, from 1: the largest
  int pages = 1;        ///< of the file
};

/// As read_geotiff(). Floating and signed samples are P(occupied) (0..1), per cent (0..100), both with -1 and NaN
/// unknown, or grey levels (0..255); others are refused. Up to eight whole numbers are labels, unless they are greys.
RichTiff read_rich_tiff(const std::string& path, const Rgb& behind = {255, 255, 255});

/// The picture as its orientation (TIFF, EXIF; 1 to 8, others: as it is) wants it to be looked at.
RgbImage upright(const RgbImage& image, int orientation);
/// The same of the picture and its notes; the orientation is 1 then.
void turn_upright(RichTiff& tiff);

/// The GeoTransform of a .aux.xml beside an image; nothing where it has none. Throws InputError.
std::optional<PixelToModel> read_aux_xml(const std::string& path);

}  // namespace rubble
