#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "base/image/geotiff.h"

namespace cv {
class Mat;
}

namespace rubble {

/// What stands around the picture of a map, north up, as all such pictures have it: axes, legend, scale bar.

using Bgr = std::array<std::uint8_t, 3>;  ///< blue, green, red, as OpenCV keeps them

template <class Colour>
Bgr bgr_of(const Colour& colour) {
  return {colour[0], colour[1], colour[2]};
}

constexpr Bgr kInkBgr{40, 34, 30};  ///< of words, ticks and bars
constexpr int kLeastWidth = 360;    ///< of a picture, for its legend [pixels]

/// Pixels a cell such that a map of usual size can be read and a huge one still fits a screenful or two.
int pixels_per_cell(const GridFrame& frame);

void draw_text(cv::Mat& picture, const std::string& words, int x, int y);
int text_width(const std::string& words);  ///< [pixels]
/// Words on a light ground of their own, that stay legible whatever is drawn there.
void draw_label(cv::Mat& picture, const std::string& words, int x, int y);

/// Puts axes with the map's metres at the left of a picture, which shows `frame` from its upper left corner on, and
/// below it. `scale`: pixels a cell.
void put_axes(cv::Mat& picture, const GridFrame& frame, int scale);

/// A piece of the legend, drawn from `x` on around the row `y`.
struct StripItem {
  int width = 0;
  std::function<void(int x, int y)> draw;
};

/// How a colour is shown, as the picture draws what it stands for: a field of it, a field in four or sixteen parts or
/// with stripes, a ring, a dot, a cross, an arrow, two of them.
enum class Sign { Field, Quarters, Grid, Stripes, Ring, Dot, Cross, Arrow, Arrows };

struct LegendEntry {
  template <class Colour>
  LegendEntry(const Colour& shown, std::string meaning, Sign drawn = Sign::Field)
      : colour(bgr_of(shown)), words(std::move(meaning)), sign(drawn) {}

  Bgr colour;
  std::string words;
  Sign sign;
};

std::vector<StripItem> legend_items(cv::Mat& picture, const std::vector<LegendEntry>& entries);

/// A bar of all colours from share 0 to 1, the words of its ends beside them.
StripItem bar_item(cv::Mat& picture, const std::string& least, const std::string& most,
                   const std::function<Bgr(double share)>& colour);

/// Puts the legend below the picture, in as many rows as it takes, and a scale bar at the right of the last one. Only
/// then is the picture as high as it will be: nothing else is drawn later.
void put_strip(cv::Mat& picture, const std::vector<StripItem>& items, const GridFrame& frame, int scale);
void draw_legend(cv::Mat& picture, const std::vector<LegendEntry>& entries, const GridFrame& frame, int scale);

/// Below a picture that may be huge and is no OpenCV's, as wide as the picture. `metre`: pixels.
void draw_legend(RgbImage& picture, const std::vector<LegendEntry>& entries, double metre);
/// The frame of a picture that is no grid's, of which the scale bar asks only how large a pixel is.
GridFrame frame_of_pixels(double metre);

}  // namespace rubble
