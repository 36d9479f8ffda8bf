#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// Begins what a reader says of a picture that does not fit what it was read as.
inline constexpr const char* kDoubt = "; look at it: ";

/// How a picture was read.
struct Reading {
  cv::Mat classes;         ///< CV_8U, Occupancy values, row 0 at the top
  bool is_league = false;  ///< by the league's colours
  bool by_level = false;   ///< each of its colours was taken for one class: no line between them was guessed
  bool by_costs = false;   ///< its slopes are costs and were read as such, exactly where JPEG did not change them
  bool by_scale = false;   ///< values of a colour scale
};

/// What of a picture does not fit the classes that it was read as, kDoubt before each sentence; empty: it fits. The
/// sentences say what was measured: ground that fades towards its walls (costs around them, blur), drawings over walls,
/// more wall than floor, few colours. `as_drawn`: the same picture with the colours that it was drawn in, where these
/// were changed since; its colours are counted there.
std::string doubts_about(const RgbImage& image, const RgbImage& as_drawn, const Reading& read);

}  // namespace rubble::scoring
