#include "explore/paper/frontier_worth.h"

#include <gtest/gtest.h>

#include <optional>

#include "explore/paper/target_choice.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;

/// A robot in the middle of a hall of 20 x 1.3 m, with unknown ground where a test puts it.
struct Hall {
  explicit Hall(FrontierChoice by) { config = {by, 0.0}; }
  void unknown(double x, double length) { test::fill(cells, x, 0.3, x + length, 1.0, Occupancy::Unknown); }
  /// The x of the frontier chosen; `previous`: that of the one being driven to.
  double choose(std::optional<double> previous = std::nullopt) {
    const Traversable floor = test::measured(cells);
    const FloorSearch search(searched, 0.46, 0.4);
    Planner planner(planner_config);
    std::optional<TPoint2D> target;
    if (previous) target = TPoint2D{*previous, 0.65};
    const Plan plan = planner.to_frontier(
        floor, {x, 0.65, 0.0}, [](const TPoint2D&) { return false; }, target,
        frontier_worth(config, planner_config, floor, search, 0.2));
    EXPECT_TRUE(plan.found);
    return plan.target.x;
  }

  double x = 10.0;
  OccupancyGrid cells = test::room(20.0, 1.3);
  PlannerConfig planner_config;
  FrontierChoiceConfig config;
  SearchConfig searched;
};

/// A little unknown 2 m to the west, much of it 4 m to the east.
Hall hall(FrontierChoice by) {
  Hall hall(by);
  hall.unknown(7.8, 0.3);
  hall.unknown(14.0, 1.0);
  return hall;
}

TEST(FrontierWorth, TransformAndNearestGoToTheNearOne) {
  EXPECT_LT(hall(FrontierChoice::Transform).choose(), 9.0);
  EXPECT_LT(hall(FrontierChoice::Nearest).choose(), 9.0);
}

TEST(FrontierWorth, GainGoesToWhereMostIsToBeSeenHoweverFar) {
  Hall far = hall(FrontierChoice::Gain);
  EXPECT_GT(far.choose(), 13.0);
  far.x = 9.0;
  EXPECT_GT(far.choose(), 13.0);
}

TEST(FrontierWorth, ValueWeighsWhatIsToBeSeenAgainstTheTimeOfTheWay) {
  EXPECT_GT(hall(FrontierChoice::Value).choose(), 13.0) << "three times the area at twice the way";
  Hall near = hall(FrontierChoice::Value);
  near.x = 8.6;
  EXPECT_LT(near.choose(), 9.0) << "at eleven times the way";
}

/// The transform avoids the narrow way, the shortest way does not.
TEST(FrontierWorth, NearestCountsTheWayAlone) {
  for (const FrontierChoice by : {FrontierChoice::Transform, FrontierChoice::Nearest}) {
    Hall narrow(by);
    narrow.unknown(7.5, 0.3);
    narrow.unknown(13.0, 0.3);
    test::fill(narrow.cells, 8.4, 0.0, 9.4, 0.23, Occupancy::Occupied);
    test::fill(narrow.cells, 8.4, 1.07, 9.4, 1.3, Occupancy::Occupied);
    narrow.planner_config.transform.alpha = 100.0;
    EXPECT_EQ(narrow.choose() < 9.0, by == FrontierChoice::Nearest);
  }
}

TEST(FrontierWorth, TheOneBeingDrivenToHasAHeadStart) {
  for (const FrontierChoice by : {FrontierChoice::Nearest, FrontierChoice::Gain, FrontierChoice::Value}) {
    Hall even(by);
    even.unknown(6.5, 0.5);
    even.unknown(13.0, 0.52);
    even.x = 10.1;
    const double west = even.choose(7.1), east = even.choose(12.9);
    EXPECT_LT(west, 8.0) << static_cast<int>(by);
    EXPECT_GT(east, 12.0) << static_cast<int>(by);
  }
}

TEST(FrontierWorth, FacesToBeSearchedCountByTheirWeight) {
  OccupancyGrid cells = test::room(8.0, 1.3);
  test::fill(cells, 3.0, 0.3, 3.4, 1.0, Occupancy::Unknown);
  const Traversable floor = test::measured(cells);
  const FloorSearch search({}, 0.46, 0.4);
  const Candidate candidate{floor.cells.cell({3.5, 0.65}), 2.0, true};
  const auto value = [&](double weight) {
    return frontier_worth({FrontierChoice::Value, weight}, {}, floor, search, 0.25)(candidate);
  };
  const double faces = search.faces_in_view(floor, candidate.middle);
  ASSERT_GT(faces, 1.0);
  EXPECT_NEAR(value(0.0), 0.4 * 0.7 / (8.0 + 2.0), 1e-3) << "2 m at 0.25 m/s, and 2 s";
  EXPECT_NEAR(value(3.0), value(0.0) + 3.0 * faces / 10.0, 1e-9);
}

TEST(FrontierWorth, ByTimeIsByValueInShortMissionsAndByTheTransformInOthers) {
  const FrontierChoiceConfig by_time{FrontierChoice::ByTime, 2.0};
  for (const double limit : {1.0, 180.0, 239.0}) EXPECT_EQ(by_time.for_mission(limit).by, FrontierChoice::Value);
  for (const double limit : {0.0, 240.0, 1800.0}) EXPECT_EQ(by_time.for_mission(limit).by, FrontierChoice::Transform);
  EXPECT_EQ(by_time.for_mission(180.0).face_weight, 2.0);
  for (const FrontierChoice by :
       {FrontierChoice::Transform, FrontierChoice::Nearest, FrontierChoice::Gain, FrontierChoice::Value})
    EXPECT_EQ(FrontierChoiceConfig{by}.for_mission(180.0).by, by) << "asked for";
}

}  // namespace
}  // namespace rubble::explore
