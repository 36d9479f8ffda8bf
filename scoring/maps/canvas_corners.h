#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// Sets to unknown what an image editor filled in when it turned the map: a region of one known class that reaches a
/// corner of the image, is broad, and borders on nothing but unknown. `classes`: CV_8U of Occupancy values.
void clear_canvas_corners(cv::Mat& classes);

}  // namespace rubble::scoring
