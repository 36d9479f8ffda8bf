#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/model.h"

namespace rubble::robot {

// The body as what it meets sees it: what stops it in the simulator, and what a judge of the run says that it touched.

/// The housing of the laser, the highest part, ends so far above its beams [m].
inline constexpr double kAboveLaser = 0.05;
/// Where body and obstacle overlap by less in height they pass each other [m].
inline constexpr double kGraze = 0.01;

/// Height of the body above the floor that it stands on [m].
inline double body_height(const RobotModel& model) { return model.T_base_laser.z + kAboveLaser; }

/// The corners of the body are cut by so much of its length.
inline constexpr double kCornerCut = 0.1;

/// The body from above, seen from the base, counter-clockwise: a rectangle with cut corners, `skin` [m] smaller on all
/// sides. Number: what Point holds.
template <class Point, class Number>
std::array<Point, 8> body_outline(const RobotModel& model, double skin = 0.0) {
  const auto x = static_cast<Number>(0.5 * model.length - skin);
  const auto y = static_cast<Number>(0.5 * model.width - skin);
  const auto cut = static_cast<Number>(kCornerCut * model.length);
  return {Point{x, y - cut},  Point{x - cut, y},  Point{cut - x, y},  Point{-x, y - cut},
          Point{-x, cut - y}, Point{cut - x, -y}, Point{x - cut, -y}, Point{x, cut - y}};
}

/// How far a point (x, y), seen from the base, is from the body, below 0: inside it. Beside its corners a little less.
inline double to_body(const RobotModel& model, double x, double y) {
  const double ahead = std::abs(x) - 0.5 * model.length, aside = std::abs(y) - 0.5 * model.width;
  return std::max({ahead, aside, (ahead + aside + kCornerCut * model.length) * std::sqrt(0.5)});
}

}  // namespace rubble::robot
