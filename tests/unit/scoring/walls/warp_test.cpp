#include "scoring/walls/warp_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scoring_maze.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// Where `bent` takes a point: the sag of a parabola along y.
TPoint2D sagged(const TPoint2D& p, const OccupancyGrid& truth, double bend) {
  const GridFrame frame = padded(truth, static_cast<int>(std::ceil(bend / truth.resolution())) + 1).frame();
  const double half = 0.5 * frame.width * frame.resolution;
  const double u = (p.x - frame.x0 - half) / half;
  return {p.x, p.y + bend * u * u};
}

TEST(Warp, JacobianEqualsFiniteDifferences) {
  Warp warp;
  warp.terms = Warp::kMaxTerms;
  warp.centre = {1.0, 2.0};
  warp.extent = 5.0;
  for (std::size_t i = 0; i < Warp::kMaxTerms; ++i) {
    warp.dx[i] = 0.1 + 0.05 * static_cast<double>(i);
    warp.dy[i] = 0.3 - 0.07 * static_cast<double>(i);
  }
  const double h = 1e-5;
  for (const TPoint2D& p : {TPoint2D(0.0, 0.0), TPoint2D(3.0, -1.0), TPoint2D(-4.0, 6.0)}) {
    const auto place = [&](double x, double y) { return TPoint2D(x, y) + warp.displacement({x, y}); };
    const TPoint2D dx = (place(p.x + h, p.y) - place(p.x - h, p.y)) * (0.5 / h);
    const TPoint2D dy = (place(p.x, p.y + h) - place(p.x, p.y - h)) * (0.5 / h);
    EXPECT_NEAR(warp.jacobian(p), dx.x * dy.y - dx.y * dy.x, 1e-6);
  }
}

TEST(Warp, InverseUndoesAMildWarp) {
  Warp warp;
  warp.T_truth_map = PlanarTransform(TPose2D(2.0, -1.0, 0.8));
  warp.extent = 8.0;
  warp.dy[2] = 0.4;
  warp.dx[4] = -0.3;
  for (const TPoint2D& p : {TPoint2D(0.0, 0.0), TPoint2D(5.0, -4.0), TPoint2D(-6.0, 3.0)})
    EXPECT_NEAR((warp.inverse(warp(p)) - p).norm(), 0.0, 0.01);
}

TEST(Warp, RecoversAKnownBend) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    for (const double bend : {0.3, 0.8}) {
      SCOPED_TRACE("maze seed " + std::to_string(seed) + ", bend " + std::to_string(bend));
      const OccupancyGrid truth = maze_of(seed, 10, 8);
      const OccupancyGrid map = bent(truth, bend);
      const WallOverlap walls(map, truth, 0.5);
      const TPose2D start(0.0, -0.3 * bend, 0.0);
      const WarpedScore found = fit_warp(map, truth, walls, start);
      EXPECT_GT(found.overlap.score, 0.9);
      double sum = 0.0;
      int count = 0;
      for (const TPoint2D& p : wall_points(truth)) {
        sum += (found.warp(sagged(p, truth, bend)) - p).sqrNorm();
        ++count;
      }
      EXPECT_LT(std::sqrt(sum / count), 0.1);
      // What remains of bend * u^2 after the best shift: its standard deviation, 0.298 for u uniform in -1..1.
      EXPECT_NEAR(found.size, 0.298 * bend, 0.1 * bend + 0.02);
    }
  }
}

TEST(Warp, NeedsNoneOnIdenticalMapsAndNeverLowersTheScore) {
  const OccupancyGrid truth = maze_of(4, 10, 8);
  const WarpedScore same = fit_warp(truth, truth, WallOverlap(truth, truth, 0.5), {});
  EXPECT_EQ(same.size, 0.0);
  EXPECT_EQ(same.overlap.score, 1.0);
  EXPECT_EQ(same.kept, 1.0);
  double last_size = 0.0;
  for (const double bend : {0.05, 0.2, 0.5, 1.0, 2.0}) {
    SCOPED_TRACE("bend " + std::to_string(bend));
    const OccupancyGrid map = with_phantoms(with_gaps(bent(truth, bend), 20, 4), 10, 4);
    const WallOverlap walls(map, truth, 0.5);
    const double rigid = walls.at(PlanarTransform()).score;
    const WarpedScore found = fit_warp(map, truth, walls, {});
    EXPECT_GE(found.overlap.score, rigid);
    EXPECT_GT(found.kept, 0.0);
    EXPECT_LE(found.kept, 1.0);
    EXPECT_GE(found.size, 0.0);
    EXPECT_GE(found.size, bend <= 1.0 ? last_size - 0.02 : 0.0);
    last_size = found.size;
    EXPECT_TRUE(keeps_order(found.warp, map.frame()));
  }
}

TEST(Warp, AFoldIsSeen) {
  Warp warp;
  warp.extent = 1.0;
  warp.dx[2] = 1.0;  // x + x^2 turns back at x = -0.5
  EXPECT_FALSE(keeps_order(warp, GridFrame{100, 100, 0.05, -2.5, -2.5}));
  warp.dx[2] = 0.01;
  EXPECT_TRUE(keeps_order(warp, GridFrame{100, 100, 0.05, -2.5, -2.5}));
}

}  // namespace
}  // namespace rubble::scoring
