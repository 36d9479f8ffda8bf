// What the explorer keeps lies where it was found, also after the map was corrected.
#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/caution/felt_obstacles.h"
#include "explore/caution/left_alone.h"
#include "explore/search/victim_search.h"
#include "tests/support/planted_mapper.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const TPose2D kShift{0.4, -0.3, deg_to_rad(12.0)};

Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

/// Half of the poses are moved by a planted loop closure at 5 s.
struct Anchoring : testing::Test {
  Anchoring() {
    for (int i = 0; i < 10; ++i) mapper.plant(at(i), TPose2D{0.5 * i, 0.1 * i, 0.2 * i});
  }
  test::PlantedMapper mapper;
  const robot::RobotModel model;
};

TEST_F(Anchoring, FeltObstaclesFollowThePosesAtWhichTheyWereFelt) {
  FeltObstacles felt;
  for (const double t : {2.0, 8.0}) felt.feel({at(t), *mapper.pose_at(at(t))}, false, model);
  const std::vector<TPoint2D> before = felt.points(at(9.0));
  mapper.correct(at(5.0), kShift);
  felt.follow(mapper);
  const std::vector<TPoint2D> after = felt.points(at(9.0));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const TPoint2D expected = i < before.size() / 2 ? kShift.composePoint(before[i]) : before[i];
    EXPECT_NEAR(distance(after[i], expected), 0.0, 1e-9);
  }
}

TEST_F(Anchoring, BarredTargetsFollowThePosesFromWhichTheyWereBarred) {
  LeftAlone left_alone({}, 0.5);
  const TPoint2D target{9.0, 4.0};
  left_alone.bar_for_good(target, {at(2.0), *mapper.pose_at(at(2.0))});
  mapper.correct(at(5.0), kShift);
  left_alone.follow(mapper);
  EXPECT_TRUE(left_alone.barred(kShift.composePoint(target), at(9.0)));
  EXPECT_FALSE(left_alone.barred(target, at(9.0))) << "there is another place now";
}

TEST_F(Anchoring, VictimsFollowThePosesFromWhichTheyWereSeen) {
  VictimSearch search;
  const TPoint2D victim{1.5, 1.0};
  for (const double t : {1.0, 2.0, 3.0}) {
    const TPose2D pose = *mapper.pose_at(at(t));
    const TPoint2D seen = pose.inverseComposePoint(victim);
    const robot::VictimCue cue{at(t), robot::CueKind::Heat, std::atan2(seen.y, seen.x), std::hypot(seen.x, seen.y),
                               0.9};
    search.add(cue, pose);
  }
  ASSERT_EQ(search.reports().size(), 1u);
  mapper.correct(at(5.0), kShift);
  search.follow(mapper);
  EXPECT_NEAR(distance(search.reports()[0].p_map, kShift.composePoint(victim)), 0.0, 1e-6);
}

}  // namespace
}  // namespace rubble::explore
