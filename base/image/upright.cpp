#include "base/image/rich_tiff.h"

namespace rubble {
namespace {

/// Sizes of a stored picture and the way it is looked at.
struct View {
  int width = 0;   ///< as stored
  int height = 0;  ///< as stored
  int orientation = 1;

  bool is_turned() const { return orientation >= 5 && orientation <= 8; }
  int upright_width() const { return is_turned() ? height : width; }
  int upright_height() const { return is_turned() ? width : height; }
  /// Index of the stored pixel that is seen at (x, y).
  std::size_t stored(int x, int y) const {
    int from_x = is_turned() ? y : x;
    int from_y = is_turned() ? x : y;
    const int o = orientation;
    if (o == 2 || o == 3 || o == 7 || o == 8) from_x = width - 1 - from_x;
    if (o == 3 || o == 4 || o == 6 || o == 7) from_y = height - 1 - from_y;
    return static_cast<std::size_t>(from_y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(from_x);
  }
};

using Bytes = std::vector<std::uint8_t>;

/// `depth` bytes a pixel; nothing stays nothing.
Bytes turned(const Bytes& from, const View& view, std::size_t depth) {
  Bytes out;
  if (from.empty()) return out;
  out.reserve(from.size());
  for (int y = 0; y < view.upright_height(); ++y)
    for (int x = 0; x < view.upright_width(); ++x) {
      const auto at = from.begin() + static_cast<std::ptrdiff_t>(depth * view.stored(x, y));
      out.insert(out.end(), at, at + static_cast<std::ptrdiff_t>(depth));
    }
  return out;
}

}  // namespace

RgbImage upright(const RgbImage& image, int orientation) {
  const View view{image.width, image.height, orientation};
  RgbImage out;
  out.width = view.upright_width();
  out.height = view.upright_height();
  out.rgb = turned(image.rgb, view, 3);
  out.alpha = turned(image.alpha, view, 1);
  out.white = image.white;
  return out;
}

void turn_upright(RichTiff& tiff) {
  const RgbImage& image = tiff.tiff.image;
  tiff.notes.no_data = turned(tiff.notes.no_data, {image.width, image.height, tiff.orientation}, 1);
  tiff.tiff.image = upright(image, tiff.orientation);
  tiff.orientation = 1;
}

}  // namespace rubble
