#pragma once

#include <cstddef>
#include <cstdint>

#include "base/image/geotiff.h"
#include "scoring/maps/colours/league_palette.h"

/// What single pixels of a league map may be, blended or not, and counts of them.
namespace rubble::scoring::league {

struct Colour {
  int r = 0, g = 0, b = 0;
  constexpr Colour(const Rgb& c) : r(c[0]), g(c[1]), b(c[2]) {}
};

inline Rgb rgb_of(const std::uint8_t* p) { return {p[0], p[1], p[2]}; }

/// Difference of its largest and its smallest channel.
int spread(const Colour& c);

/// In each channel.
bool near_colour(const Colour& a, const Colour& b, int tolerance);

/// Light grey as in the checkerboard, or a mixture of its two shades.
bool looks_unexplored(const Colour& c);

/// As bright as a colour looks.
constexpr int brightness(const Colour& c) { return (299 * c.r + 587 * c.g + 114 * c.b) / 1000; }

/// Share of wall blue in a mixture with a grey: blue over red grows from grey to wall, green over red a third as fast.
/// With white it is lightest: what is lighter is a symbol's blue on searched floor.
double wall_share(const Colour& c);

/// Calls visit(colour, x, y, length) for each run of pixels of one colour in a row: maps are areas, and to ask what
/// each pixel means by itself takes most of the time of reading one.
template <class Visit>
void each_run(const RgbImage& image, const Visit& visit) {
  for (int y = 0; y < image.height; ++y) {
    int first = 0;
    const auto same = [&](int x) {
      const std::uint8_t* const p = image.pixel(first, y);
      const std::uint8_t* const q = image.pixel(x, y);
      return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    };
    for (int x = 1; x <= image.width; ++x) {
      if (x < image.width && same(x)) continue;
      visit(Colour(rgb_of(image.pixel(first, y))), first, y, x - first);
      first = x;
    }
  }
}

struct Census {
  std::size_t walls = 0;
  std::size_t pure_walls = 0;
  std::size_t blended_walls = 0;  ///< with other ground
  std::size_t checkerboard = 0;
  std::size_t darker = 0;      ///< of the checkerboard's squares
  std::size_t unexplored = 0;  ///< checkerboard or as light
  std::size_t pixels = 0;
  void count(const Colour& c, std::size_t count);
  /// Never turned, scaled or compressed with loss: the colours of the table hold to the digit.
  bool exact() const {
    return checkerboard > 0 && 10 * checkerboard >= 9 * unexplored && 10 * pure_walls >= 9 * walls &&
           5 * blended_walls <= walls;
  }
};

/// Of the picture as `change` makes its colours: large ones are not copied for a question.
template <class Change>
Census census_of(const RgbImage& image, const Change& change) {
  Census out;
  each_run(image, [&](const Colour&, int first, int y, int length) {
    auto count = static_cast<std::size_t>(length);
    if (!image.alpha.empty())
      for (int x = first; x < first + length; ++x) count -= image.alpha[image.index(x, y)] < 128 ? 1 : 0;
    out.count(change(rgb_of(image.pixel(first, y))), count);
  });
  return out;
}

Census census(const RgbImage& image);

}  // namespace rubble::scoring::league
