#pragma once

#include <optional>
#include <string>

#include "base/image/geotiff.h"
#include "scoring/maps/colours/tone_curve.h"

namespace rubble::scoring {

/// The change of all tones (gamma; contrast and brightness) of a league map that was blended or went through JPEG
/// afterwards: no colour holds to the digit any more, but the squares of the checkerboard and even floor do nearly.
/// Nothing of pictures without such squares, or with squares as the league's.
std::optional<ToneCurve> tone_curve_before_loss(const RgbImage& image);

/// The picture with the tones of before. Brightness goes the way back; colours that JPEG smeared or that were blended
/// are mixtures, so that of them only a linear map is taken, which makes the changed wall's the wall's, and the changed
/// searched floor's that of searched floor.
RgbImage before_tones_and_loss(const RgbImage& image, const ToneCurve& curve);

/// How much of the wall's blue a curve leaves, 1: as much as the league's.
double wall_colour_left(const ToneCurve& curve);

/// By how much of 255 a curve leaves white lighter than the checkerboard's lighter squares: 18 in the league's colours.
int white_over_squares(const ToneCurve& curve);

/// What the checkerboard of a league map says against its colours: its squares are not the league's. Empty: nothing.
std::string doubt_about_tones(const RgbImage& image);

}  // namespace rubble::scoring
