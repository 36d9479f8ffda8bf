#pragma once

#include <string>

#include "base/image/rich_tiff.h"
#include "base/image/tiff_file.h"

namespace rubble {

/// The pixels of the TIFF's current page as they are stored (the orientation tag is ignored, as GDAL does).
/// Grey, black-and-white (either way round), palette and RGB of 1 to 16 bits are scaled to 8 bits here; other kinds
/// (YCbCr, CMYK) by libtiff. Deep samples that use only 8, 10, 12 or 14 bits are scaled from those,
/// others by their brightest sample (base/image/sample_range.h). Transparent pixels show what is `behind`, and `alpha`
/// says how far they do. Throws InputError: truncated, absurd size, Lab, deep samples of no known meaning
/// (rich_tiff.h).
RgbImage read_pixels(TIFF* tiff, const std::string& path, const TiffComplaint& complaint, const Rgb& behind,
                     SampleNotes& notes);

}  // namespace rubble
