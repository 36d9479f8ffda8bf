#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace rubble::scoring {

/// A picture of few greys in which dots stood for those between.
struct Undithered {
  cv::Mat grey;      ///< CV_8U: walls as they were, of each ground one grey
  std::string how;   ///< "dots of two greys read as those between"
  std::string lost;  ///< why the picture cannot be read; empty: it can
};

/// Gives back the greys that a dither (error diffusion, Floyd & Steinberg 1976, or ordered, Bayer 1973) has drawn as
/// dots: each pixel's is the mean of the ground around it, no farther than walls let it reach. Walls are what is solid
/// in the darkest grey. Nothing of pictures that have more greys than printers or palettes of old, or hardly any dots.
/// `grey`: CV_8U.
std::optional<Undithered> without_dither(const cv::Mat& grey);

}  // namespace rubble::scoring
