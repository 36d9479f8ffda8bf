#pragma once

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/stamp.h"
#include "robot/measurements.h"

namespace rubble::explore {

/// Covariance of a place in the map [m^2].
struct PlaceCovariance {
  double xx = 0.0, xy = 0.0, yy = 0.0;

  PlaceCovariance operator+(const PlaceCovariance& o) const { return {xx + o.xx, xy + o.xy, yy + o.yy}; }
  PlaceCovariance operator*(double s) const { return {s * xx, s * xy, s * yy}; }
};

/// Standard deviation along the worse axis [m].
inline double worst_sigma(const PlaceCovariance& c) {
  const double mean = 0.5 * (c.xx + c.yy);
  return std::sqrt(std::max(0.0, mean + std::hypot(0.5 * (c.xx - c.yy), c.xy)));
}

/// What a victim that was confirmed is called, wherever people read of it.
inline std::string victim_name(int id) { return "victim " + std::to_string(id); }

/// A victim as the explorer believes in it.
struct VictimReport {
  int id = 0;                        ///< 1, 2, ... in the order of confirmation
  mrpt::math::TPoint2D p_map;        ///< [m]
  Stamp stamp;                       ///< of the confirmation
  double confidence = 0.0;           ///< 0..1
  std::vector<robot::CueKind> cues;  ///< kinds seen, ascending
  PlaceCovariance covariance;        ///< of p_map: of its cues, and of the poses they were sensed from
};

/// The senses that told of a victim: "appearance heat".
inline std::string senses(const VictimReport& victim) {
  static constexpr std::array<const char*, 4> kKinds = {"appearance", "heat", "sound", "co2"};
  std::string text;
  for (const robot::CueKind kind : victim.cues)
    text += (text.empty() ? "" : " ") + std::string(kKinds.at(static_cast<std::size_t>(kind)));
  return text;
}

}  // namespace rubble::explore
