#include "scoring/walls/break_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/angle.h"
#include "scoring/scorecard.h"
#include "tests/support/scoring_break.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

ScoreConfig with_warp() {
  ScoreConfig config;
  config.warp = true;
  return config;
}

TEST(BreakFit, APlantedBreakIsFoundAndMeasured) {
  for (const Ground& ground : {Ground{"maze", 9, 7, 7401}, {"yellow", 9, 6, 7402}, {"orange", 9, 7, 7403}})
    for (const auto& [deg, dx, dy] : {std::tuple{2.1, 0.2, -0.25}, {0.0, 0.3, 0.4}}) {
      SCOPED_TRACE(ground.name() + ", turned by " + std::to_string(deg));
      const OccupancyGrid truth = truth_of(ground);
      const TPoint2D middle(5.2, 4.0);
      const TPose2D T = about(middle, deg, dx, dy);
      const OccupancyGrid map = moved(come_apart(truth, middle.x, T), 0.5, 1.0, 2.0);
      const MapScore score = score_map(map, truth, with_warp());
      ASSERT_TRUE(score.broken.found) << "score " << score.score << ", bent " << score.warped_score;
      EXPECT_NEAR(std::abs(rad_to_deg(score.broken.turned_rad)), std::abs(deg), 0.6);
      EXPECT_NEAR(score.broken.apart_m, std::hypot(dx, dy), 0.15);
      // The seam lies about north-south where it was planted.
      EXPECT_NEAR(0.5 * (score.broken.from.x + score.broken.to.x), middle.x, 1.2);
      EXPECT_GT(score.mended_score, score.score + 0.02);
      EXPECT_GT(score.mended_score, 0.8);
    }
}

TEST(BreakFit, AMapThatIsWholeOrBentSoftlyHasNone) {
  for (const Ground& ground : {Ground{"maze", 9, 7, 7404}, {"yellow", 9, 6, 7405}, {"orange", 9, 7, 7406}}) {
    SCOPED_TRACE(ground.name());
    const OccupancyGrid truth = truth_of(ground);
    EXPECT_FALSE(score_map(moved(truth, 0.5, 1.0, 2.0), truth, with_warp()).broken.found);
    EXPECT_FALSE(
        score_map(with_gaps(with_phantoms(truth, 6, ground.seed), 12, ground.seed), truth, with_warp()).broken.found);
    EXPECT_FALSE(score_map(moved(bent(truth, 0.4), 0.5, 1.0, 2.0), truth, with_warp()).broken.found);
  }
}

TEST(BreakFit, AMapWithoutWallsHasNone) {
  const OccupancyGrid truth = maze({});
  EXPECT_FALSE(find_break(OccupancyGrid(truth.frame(), Occupancy::Free), truth, {}).found);
  EXPECT_FALSE(find_break(truth, OccupancyGrid(truth.frame(), Occupancy::Free), {}).found);
}

}  // namespace
}  // namespace rubble::scoring
