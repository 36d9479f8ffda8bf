#include "explore/search/searched_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "explore/search/victim_search.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// A free room of 3 x 3 m about the origin with a wall along its north side, at y = 1.5 m.
Traversable room() {
  GridFrame frame;
  frame.width = frame.height = 64;
  frame.resolution = 0.05;
  frame.x0 = frame.y0 = -1.6;
  OccupancyGrid grid(frame, Occupancy::Unknown);
  for (int y = 2; y < 62; ++y)
    for (int x = 2; x < 62; ++x) grid[{x, y}] = y == 61 ? Occupancy::Occupied : Occupancy::Free;
  Traversable floor = traversable(std::move(grid));
  measure_clearance(floor, 1.2);
  return floor;
}

Cell at_wall(const Traversable& floor, double x) {
  Cell c = floor.cells.cell({x, 1.4});
  while (floor.cells[{c.x, c.y + 1}] == Occupancy::Free) ++c.y;
  return c;
}

void look_once(SearchedArea& area, const Traversable& floor, const TPose2D& T_map_base) {
  FloorInView view;
  see_floor(floor, SearchConfig{}, T_map_base, view);
  area.look(floor, view);
}

void look_twice(SearchedArea& area, const Traversable& floor, const TPose2D& T_map_base) {
  look_once(area, floor, T_map_base);
  look_once(area, floor, T_map_base);
}

TEST(SearchedArea, AWallIsInspectedFromTheFront) {
  const Traversable floor = room();
  SearchedArea area{SearchConfig{}};
  const Cell c = at_wall(floor, 0.0);
  EXPECT_EQ(area.missing(floor, c), kFloor | kNorthFace);
  look_twice(area, floor, {0.0, 0.5, deg_to_rad(90.0)});
  EXPECT_EQ(area.missing(floor, c), 0);
}

TEST(SearchedArea, FloorWasSeenAfterTwoLooksAndNotWhereItWasGivenUp) {
  const Traversable floor = room();
  SearchedArea area{SearchConfig{}};
  const TPose2D eye(0.0, 0.5, deg_to_rad(90.0));
  const TPoint2D ahead(0.0, 1.2), behind(0.0, -0.5);
  EXPECT_FALSE(area.saw(ahead));
  look_once(area, floor, eye);
  EXPECT_FALSE(area.saw(ahead));
  look_once(area, floor, eye);
  EXPECT_TRUE(area.saw(ahead));
  EXPECT_FALSE(area.saw(behind));
  area.give_up(floor, behind, 0.3, kFloor);
  EXPECT_EQ(area.missing(floor, floor.cells.cell(behind)), 0);
  EXPECT_FALSE(area.saw(behind));
  EXPECT_FALSE(area.saw({100.0, 0.0}));
}

TEST(SearchedArea, AWallSeenAtAGrazingAngleIsNotInspected) {
  const Traversable floor = room();
  SearchedArea area{SearchConfig{}};
  look_twice(area, floor, {-1.2, 1.2, deg_to_rad(10.0)});
  EXPECT_EQ(area.missing(floor, at_wall(floor, 0.0)), kNorthFace);
}

/// A look from each viewpoint of a floor shows what the viewpoint is for. Returns them.
std::vector<Viewpoint> viewpoints_that_see(const Traversable& floor) {
  const SearchConfig config;
  std::vector<Viewpoint> views = viewpoints(floor, SearchedArea{config}, config, 0.4, 0.4);
  for (const Viewpoint& view : views) {
    SearchedArea fresh{config};
    const TPoint2D from = floor.cells.centre(view.cell);
    look_twice(fresh, floor, {from.x, from.y, std::atan2(view.subject.y - from.y, view.subject.x - from.x)});
    EXPECT_EQ(fresh.missing(floor, floor.cells.cell(view.subject)) & view.faces, 0)
        << "from " << from.x << " " << from.y << " to " << view.subject.x << " " << view.subject.y;
  }
  return views;
}

/// The side of a box that scans from a ramp pass over: free in the map, with a hit now and then.
void add_low_wall(Traversable& floor, const TPoint2D& from, const TPoint2D& to) {
  const Cell low = floor.cells.cell(from), high = floor.cells.cell(to);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) floor.seen_over[{x, y}] = 1;
}

TEST(SearchedArea, WhatLiesBehindALowWallIsSeenFromItsOpenSideAlone) {
  const TPose2D aslant(0.22, 0.62, deg_to_rad(42.0)), before(1.22, 0.52, deg_to_rad(90.0));
  for (const bool box : {false, true}) {
    Traversable floor = room();
    if (box) add_low_wall(floor, {1.02, 1.07}, {1.02, 1.42});
    SearchedArea area{SearchConfig{}};
    const Cell back = at_wall(floor, 1.22);
    look_twice(area, floor, aslant);
    EXPECT_EQ(area.missing(floor, back), box ? kFloor | kNorthFace : 0);
    EXPECT_EQ(area.missing(floor, floor.cells.cell({1.02, 1.32})) & kFloor, 0) << "the wall itself is in view";
    look_twice(area, floor, before);
    EXPECT_EQ(area.missing(floor, back), 0);
  }
}

TEST(SearchedArea, ViewpointsBesideALowWallSeeWhatTheyAreFor) {
  Traversable floor = room();
  add_low_wall(floor, {1.02, 1.07}, {1.02, 1.42});
  bool of_back = false;
  for (const Viewpoint& view : viewpoints_that_see(floor)) {
    of_back = of_back || (view.subject.x > 1.05 && view.subject.y > 1.1);
  }
  EXPECT_TRUE(of_back);
}

/// From the foot of a slope its floor is hit by every scan, from upon it by none: a band across the lane.
TEST(SearchedArea, ARobotOnABandThatScansPassOverSeesBeyondIt) {
  Traversable floor = room();
  add_low_wall(floor, {-1.4, 0.3}, {1.4, 0.6});
  SearchedArea from_before{SearchConfig{}}, from_upon{SearchConfig{}};
  const Cell face = at_wall(floor, 0.0);
  look_twice(from_before, floor, {0.0, 0.0, deg_to_rad(90.0)});
  EXPECT_EQ(from_before.missing(floor, face), kFloor | kNorthFace);
  look_twice(from_upon, floor, {0.0, 0.4, deg_to_rad(90.0)});
  EXPECT_EQ(from_upon.missing(floor, face), 0);
}

TEST(SearchedArea, WithoutFacesFloorInViewIsAllThatIsAskedFor) {
  const Traversable floor = room();
  SearchConfig config;
  config.faces = false;
  SearchedArea area{config};
  const Cell c = at_wall(floor, 0.0);
  EXPECT_EQ(area.missing(floor, c), kFloor);
  EXPECT_EQ(area.unsearched(floor)[c], kFloor);
  look_twice(area, floor, {-1.2, 1.2, deg_to_rad(10.0)});
  EXPECT_EQ(area.missing(floor, c), 0) << "the wall was seen at a grazing angle alone";
  EXPECT_EQ(area.unsearched(floor)[c], 0);
}

/// Through a hole in a wall a camera sees only squarely, and not from right before it.
TEST(SearchedArea, SquarelyCountsWithin27DegAndNotFromTooNear) {
  const Traversable floor = room();
  const Cell c = at_wall(floor, 0.0);
  const TPoint2D face = floor.cells.centre(c);
  for (const double off : {0.0, 20.0, -20.0, 35.0, -35.0, 55.0})
    for (const double away : {0.4, 0.8, 1.2, 1.6}) {
      SearchedArea squarely{SearchConfig{}, kSquarely};
      const double bearing = deg_to_rad(90.0 + off);
      look_twice(squarely, floor, {face.x - away * std::cos(bearing), face.y - away * std::sin(bearing), bearing});
      const bool counts = std::abs(off) < 27.0 && away > 0.6;
      EXPECT_EQ(squarely.missing(floor, c), counts ? 0 : kNorthFace) << off << " deg, " << away << " m";
    }
}

TEST(SearchedArea, ViewpointsToLookSquarelyFromAreSquarelyBeforeAFace) {
  const Traversable floor = room();
  const SearchConfig config;
  SearchedArea squarely{config, kSquarely};
  const std::vector<Viewpoint> views = viewpoints(floor, squarely, config, 0.4, 0.4, Subjects::Squarely);
  ASSERT_FALSE(views.empty());
  for (const Viewpoint& view : views) {
    SearchedArea fresh{config, kSquarely};
    const TPoint2D from = floor.cells.centre(view.cell);
    look_twice(fresh, floor, {from.x, from.y, std::atan2(view.subject.y - from.y, view.subject.x - from.x)});
    EXPECT_EQ(view.faces & kFloor, 0);
    EXPECT_EQ(fresh.missing(floor, floor.cells.cell(view.subject)) & view.faces, 0)
        << "from " << from.x << " " << from.y << " to " << view.subject.x << " " << view.subject.y;
  }
}

/// A robot stops a hand's breadth off the place it drives to.
TEST(SearchedArea, ALookSquarelyCountsFromBesideItsViewpointToo) {
  const Traversable floor = room();
  const SearchConfig config;
  const SearchedArea squarely{config, kSquarely};
  const std::vector<Viewpoint> views = viewpoints(floor, squarely, config, 0.4, 0.4, Subjects::Squarely);
  ASSERT_FALSE(views.empty());
  for (const Viewpoint& view : views)
    for (const TPoint2D off : {TPoint2D{0.08, 0.0}, {-0.08, 0.0}, {0.0, 0.08}, {0.0, -0.08}}) {
      SearchedArea fresh{config, kSquarely};
      const TPoint2D from = floor.cells.centre(view.cell) + off;
      if (floor.cells[floor.cells.cell(from)] != Occupancy::Free) continue;
      look_twice(fresh, floor, {from.x, from.y, std::atan2(view.subject.y - from.y, view.subject.x - from.x)});
      EXPECT_EQ(fresh.missing(floor, floor.cells.cell(view.subject)) & view.faces, 0)
          << "from " << from.x << " " << from.y << " to " << view.subject.x << " " << view.subject.y;
    }
}

/// What is seen through a hole lies behind the wall's face all the same; a gap as wide as a box is none.
TEST(SearchedArea, HolesInWallsAreShutAndWiderGapsAreNot) {
  for (const int wide : {0, 1, 3, 4, 5, 8}) {
    OccupancyGrid cells = room().cells;
    const Cell first{30, 61};
    for (int i = 0; i < wide; ++i) cells[{first.x + i, first.y}] = i % 2 == 0 ? Occupancy::Free : Occupancy::Unknown;
    const OccupancyGrid shut = with_holes_shut(cells);
    EXPECT_EQ(shut.cells() == room().cells.cells(), wide <= 4) << wide;
    EXPECT_EQ(shut.cells() == cells.cells(), wide == 0 || wide > 4) << wide;
  }
}

TEST(SearchedArea, OneLookIsNotEnough) {
  const Traversable floor = room();
  SearchedArea area{SearchConfig{}};
  look_once(area, floor, {0.0, 0.5, deg_to_rad(90.0)});
  EXPECT_NE(area.missing(floor, at_wall(floor, 0.0)), 0);
}

TEST(SearchedArea, EveryViewpointSeesTheFaceItIsFor) { EXPECT_FALSE(viewpoints_that_see(room()).empty()); }

/// A corridor along x, 1.2 m wide, with a box of 0.4 m at its north wall that opens to the south.
Traversable corridor_with_box() {
  GridFrame frame;
  frame.width = 84;
  frame.height = 30;
  frame.resolution = 0.05;
  OccupancyGrid grid(frame, Occupancy::Unknown);
  for (int x = 1; x < 83; ++x)
    for (int y = 2; y < 28; ++y) grid[{x, y}] = y == 2 || y == 27 ? Occupancy::Occupied : Occupancy::Free;
  for (int y = 19; y < 27; ++y) grid[{36, y}] = grid[{45, y}] = Occupancy::Occupied;
  Traversable floor = traversable(std::move(grid));
  measure_clearance(floor, 1.2);
  return floor;
}

TEST(SearchedArea, ABoxInACorridorHasAViewpointIfOnlyATightOne) {
  const Traversable floor = corridor_with_box();
  const SearchConfig config;
  SearchedArea area{config};
  const Cell back{40, 26};
  ASSERT_NE(area.missing(floor, back) & kNorthFace, 0);
  const auto sees_back = [&](const std::vector<Viewpoint>& views) {
    return std::any_of(views.begin(), views.end(), [&](const Viewpoint& view) {
      SearchedArea fresh{config};
      const TPoint2D from = floor.cells.centre(view.cell);
      look_twice(fresh, floor, {from.x, from.y, std::atan2(view.subject.y - from.y, view.subject.x - from.x)});
      return (fresh.missing(floor, back) & kNorthFace) == 0 && view.subject.y > 19 * 0.05;
    });
  };
  EXPECT_FALSE(sees_back(viewpoints(floor, area, config, 0.46, 0.46)));
  EXPECT_TRUE(sees_back(viewpoints(floor, area, config, 0.46, 0.38)));
}

TEST(SearchedArea, TheBackOfABoxIsANicheAndAWallIsNone) {
  const Traversable floor = corridor_with_box();
  EXPECT_TRUE(in_niche(floor, {40, 26}, kNorthFace));
  EXPECT_FALSE(in_niche(floor, {20, 26}, kNorthFace));
  EXPECT_FALSE(in_niche(floor, {40, 3}, kSouthFace)) << "the wall that the box looks at";
  EXPECT_FALSE(in_niche(floor, {35, 22}, kEastFace)) << "the side of the box, from outside";
}

TEST(SearchedArea, ViewpointsOfNichesAreForTheBackOfTheBoxAlone) {
  const Traversable floor = corridor_with_box();
  const SearchConfig config;
  SearchedArea area{config};
  const std::vector<Viewpoint> views = viewpoints(floor, area, config, 0.46, 0.38, Subjects::Niches);
  ASSERT_FALSE(views.empty());
  for (const Viewpoint& view : views) {
    const Cell subject = floor.cells.cell(view.subject);
    EXPECT_GT(subject.x, 36);
    EXPECT_LT(subject.x, 45);
    EXPECT_GE(subject.y, 19);
    EXPECT_NE(view.faces & kNorthFace, 0) << subject.x << " " << subject.y;
  }
  const TPoint2D back = floor.cells.centre({40, 26});
  look_twice(area, floor, {back.x, back.y - 0.9, deg_to_rad(90.0)});
  EXPECT_TRUE(viewpoints(floor, area, config, 0.46, 0.38, Subjects::Niches).empty()) << "it was looked into";
  EXPECT_FALSE(viewpoints(floor, area, config, 0.46, 0.38).empty()) << "not so the rest";
}

TEST(SearchedArea, TheRecordGrowsWithTheMap) {
  const Traversable floor = room();
  SearchedArea area{SearchConfig{}};
  look_twice(area, floor, {0.0, 0.5, deg_to_rad(90.0)});
  GridFrame wide = floor.frame();
  wide.x0 -= 200 * wide.resolution;
  wide.width += 400;
  OccupancyGrid grid(wide, Occupancy::Unknown);
  for (int y = 0; y < floor.cells.height(); ++y)
    for (int x = 0; x < floor.cells.width(); ++x) grid[{x + 200, y}] = floor.cells[{x, y}];
  const Traversable wider = traversable(std::move(grid));
  look_once(area, wider, {0.0, -1.0, deg_to_rad(-90.0)});
  const Cell c = at_wall(floor, 0.0);
  EXPECT_EQ(area.missing(wider, {c.x + 200, c.y}), 0);
}

TEST(SearchedArea, OfWhatWasSeenOnALargerMapOnlyWhatLiesInThisOneIsKept) {
  const Traversable floor = room();
  const GridFrame& frame = floor.frame();
  for (const TPoint2D& corner : {TPoint2D{-40.0, -40.0}, {-40.0, 0.0}, {0.0, -40.0}, {-30.0, -30.0}, {60.0, 60.0}}) {
    const Grid<Faces> seen({1000, 1000, frame.resolution, corner.x, corner.y}, kFloor);
    SearchedArea area{SearchConfig{}};
    area.look(frame, seen);
    area.look(frame, seen);
    for (const TPoint2D& p : {TPoint2D{-1.0, -1.0}, {0.5, 0.5}, {1.0, 1.0}, {1.0, -1.0}}) {
      const bool inside = p.x > corner.x && p.y > corner.y && p.x < corner.x + 50.0 && p.y < corner.y + 50.0;
      EXPECT_EQ(area.missing(floor, floor.cells.cell(p)) & kFloor, inside ? 0 : kFloor) << corner.x << " " << p.x;
    }
  }
}

TEST(SearchedArea, WhatIsGivenUpIsGivenUpForTheseFacesOnly) {
  const Traversable floor = room();
  SearchedArea area{SearchConfig{}};
  const Cell c = at_wall(floor, 0.0);
  area.give_up(floor, floor.cells.centre(c), 0.1, kFloor);
  EXPECT_EQ(area.missing(floor, c), kNorthFace);
}

robot::VictimCue sure_cue_of(const TPoint2D& victim, const TPose2D& pose, double seconds) {
  const TPoint2D seen = pose.inverseComposePoint(victim);
  return {Stamp::from_seconds(seconds), robot::CueKind::Appearance, std::atan2(seen.y, seen.x),
          std::hypot(seen.x, seen.y), 0.9};
}

/// A wall along y = 0, and nothing known of the lines to the victims.
const Sightlines kWall{[](const TPoint2D& a, const TPoint2D& b) { return (a.y > 0.0) == (b.y > 0.0); },
                       [](const TPoint2D&, const TPoint2D&) { return false; }};

TEST(VictimSearch, TwoBackToBackBehindOneWallStayTwo) {
  VictimSearch search;
  for (int i = 0; i < 6; ++i) {
    const bool north = i % 2 == 0;
    const TPose2D from{0.1 * i, north ? 1.0 : -1.0, 0.0};
    search.add(sure_cue_of({0.0, north ? 0.15 : -0.15}, from, i), Anchor{Stamp::from_seconds(i), from}, kWall);
  }
  ASSERT_EQ(search.reports().size(), 2u);
  EXPECT_NEAR(std::abs(search.reports()[0].p_map.y - search.reports()[1].p_map.y), 0.3, 1e-6);
}

TEST(VictimSearch, OneSeenFromLeftAndRightIsOne) {
  VictimSearch search;
  for (int i = 0; i < 6; ++i) {
    const TPose2D from{i % 2 == 0 ? -1.0 : 1.0, 0.4, 0.0};
    search.add(sure_cue_of({0.0, 0.1}, from, i), Anchor{Stamp::from_seconds(i), from}, kWall);
  }
  EXPECT_EQ(search.reports().size(), 1u);
}

TEST(VictimSearch, FalseAlarmsMinutesApartMakeNoVictim) {
  VictimSearch search;
  for (int i = 0; i < 6; ++i) search.add(sure_cue_of({1.0, 0.0}, TPose2D{}, 100.0 * i), TPose2D{});
  EXPECT_TRUE(search.reports().empty());
}

}  // namespace
}  // namespace rubble::explore
