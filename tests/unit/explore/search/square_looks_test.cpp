#include <gtest/gtest.h>

#include <utility>

#include "base/angle.h"
#include "base/planar.h"
#include "explore/search/floor_search.h"
#include "explore/search/searched_area.h"
#include "tests/support/explore_grids.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Of a lane of one pallet both walls can be looked at squarely from its middle, where a robot that turns ends.
TEST(SquareLooks, ALaneShowsBothItsWallsFromItsMiddle) {
  const Traversable floor = test::measured(test::room(4.0, test::kPallet + 0.1));
  const double middle = 0.5 * (test::kPallet + 0.1);
  SearchedArea squarely({}, kSquarely);
  for (const double heading : {-0.5 * kPi, 0.5 * kPi}) {
    FloorInView view;
    see_floor(floor, SearchConfig{}, {2.0, middle, heading}, view);
    for (int looks = 0; looks < 2; ++looks) squarely.look(floor, view);
  }
  for (const auto& [y, face] : {std::pair{0.075, kSouthFace}, std::pair{test::kPallet + 0.025, kNorthFace}}) {
    const Cell c = floor.cells.cell({2.0, y});
    ASSERT_NE(faces_of(floor, c) & face, 0) << y;
    EXPECT_EQ(squarely.missing(floor, c) & face, 0) << y;
  }
}

/// What a look is for, with where it is to be made from.
struct Meant {
  FloorSearch search{{}, 0.46, 0.4};
  Traversable floor = test::measured(test::room(4.0, 4.0));
  TPose2D T_map_base;

  Meant() {
    const auto sources = search.sources(floor, Subjects::Squarely, [](const TPoint2D& p) {
      return distance(p, {2.0, 1.0});
    });
    const Source* best = &sources.front();
    for (const Source& source : sources)
      if (source.head_start < best->head_start) best = &source;
    search.choose_subject(best->cell);
    const TPoint2D from = floor.cells.centre(best->cell);
    T_map_base = {from.x, from.y, 0.5 * kPi};
    if (const auto turn = search.turn_to_subject(floor, T_map_base)) T_map_base.phi += *turn;
  }
  /// Holds still there.
  void dwell(const TPose2D& pose, double t) {
    search.start_dwell(Stamp::from_seconds(t));
    search.dwelling(floor, pose, Stamp::from_seconds(t + 5.0));
  }
};

/// A look that the robot did not make where it meant to says nothing of the place; but it does not try for ever.
TEST(SquareLooks, ARobotThatSlidOffItsPlaceTriesOnceMore) {
  Meant look;
  const TPose2D slid = look.T_map_base + TPose2D{0.0, 0.9, 0.0};
  look.dwell(slid, 1.0);
  EXPECT_FALSE(look.search.subject_seen(look.floor));
  look.dwell(slid, 10.0);
  EXPECT_TRUE(look.search.subject_seen(look.floor)) << "given up";
}

TEST(SquareLooks, APlaceThatDoesNotShowFromWhereItShouldIsGivenUp) {
  Meant look;
  const TPose2D elsewhere = look.T_map_base + TPose2D{0.0, 0.0, kPi};
  look.dwell(elsewhere, 1.0);
  EXPECT_TRUE(look.search.subject_seen(look.floor));
  EXPECT_TRUE(look.search.reconsider(look.floor));
  EXPECT_FALSE(look.search.subject_seen(look.floor));
}

}  // namespace
}  // namespace rubble::explore
