#include "base/rigid.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/planar.h"
#include "base/rng.h"

namespace rubble {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

TEST(FitRigid, RecoversTheMotionAndNeverAScale) {
  Rng rng(3, "points");
  std::vector<TPoint2D> from;
  for (int i = 0; i < 9; ++i) {
    const double x = rng.uniform(0.0, 3.0);
    const double y = rng.uniform(0.0, 3.0);
    from.emplace_back(x, y);
  }
  const PlanarTransform T(TPose2D(1.5, -2.0, 2.6));
  std::vector<TPoint2D> to;
  std::vector<TPoint2D> twice;
  for (const TPoint2D& p : from) to.push_back(T(p));
  for (const TPoint2D& p : to) twice.push_back(p * 2.0);
  const TPose2D found = fit_rigid(from, to);
  EXPECT_NEAR(found.x, 1.5, 1e-12);
  EXPECT_NEAR(found.y, -2.0, 1e-12);
  EXPECT_NEAR(found.phi, 2.6, 1e-12);
  const PlanarTransform of_twice(fit_rigid(from, twice));
  EXPECT_NEAR((of_twice(from[0]) - of_twice(from[1])).norm(), (from[0] - from[1]).norm(), 1e-12);
}

/// The transform is MRPT's, made ready; its inverse undoes it.
TEST(PlanarTransform, IsThePoseAndItsInverse) {
  Rng rng(5, "poses");
  for (int i = 0; i < 200; ++i) {
    const double x = rng.uniform(-9.0, 9.0);
    const double y = rng.uniform(-9.0, 9.0);
    const TPose2D pose(x, y, rng.uniform(-4.0, 4.0));
    const PlanarTransform T(pose);
    const TPoint2D p(y, 2.0 * x);
    SCOPED_TRACE("seed 5, pose " + std::to_string(i));
    EXPECT_NEAR((T(p) - pose.composePoint(p)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((T.inverse(T(p)) - p).norm(), 0.0, 1e-12);
    const TPoint2D far(p.x + 1.0, p.y);
    const TPoint2D along = T(far) - T(p);
    EXPECT_NEAR((T.turned_back(along.x, along.y) - TPoint2D(1.0, 0.0)).norm(), 0.0, 1e-12);
  }
  EXPECT_EQ(PlanarTransform()(TPoint2D(3.0, -4.0)), TPoint2D(3.0, -4.0));
}

}  // namespace
}  // namespace rubble
