#pragma once

#include <mrpt/math/TPoint2D.h>

#include <array>
#include <functional>
#include <vector>

#include "arenas/model/arena.h"
#include "base/image/geotiff.h"

namespace rubble::arenas {

using Colour = std::array<double, 3>;  ///< red, green, blue, 0..255

/// Paints shapes given in metres, north up, with smooth edges (each pixel is the mean of 4 x 4 samples).
class Canvas {
 public:
  /// The picture shows min..max [m].
  Canvas(const mrpt::math::TPoint2D& min, const mrpt::math::TPoint2D& max, double pixels_per_metre,
         const Colour& paper);

  /// Fills a convex outline; `opacity` 0..1.
  void fill(const Outline& outline, const Colour& colour, double opacity = 1.0);
  /// The same with a colour for each place.
  void fill(const Outline& outline, const std::function<Colour(const mrpt::math::TPoint2D&)>& colour);
  void disc(const mrpt::math::TPoint2D& centre, double radius, const Colour& colour, double opacity = 1.0);
  /// A line with square ends, `width` [m].
  void line(const mrpt::math::TPoint2D& from, const mrpt::math::TPoint2D& to, double width, const Colour& colour,
            double opacity = 1.0);
  /// An arrow from tail to tip with a filled head.
  void arrow(const mrpt::math::TPoint2D& tail, const mrpt::math::TPoint2D& tip, double width, const Colour& colour,
             double opacity = 1.0);

  RgbImage image() const;

 private:
  mrpt::math::TPoint2D to_samples(const mrpt::math::TPoint2D& p) const;
  template <class Paint>
  void for_samples(const Outline& outline, const Paint& paint);
  void blend(int x, int y, const Colour& colour, double opacity);

  mrpt::math::TPoint2D min_;
  double scale_;  ///< samples a metre
  int width_;     ///< [pixels]
  int height_;
  std::vector<std::array<float, 3>> samples_;  ///< row 0 at the top
};

}  // namespace rubble::arenas
