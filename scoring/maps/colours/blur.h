#pragma once

#include "base/image/geotiff.h"

namespace rubble::scoring {

/// What blurred a drawing in full colours: a Gaussian, or what is much like one.
struct Blur {
  static constexpr double kMost = 4.0;  ///< [pixels]
  /// Standard deviation, 1 to kMost [pixels], kMost also where it is more; 0: none, edges are sharp.
  double sigma = 0.0;
  bool ripples = false;  ///< small steps up and down, as JPEG leaves them
};

/// Pictures with sharp edges are told at once; larger than 16 million pixels are not asked.
Blur blur_of(const RgbImage& image);

/// The picture with most of that undone (Wiener's filter): as if blurred by 0.6 pixels.
RgbImage without_blur(const RgbImage& image, const Blur& blur);

}  // namespace rubble::scoring
