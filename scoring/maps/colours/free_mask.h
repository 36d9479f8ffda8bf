#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace rubble::scoring {

/// A picture in which free ground has one grey, and all else, walls and ground that was never seen, has another.
struct FreeMask {
  cv::Mat free;   ///< CV_8U, 255
  cv::Mat walls;  ///< CV_8U, 255: the rest as far from free ground as walls are thick
  std::string recognised;
  std::string doubt;  ///< in words
};

/// Told by shape and place, of pictures that have two greys and none between: the grey along most of the picture's rim
/// covers areas, and draws thin lines into the other one. Nothing: the picture is no mask. `grey`: CV_8U; `apart`: 255
/// where a pixel has no say.
std::optional<FreeMask> free_mask(const cv::Mat& grey, const cv::Mat& apart);

}  // namespace rubble::scoring
