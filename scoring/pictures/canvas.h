#pragma once

#include <mrpt/math/TPoint2D.h>

#include <opencv2/core.hpp>
#include <string>

#include "base/grid.h"
#include "base/image/legend.h"

namespace rubble::scoring {

using Colour = cv::Vec3b;  ///< blue, green, red

const Colour kInk(kInkBgr.data());
const Colour kDisplaced(40, 150, 225);
const Colour kMapOnly(48, 48, 214);
const Colour kTruthOnly(205, 110, 20);
const Colour kNotJudged(150, 150, 150);
const Colour kBothFree(255, 255, 255);
const Colour kMapFree(222, 226, 248);
const Colour kTruthFree(248, 234, 218);
const Colour kFound(40, 150, 30);  ///< victims
const Colour kSeam(170, 40, 150);
const Colour kUnknown(206, 206, 206);

/// A picture of a metric frame, north up. Axes and a legend are put around it when all else is drawn.
struct Canvas {
  explicit Canvas(const GridFrame& map_frame);
  int map_rows() const { return frame.height * scale; }
  int map_columns() const { return frame.width * scale; }
  /// Metric position of the centre of a pixel.
  mrpt::math::TPoint2D point(int column, int row) const {
    return {frame.x0 + (column + 0.5) * frame.resolution / scale,
            frame.y0 + (map_rows() - row - 0.5) * frame.resolution / scale};
  }
  cv::Point pixel(const mrpt::math::TPoint2D& p) const;

  GridFrame frame;
  int scale;
  cv::Mat image;
};

/// `share` 0: a, 1: b.
Colour mixed(const Colour& a, const Colour& b, double share);

/// A band over the picture's top that nobody overlooks, as many lines as the words take.
void draw_warning(Canvas& canvas, const std::string& words);

}  // namespace rubble::scoring
