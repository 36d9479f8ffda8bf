#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace rubble::scoring {

/// A picture in greys whose brightness falls off slowly over it, as in a photograph, without that.
struct EvenLight {
  cv::Mat grey;
  int differed = 0;  ///< ground of one kind, over the picture [of 255]
};

/// Finds ground that is connected by small steps and yet differs much. Where a surface of the second degree explains
/// that, each pixel is divided by it; nothing where it does not, since a map may have many shades of sure and unsure.
std::optional<EvenLight> with_even_light(const cv::Mat& grey);

}  // namespace rubble::scoring
