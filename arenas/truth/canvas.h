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
  /// The picture shows min..max [m]. What is painted is kept for some of its rows only (the samples of a whole one take
  /// 64 times the bytes of its pixels): begin with those from `first_row` on, at most `rows` of them.
  Canvas(const mrpt::math::TPoint2D& min, const mrpt::math::TPoint2D& max, double pixels_per_metre, const Colour& paper,
         int first_row, int rows);

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

  int width() const { return width_; }    ///< [pixels]
  int height() const { return height_; }  ///< of the whole picture [pixels]
  /// Copies the painted rows to their place in the whole picture.
  void copy_to(RgbImage& picture) const;

 private:
  mrpt::math::TPoint2D to_samples(const mrpt::math::TPoint2D& p) const;
  template <class Paint>
  void for_samples(const Outline& outline, const Paint& paint);
  void blend(int x, int y, const Colour& colour, double opacity);

  mrpt::math::TPoint2D min_;
  double scale_;  ///< samples a metre
  int width_;     ///< [pixels]
  int height_;
  int first_row_;                              ///< of those that are kept [pixels]
  int rows_;                                   ///< that are kept [pixels]
  std::vector<std::array<float, 3>> samples_;  ///< of the kept rows, the topmost first
};

}  // namespace rubble::arenas
