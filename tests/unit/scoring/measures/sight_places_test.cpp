#include "scoring/measures/sight_places.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scoring/walls/wall_field.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

constexpr double kReach = 0.5;  // of a damage [m]

/// What the lines say within `reach` of a place, and elsewhere.
struct Told {
  SightPlace here;
  SightPlace elsewhere;
};

void add(SightPlace& sum, const SightPlace& place) {
  sum.asked += place.asked;
  sum.drawn += place.drawn;
  sum.missed += place.missed;
  sum.unknown += place.unknown;
}

Told told(const std::vector<SightPlace>& places, const TPoint2D& p, double reach) {
  Told out;
  for (const SightPlace& place : places) add((place.p - p).norm() <= reach ? out.here : out.elsewhere, place);
  return out;
}

TPoint2D along(const SightLines::Line& line, double at) {
  return line.from + (line.to - line.from) * (at / (line.to - line.from).norm());
}

OccupancyGrid erased(OccupancyGrid map, const TPoint2D& p) {
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (map[{x, y}] == Occupancy::Occupied && (map.centre({x, y}) - p).norm() <= kReach)
        map[{x, y}] = Occupancy::Free;
  return map;
}

class SightPlaces : public ::testing::TestWithParam<Ground> {
 protected:
  std::vector<SightPlace> of(const OccupancyGrid& map) const {
    return sight_places(lines_, SightMap(map), PlanarTransform());
  }
  const OccupancyGrid truth_ = truth_of(GetParam());
  const SightLines lines_{truth_};
};

TEST_P(SightPlaces, TheTruthIsRightEverywhere) {
  const Told all = told(of(truth_), {}, 1e9);
  EXPECT_NEAR(all.here.asked, 1.0, 1e-9);
  EXPECT_NEAR(all.here.drawn + all.here.missed + all.here.unknown, 0.0, 1e-9);
}

TEST_P(SightPlaces, AnErasedWallIsMissedWhereItStoodAndNowhereElse) {
  const auto line = std::find_if(lines_.lines().begin(), lines_.lines().end(), [](const auto& l) { return l.blocked; });
  ASSERT_NE(line, lines_.lines().end());
  const TPoint2D wall = along(*line, line->middle);
  const std::vector<SightPlace> places = of(erased(truth_, wall));
  const Told core = told(places, wall, 0.2);
  EXPECT_GT(core.here.missed, 0.9 * core.here.asked);
  const Told all = told(places, wall, kReach + 0.2);
  EXPECT_NEAR(all.elsewhere.missed + all.elsewhere.drawn + all.elsewhere.unknown, 0.0, 1e-9);
  EXPECT_LT(all.here.drawn + all.here.unknown, 0.05 * all.here.missed);
}

TEST_P(SightPlaces, APhantomWallIsDrawnWhereItStandsAndNowhereElse) {
  const WallField walls(truth_, 2.0);
  const auto line = std::find_if(lines_.lines().begin(), lines_.lines().end(), [&](const auto& l) {
    return !l.blocked && walls.distance(along(l, static_cast<double>(l.doubts.front()))) > 0.55;
  });
  ASSERT_NE(line, lines_.lines().end()) << "no open place clear of walls";
  const TPoint2D middle = along(*line, static_cast<double>(line->doubts.front()));
  const TPoint2D half = (line->to - line->from) * (0.3 / (line->to - line->from).norm());
  OccupancyGrid map = truth_;
  draw_wall(map, middle + TPoint2D(-half.y, half.x), middle + TPoint2D(half.y, -half.x), 2);
  const std::vector<SightPlace> places = of(map);
  const Told core = told(places, middle, 0.1);
  EXPECT_GT(core.here.drawn, 0.9 * core.here.asked);
  const Told all = told(places, middle, kReach);
  EXPECT_NEAR(all.elsewhere.missed + all.elsewhere.drawn + all.elsewhere.unknown, 0.0, 1e-9);
  EXPECT_LT(all.here.missed + all.here.unknown, 0.05 * all.here.drawn);
}

TEST_P(SightPlaces, WhatTheMapDoesNotKnowIsUnknownThere) {
  const GridFrame& f = truth_.frame();
  OccupancyGrid map = truth_;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width() / 2; ++x) map[{x, y}] = Occupancy::Unknown;
  const double edge = f.x0 + (f.width / 2) * f.resolution;
  SightPlace west;
  SightPlace east;
  for (const SightPlace& place : of(map)) {
    if (place.p.x < edge - 0.3) add(west, place);
    if (place.p.x > edge + 0.3) add(east, place);
  }
  EXPECT_GT(west.unknown, 0.99 * west.asked);
  EXPECT_NEAR(east.unknown + east.drawn + east.missed, 0.0, 1e-9);
}

/// The picture and the score are of the same answers.
TEST_P(SightPlaces, TheirSumIsWhatTheScoreIsMadeOf) {
  OccupancyGrid map = with_gaps(with_phantoms(truth_, 6, 5), 12, 5);
  for (int y = 0; y < map.height() / 3; ++y)
    for (int x = 0; x < map.width(); ++x) map[{x, y}] = Occupancy::Unknown;
  const SightAgreement agreement = lines_.at(map, PlanarTransform());
  const SightPlace sum = told(of(map), {}, 1e9).here;
  EXPECT_NEAR(sum.asked, 1.0, 1e-9);
  EXPECT_NEAR(1.0 - sum.unknown, agreement.known, 1e-9);
  EXPECT_NEAR(sum.asked - sum.unknown - 2.0 * (sum.drawn + sum.missed), agreement.kappa * agreement.known, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Grounds, SightPlaces, ::testing::ValuesIn(grounds()),
                         [](const auto& info) { return info.param.name(); });

}  // namespace
}  // namespace rubble::scoring
