#pragma once

#include <optional>
#include <string>

#include "base/image/geotiff.h"
#include "scoring/maps/colours/blur.h"

namespace rubble::scoring {

/// Whether the image carries the RoboCupRescue GeoTIFF colours: blue walls or the checkerboard of unexplored space.
bool is_league_map(const RgbImage& image);

/// A league map whose colours were changed as a whole, with the league's own.
struct RestoredColours {
  RgbImage image;
  std::string how;        ///< what had been done to it
  Blur blur{};            ///< that of it which was a blur
  bool as_drawn = false;  ///< its colours are back but for rounding; those of strength and blur are guesses
  std::string doubt{};    ///< what that may have cost; empty: nothing
};

/// Of pictures whose red and blue were exchanged, that were inverted, that were blurred, whose colours were made
/// stronger, or whose contrast was taken down; nothing of others. Exchanged and inverted ones must come out exact,
/// checkerboard and walls.
std::optional<RestoredColours> restored_league_colours(const RgbImage& image);

/// Why a picture with the league's checkerboard cannot be read: a change of its colours left nobody who could tell its
/// walls (from grey alone: the robot's way) from other lines. Empty: it can, or it is no such picture. `is_league`: of
/// is_league_map().
std::string why_colours_are_lost(const RgbImage& image, bool is_league);

}  // namespace rubble::scoring
