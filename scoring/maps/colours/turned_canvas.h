#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// What lies around a map that was turned.
struct TurnedCanvas {
  cv::Mat mask;     ///< 255 there; empty: none was found
  int ground = -1;  ///< grey of the map's own margin, which goes on beyond; -1: it has none
};

/// Canvas of the walls' own grey around a grey map (CV_8U): all beyond a tilted rectangle has the grey of the image's
/// four corners, and within it that grey has drawn lines. Walls may stand close to it, or hang on to it.
TurnedCanvas canvas_of_the_walls_grey(const cv::Mat& grey);

}  // namespace rubble::scoring
