#include "arenas/elements/rough_shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/rng.h"

namespace rubble::arenas {
namespace {

void add_platform(const ElementFrame& frame, double x0, double y0, double x1, double y1, double z,
                  const std::string& element, Arena& arena) {
  arena.floor.push_back({frame.box(x0, y0, x1, y1), z, 0.0, 0.0, element});
}

void add_block(const ElementFrame& frame, double x0, double y0, double x1, double y1, double bottom, double top,
               Arena& arena) {
  arena.solids.push_back({frame.box(x0, y0, x1, y1), bottom, top, "tunnel", false});
}

}  // namespace

void add_step_field(const ElementFrame& frame, double tallest, Arena& arena) {
  constexpr int kColumns = 10;
  constexpr double kEdge = 0.1;
  const double step = 0.25 * tallest;
  // The league builds them at random; every field here is the same throw with the league's counts beside the diagonal.
  std::vector<double> heights;
  for (const auto& [steps, count] : {std::pair{0, 9}, {1, 27}, {2, 33}, {3, 21}}) {
    heights.insert(heights.end(), static_cast<std::size_t>(count), step * steps);
  }
  Rng rng(1, "red step field");
  for (std::size_t i = heights.size(); i > 1; --i) {
    const std::size_t k = rng.below(static_cast<std::uint32_t>(i));
    std::swap(heights[i - 1], heights[k]);
  }
  std::size_t next = 0;
  for (int row = 0; row < kColumns; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double height = row == column ? tallest : heights[next++];
      const double x = kEdge * column - 0.5;
      const double y = kEdge * row - 0.5;
      if (height > 0.0) add_platform(frame, x, y, x + kEdge, y + kEdge, height, "step_field", arena);
    }
  }
  constexpr double kPlank = 0.05;
  add_platform(frame, -0.49, -0.59, 0.49, -0.5, kPlank, "step_field", arena);
  add_platform(frame, -0.49, 0.5, 0.49, 0.59, kPlank, "step_field", arena);
  add_platform(frame, -0.59, -0.49, -0.5, 0.49, kPlank, "step_field", arena);
  add_platform(frame, 0.5, -0.49, 0.59, 0.49, kPlank, "step_field", arena);
}

namespace {

/// A quarter of a pallet that slopes.
struct Quarter {
  double x, y;    ///< its corner with the smallest coordinates
  double gx, gy;  ///< gradient in the own frame
  double foot;    ///< height of its low edge [m]
};

void add_quarter(const ElementFrame& frame, const Quarter& q, const char* element, Arena& arena) {
  constexpr double kEdge = 0.6;
  const mrpt::math::TPoint2D origin = frame.point(0.0, 0.0);
  const mrpt::math::TPoint2D right = frame.point(1.0, 0.0) - origin;
  const mrpt::math::TPoint2D ahead = frame.point(0.0, 1.0) - origin;
  FloorPatch patch;
  patch.outline = frame.box(q.x, q.y, q.x + kEdge, q.y + kEdge);
  patch.z = q.foot + std::max(0.0, -(q.gx + q.gy)) * kEdge;  // one of the two is zero
  patch.gx = q.gx * right.x + q.gy * ahead.x;
  patch.gy = q.gx * right.y + q.gy * ahead.y;
  patch.element = element;
  arena.floor.push_back(patch);
}

}  // namespace

void add_crossing_ramps(const ElementFrame& frame, double slope, Arena& arena) {
  // Quarter by quarter, counter-clockwise from the lower left: each rises a quarter turn further, +x first.
  constexpr double kHalf = 0.6;
  for (const Quarter& q : {Quarter{-kHalf, -kHalf, slope, 0.0, 0.0}, Quarter{0.0, -kHalf, 0.0, slope, 0.0},
                           Quarter{0.0, 0.0, -slope, 0.0, 0.0}, Quarter{-kHalf, 0.0, 0.0, -slope, 0.0}}) {
    add_quarter(frame, q, "crossing_ramp", arena);
  }
}

void add_elevated_ramps(const ElementFrame& frame, double slope, Arena& arena) {
  constexpr double kHalf = 0.6;
  const double raised = slope * kHalf;
  for (const Quarter& q : {Quarter{-kHalf, -kHalf, -slope, 0.0, raised}, Quarter{0.0, -kHalf, 0.0, -slope, 0.0},
                           Quarter{0.0, 0.0, -slope, 0.0, raised}, Quarter{-kHalf, 0.0, 0.0, slope, 0.0}}) {
    add_quarter(frame, q, "elevated_ramp", arena);
  }
}

void add_tunnel(const ElementFrame& frame, Arena& arena) {
  constexpr double kHalf = 0.6;
  constexpr double kBoard = 0.01;
  add_block(frame, -kHalf, -kHalf, kHalf, kHalf, 0.60, 0.62, arena);
  for (const double x : {-kHalf, kHalf}) {
    add_block(frame, x - 0.5 * kBoard, -kHalf, x + 0.5 * kBoard, kHalf, 0.0, 0.60, arena);
  }
}

}  // namespace rubble::arenas
