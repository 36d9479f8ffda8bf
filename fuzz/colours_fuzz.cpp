// What the colours of a map's picture mean, as an editor may have changed them. The input: how wide, how its values are
// changed, and runs of a colour, each with its length.
#include "scoring/maps/colours/map_colours.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "fuzz/harness.h"
#include "scoring/maps/colours/league_palette.h"

RUBBLE_FUZZ_TARGET {
  using namespace rubble;
  namespace league = scoring::league;
  constexpr std::size_t kMostPixels = 40000;
  constexpr int kTile = 12;            // squares of the checkerboard [pixels]
  constexpr std::uint8_t kBoard = 13;  // this colour is one of its two, by the place
  constexpr std::array<Rgb, 13> kInks{league::kWall,   league::kUnexplored, league::kUnexploredLight,
                                      league::kFree,   league::kGridLine,   league::kPath,
                                      league::kStart,  league::kVictim,     league::kUnconfirmedVictim,
                                      league::kHazard, league::kQrCode,     league::kScale,
                                      league::kTitle};
  if (size < 5) return 0;
  const std::size_t width = 1u + data[0];
  const int gain = data[1], offset = data[2] - 128;
  std::vector<std::uint8_t> runs;
  for (std::size_t at = 3; at + 1 < size && runs.size() < kMostPixels; at += 2)
    runs.insert(runs.end(), 4u * data[at + 1] + 1u, data[at]);
  const std::size_t height = std::min(runs.size(), kMostPixels) / width;
  if (height == 0) return 0;
  RgbImage image(static_cast<int>(width), static_cast<int>(height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t ink = runs[image.index(x, y)];
      const bool is_light = (x / kTile + y / kTile) % 2 == 0;
      const Rgb colour = ink < kInks.size() ? kInks[ink]
                         : ink == kBoard    ? (is_light ? league::kUnexploredLight : league::kUnexplored)
                                            : Rgb{ink, ink, static_cast<std::uint8_t>(ink ^ (ink & 1))};
      for (std::size_t i = 0; i < 3; ++i)  // 128 and 128: as it was
        image.pixel(x, y)[i] = static_cast<std::uint8_t>(std::clamp(colour[i] * gain / 128 + offset, 0, 255));
    }
  const scoring::ClassImage read = scoring::classify(image);
  if (read.classes.width() != image.width || read.classes.height() != image.height) std::abort();
  for (const Occupancy what : read.classes.cells())
    if (what != Occupancy::Unknown && what != Occupancy::Free && what != Occupancy::Occupied) std::abort();
  return 0;
}
