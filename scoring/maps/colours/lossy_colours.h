#pragma once

#include <cstddef>
#include <opencv2/core.hpp>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// No more colours than that, as pictures with a palette have.
bool has_few_colours(const RgbImage& image, std::size_t most);

/// Whether a league map went through JPEG: colours run out of their lines, so that there is about as much faintly
/// tinted ground as there is ink. Turned or scaled pictures have such pixels only at the rims of lines.
bool has_run_colours(const RgbImage& image);

/// The walls of such a map, CV_8U, 255 where wall. JPEG keeps brightness sharp but smears colour over 16 pixels: a wall
/// is a dark line around which the smeared colour, taken together and divided by the ink, is that of wall and not of
/// the path or a symbol. Surely dark pixels grow into less dark ones beside them.
cv::Mat walls_by_brightness(const RgbImage& image);

/// Its unexplored ground, CV_8U, 255 where the brightness in the middle of 5 x 5 pixels is that of the checkerboard.
cv::Mat unexplored_by_brightness(const RgbImage& image);

}  // namespace rubble::scoring
