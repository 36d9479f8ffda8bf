#include "arenas/model/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// A convex polygon with corners on a circle.
Outline random_polygon(Rng& rng) {
  const int corners = 3 + static_cast<int>(rng.below(6));
  const double x = rng.uniform(-2.0, 2.0);
  const double y = rng.uniform(-2.0, 2.0);
  const double radius = rng.uniform(0.2, 2.0);
  Outline outline;
  for (int i = 0; i < corners; ++i) {
    const double bearing = 2.0 * kPi * (i + rng.uniform(0.0, 0.8)) / corners;
    outline.push_back({x + radius * std::cos(bearing), y + radius * std::sin(bearing)});
  }
  return outline;
}

TEST(Geometry, RectangleHasItsAreaAtAnyAngle) {
  for (const double angle : {0.0, 0.3, 1.7, -2.5}) {
    const Outline outline = rectangle({1.0, -2.0}, 3.0, 0.5, angle);
    EXPECT_NEAR(signed_area(outline), 1.5, 1e-12);
    EXPECT_TRUE(is_convex(outline));
  }
}

TEST(Geometry, StripIsARectangleRoundItsLine) {
  const Outline outline = strip({0.0, 0.0}, {3.0, 4.0}, 0.1);
  EXPECT_NEAR(signed_area(outline), 0.5, 1e-12);
  EXPECT_TRUE(contains(outline, {1.5, 2.0}));
  EXPECT_NEAR(distance(outline, TPoint2D{3.0, 4.0} + TPoint2D{0.6, 0.8}), 1.0, 1e-12);
}

TEST(Geometry, StarsAndClockwiseOutlinesAreNotConvex) {
  Outline star;
  for (int i = 0; i < 5; ++i) star.push_back({std::cos(4.0 * kPi * i / 5), std::sin(4.0 * kPi * i / 5)});
  EXPECT_FALSE(is_convex(star));
  EXPECT_FALSE(is_convex({{0, 0}, {0, 1}, {1, 1}, {1, 0}}));
  EXPECT_FALSE(is_convex({{0, 0}, {2, 0}, {1, 0.2}, {1, 1}}));
  EXPECT_FALSE(is_convex({{0, 0}, {1, 0}}));
}

TEST(Geometry, ClipAgreesWithPointsAlongTheSegment) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "clip");
    const Outline outline = random_polygon(rng);
    const double ax = rng.uniform(-4.0, 4.0);
    const double ay = rng.uniform(-4.0, 4.0);
    const double bx = rng.uniform(-4.0, 4.0);
    const double by = rng.uniform(-4.0, 4.0);
    const TPoint2D a{ax, ay};
    const TPoint2D b{bx, by};
    const auto part = clip(outline, a, b);
    for (int i = 0; i <= 200; ++i) {
      const double t = i / 200.0;
      const TPoint2D p = a + (b - a) * t;
      const bool is_inside = part && t > part->from + 1e-9 && t < part->to - 1e-9;
      const bool is_outside = !part || t < part->from - 1e-9 || t > part->to + 1e-9;
      EXPECT_FALSE(is_inside && !contains(outline, p));
      EXPECT_FALSE(is_outside && contains(outline, p, -1e-12));
    }
  }
}

TEST(Geometry, DistanceIsThatToTheNearestOfManyPointsOnTheOutline) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "distance");
    const Outline outline = random_polygon(rng);
    const double x = rng.uniform(-4.0, 4.0);
    const double y = rng.uniform(-4.0, 4.0);
    const TPoint2D p{x, y};
    double nearest = contains(outline, p, 0.0) ? 0.0 : 1e9;
    for (std::size_t i = 0; i < outline.size() && nearest > 0.0; ++i) {
      const TPoint2D along = outline[(i + 1) % outline.size()] - outline[i];
      for (int k = 0; k <= 1000; ++k) {
        const TPoint2D q = outline[i] + along * (k / 1000.0);
        nearest = std::min(nearest, std::hypot(q.x - p.x, q.y - p.y));
      }
    }
    EXPECT_NEAR(distance(outline, p), nearest, 2e-3);
  }
}

/// Stars with random spikes: the pieces are convex, their areas add up, and they cover the same points.
TEST(Geometry, ConvexPiecesAreTheOutlineCutUp) {
  Rng rng(3, "stars");
  for (int round = 0; round < 200; ++round) {
    Outline star;
    const int corners = 3 + static_cast<int>(rng.below(9));
    for (int i = 0; i < corners; ++i) {
      const double bearing = 6.283185307179586 * (i + rng.uniform(0.0, 0.8)) / corners;
      const double r = rng.uniform(0.1, 1.0);
      star.push_back({r * std::cos(bearing), r * std::sin(bearing)});
    }
    if (signed_area(star) < 0.02) continue;
    if (round % 2 == 0) std::reverse(star.begin(), star.end());
    const std::vector<Outline> pieces = convex_pieces(star);
    if (corners < 5 && pieces.empty()) continue;  // the middle may lie outside: then edges can cross
    double area = 0.0;
    for (const Outline& piece : pieces) {
      EXPECT_TRUE(is_convex(piece));
      area += signed_area(piece);
    }
    EXPECT_NEAR(area, std::abs(signed_area(star)), 1e-12);
    EXPECT_LE(pieces.size(), star.size() - 2);
  }
  EXPECT_TRUE(convex_pieces({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).empty()) << "an hourglass crosses itself";
  EXPECT_EQ(convex_pieces({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}).size(), 2u) << "an L is two rectangles";
}

}  // namespace
}  // namespace rubble::arenas
