#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image/geotiff.h"
#include "scoring/maps/colours/league_palette.h"

namespace rubble::scoring {

/// What an image editor may have done to all channels of a league map alike.
struct ToneCurve {
  enum class Kind { Gamma, Line };     ///< Line: contrast and brightness
  std::array<std::uint8_t, 256> of{};  ///< what each value became
  std::string name;                    ///< "gamma 1.5"
  Kind kind = Kind::Line;
};

/// What free floor looks like, and what the league draws it in: white, or searched.
struct FloorTone {
  Rgb now;
  Rgb own;
};

/// Curves (gamma; contrast and brightness, clipped at both ends) that make two greys of the league's checkerboard and
/// what is seen now of its floor, to `rounding` of a channel, the likeliest first.
std::vector<ToneCurve> tone_curves(const Rgb& darker, const Rgb& lighter, const FloorTone& floor, int rounding = 1);

/// Undoes a curve: the league's own colour where one of them became this, else of each channel the value that comes
/// nearest. Both are looked up: a JPEG has thousands of colours, and many curves are tried on it.
class BeforeCurve {
 public:
  explicit BeforeCurve(const ToneCurve& curve);
  Rgb operator()(const Rgb& colour) const;

 private:
  std::array<std::uint8_t, 256> before_{};
  std::array<Rgb, league::kAll.size()> leagues_{};  ///< what they became
};

}  // namespace rubble::scoring
