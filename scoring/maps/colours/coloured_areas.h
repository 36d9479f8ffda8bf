#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// A map with coloured ground in greys: walls 0, all that is unknown 128 and all that is free 255.
struct GreyedAreas {
  cv::Mat grey;     ///< CV_8U
  std::string how;  ///< "areas of 5 colours"
};

/// Of pictures that cover areas with colours (rooms each in its own, colour schemes of viewers): grounds are the
/// colours of even areas, walls the lines that stand out most from them, blended or not; lines of other colours are
/// drawn over the ground. The ground on the picture's rim is unknown, with what lies around all the rest (a page, a
/// window, a frame). Nothing of greys, of areas without walls between them, of two grounds where greys tell the walls
/// or JPEG smeared them, and where no ground has the rim.
std::optional<GreyedAreas> greys_of_coloured_areas(const RgbImage& image, const cv::Mat& apart);

}  // namespace rubble::scoring
