#include "arenas/rough_shapes.h"

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

void add_crossing_ramps(const ElementFrame& frame, double slope, Arena& arena) {
  // Quarter by quarter, counter-clockwise from the lower left: each rises a quarter turn further, +x first.
  constexpr double kHalf = 0.6;
  const mrpt::math::TPoint2D origin = frame.point(0.0, 0.0);
  const mrpt::math::TPoint2D right = frame.point(1.0, 0.0) - origin;
  const mrpt::math::TPoint2D ahead = frame.point(0.0, 1.0) - origin;
  const struct {
    double x, y;    // its corner with the smallest coordinates
    double gx, gy;  // gradient in the own frame
  } quarters[] = {
      {-kHalf, -kHalf, slope, 0.0}, {0.0, -kHalf, 0.0, slope}, {0.0, 0.0, -slope, 0.0}, {-kHalf, 0.0, 0.0, -slope}};
  for (const auto& q : quarters) {
    FloorPatch patch;
    patch.outline = frame.box(q.x, q.y, q.x + kHalf, q.y + kHalf);
    patch.z = q.gx < 0.0 || q.gy < 0.0 ? slope * kHalf : 0.0;
    patch.gx = q.gx * right.x + q.gy * ahead.x;
    patch.gy = q.gx * right.y + q.gy * ahead.y;
    patch.element = "crossing_ramp";
    arena.floor.push_back(patch);
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
