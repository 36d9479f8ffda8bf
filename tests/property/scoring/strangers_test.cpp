#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "scoring/alignment/alignment.h"
#include "scoring/scorecard.h"
#include "scoring/walls/resample.h"
#include "tests/support/long_suite.h"
#include "tests/support/scoring_grounds.h"

/// Which maps belong together and which do not, on mazes and arenas that took no part in the calibration of trust.
namespace rubble::scoring {
namespace {

using namespace testing;

TEST(Strangers, AreRefusedAndScoreNothing) {
  for (const std::uint64_t seed : {1011u, 1012u}) {
    for (const auto& [columns, rows] : {std::pair{6, 6}, {9, 7}}) {
      const OccupancyGrid truth = maze_of(seed, columns, rows);
      const std::vector<std::pair<std::string, OccupancyGrid>> strangers = {
          {"mirrored", mirrored(truth)},
          {"mirrored and damaged", mirrored(with_gaps(with_phantoms(truth, 5, seed), 10, seed))},
          {"another", maze_of(seed + 100, columns, rows)},
          {"another, larger", maze_of(seed + 200, columns + 1, rows + 1)},
          {"another, half of it", with_coverage(maze_of(seed + 300, columns, rows), 0.5)},
          {"double size", scaled(truth, 2.0)},
          {"half size", scaled(truth, 0.5)}};
      for (const auto& [name, map] : strangers) {
        SCOPED_TRACE(name + ", maze " + std::to_string(columns) + " x " + std::to_string(rows) + ", seed " +
                     std::to_string(seed));
        const Alignment found = align(crop_to_known(moved(map, 0.5, 2.0, 1.0), 0.0), crop_to_known(truth, 0.0));
        EXPECT_FALSE(found.aligned);
        EXPECT_FALSE(found.note.empty());
      }
    }
  }
}

TEST(Strangers, DamagedMapsOfTheSameArenaAreNone) {
  for (const std::uint64_t seed : {2011u, 2012u}) {
    for (const bool generated : {false, true}) {
      const OccupancyGrid truth = truth_of({generated ? "yellow" : "maze", 9, 7, seed});
      const std::vector<std::pair<std::string, OccupancyGrid>> maps = {
          {"gaps and phantoms", with_gaps(with_phantoms(truth, 12, seed), 20, seed)},
          {"half of it", with_coverage(truth, 0.5)},
          {"bent", bent(truth, 0.5)},
          {"ragged", ragged(truth, 1, seed)},
          {"ragged, bent part", with_coverage(ragged(bent(truth, 0.3), 1, seed), 0.7)}};
      for (const auto& [name, map] : maps) {
        SCOPED_TRACE(name + (generated ? ", arena" : ", maze") + " of seed " + std::to_string(seed));
        const TPose2D T_map_truth(2.0, 1.0, 2.4);
        const OccupancyGrid turned = moved(map, T_map_truth.phi, T_map_truth.x, T_map_truth.y);
        const Alignment found = align(crop_to_known(turned, 0.0), crop_to_known(truth, 0.0));
        EXPECT_TRUE(found.aligned) << found.note;
        const TPose2D rest = found.T_truth_map + T_map_truth;
        EXPECT_NEAR(wrap_angle(rest.phi), 0.0, 0.05);
        EXPECT_NEAR(rest.norm(), 0.0, 0.6);
      }
    }
  }
}

/// A corner of an arena as small as this lies well somewhere in most others.
TEST(Strangers, AFragmentOfAnotherArenaIsRefused) {
  for (const Ground& ground : {Ground{"maze", 9, 7, 5}, {"maze", 9, 7, 6}, {"yellow", 9, 6, 1}, {"yellow", 7, 7, 10}}) {
    Ground other = ground;
    other.seed += 1000;
    const OccupancyGrid truth = truth_of(ground);
    for (const int gaps : {0, 15}) {
      SCOPED_TRACE(ground.name() + ", " + std::to_string(gaps) + " gaps");
      const OccupancyGrid fragment = with_coverage(with_gaps(truth_of(other), gaps, ground.seed), 0.12);
      EXPECT_FALSE(align(crop_to_known(moved(fragment, 0.4, 1.0, 2.0), 0.0), crop_to_known(truth, 0.0)).aligned);
    }
  }
}

/// A quarter of these arenas fits at a second place nearly as well, but what is open and what is blocked says which.
TEST(Strangers, AQuarterOfTheArenaIsToldFromThatOfAnother) {
  for (const Ground& ground : {Ground{"maze", 8, 7, 524}, {"yellow", 9, 6, 533}, {"orange", 7, 7, 514}}) {
    SCOPED_TRACE(ground.name());
    Ground other = ground;
    other.seed += 1000;
    const OccupancyGrid truth = crop_to_known(truth_of(ground), 0.0);
    const TPose2D T_map_truth(1.0, 2.0, 0.4);
    const auto quarter = [&](const OccupancyGrid& map) {
      const OccupancyGrid part = with_coverage(with_gaps(map, 8, ground.seed), 0.25);
      return align(crop_to_known(moved(part, T_map_truth.phi, T_map_truth.x, T_map_truth.y), 0.0), truth);
    };
    const Alignment found = quarter(truth_of(ground));
    EXPECT_TRUE(found.aligned) << found.note;
    EXPECT_NEAR((found.T_truth_map + T_map_truth).norm(), 0.0, 0.3);
    EXPECT_FALSE(quarter(truth_of(other)).aligned);
    EXPECT_FALSE(quarter(mirrored(truth_of(ground))).aligned);
  }
}

/// The mirror image of these arenas fits their damaged maps nearly as well on the whole, but not where nothing is
/// missing or nothing is added.
TEST(Strangers, AMapThatIsPerfectOneWayIsToldFromItsMirrorImage) {
  const OccupancyGrid gaps = truth_of({"yellow", 9, 6, 8});
  const OccupancyGrid salt = truth_of({"yellow", 7, 7, 7});
  EXPECT_TRUE(
      align(crop_to_known(moved(with_gaps(gaps, 60, 8), 0.4, 1.0, 2.0), 0.0), crop_to_known(gaps, 0.0)).aligned);
  EXPECT_TRUE(
      align(crop_to_known(moved(with_salt(salt, 0.03, 7), 0.4, 1.0, 2.0), 0.0), crop_to_known(salt, 0.0)).aligned);
}

/// An office of two equal wings: all but one wall of the mirror image lies right.
TEST(Strangers, TheMirrorImageOfABuildingThatIsNearlySymmetricIsNamed) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    OccupancyGrid truth = maze_of(seed, 10, 6);
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width() / 2; ++x) truth[{truth.width() - 1 - x, y}] = truth[{x, y}];
    draw_wall(truth, {8.0, 1.8}, {9.0, 1.8}, 2);
    draw_wall(truth, {9.6, 3.0}, {9.6, 4.2}, 2);
    const Alignment found = align(crop_to_known(mirrored(truth), 0.0), crop_to_known(truth, 0.0));
    EXPECT_FALSE(found.aligned);
    EXPECT_NE(found.note.find("mirror image"), std::string::npos) << found.note;
    EXPECT_GT(found.mirrored, 0.9);
  }
}

/// What a robot draws beside the walls fits neither way: the walls of one wing only tell the ways apart.
TEST(Strangers, AFurnishedBuildingThatIsNearlySymmetricIsToldFromItsMirrorImage) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    OccupancyGrid truth = maze_of(seed, 12, 7);
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width() / 2; ++x) truth[{truth.width() - 1 - x, y}] = truth[{x, y}];
    draw_wall(truth, {8.0, 1.8}, {10.0, 1.8}, 2);
    draw_wall(truth, {9.0, 3.0}, {9.0, 4.8}, 2);
    OccupancyGrid furnished = truth;
    for (int i = 0; i < 36; ++i) {
      const TPoint2D p(0.9 + 0.36 * i, 0.9 + 0.6 * ((7 * i + static_cast<int>(seed)) % 11));
      draw_wall(furnished, p, {p.x + 0.5, p.y + 0.3}, 2);
    }
    const auto aligned = [&](const OccupancyGrid& map) {
      return align(crop_to_known(moved(map, 0.4, 1.0, 2.0), 0.0), crop_to_known(truth, 0.0));
    };
    const Alignment found = aligned(furnished);
    EXPECT_TRUE(found.aligned) << found.note;
    EXPECT_GT(found.mirrored, 0.8);
    EXPECT_FALSE(aligned(mirrored(furnished)).aligned);
  }
}

TEST(Strangers, EveryMethodThatAlignsFindsTheSamePoseAndSaysWhich) {
  const OccupancyGrid truth = crop_to_known(maze_of(3011, 9, 7), 0.0);
  const OccupancyGrid map = crop_to_known(moved(with_gaps(truth, 20, 1), 0.9, 1.0, 4.0), 0.0);
  AlignmentConfig config;
  config.by = AlignBy::Walls;
  const Alignment walls = align(map, truth, config);
  ASSERT_TRUE(walls.aligned);
  EXPECT_EQ(names_of(walls.by), "walls");
  for (const FeatureKind kind : {FeatureKind::Surf, FeatureKind::Akaze, FeatureKind::Orb}) {
    config.by = AlignBy::Features;
    config.feature_kind = kind;
    const Alignment found = align(map, truth, config);
    ASSERT_TRUE(found.aligned) << name_of(kind) << ": " << found.note;
    EXPECT_TRUE(includes(found.by, AlignBy::Features));
    EXPECT_NEAR(
        (found.T_truth_map.composePoint(TPoint2D(3, 3)) - walls.T_truth_map.composePoint(TPoint2D(3, 3))).norm(), 0.0,
        0.05);
  }
  config.by = AlignBy::Rooms;
  config.rooms = [](const OccupancyGrid&, const OccupancyGrid&) { return std::vector<PoseGuess>{}; };
  EXPECT_FALSE(align(map, truth, config).aligned);
  config.rooms = [&](const OccupancyGrid&, const OccupancyGrid&) {
    return std::vector<PoseGuess>{{walls.T_truth_map, 1.0, AlignBy::Rooms}};
  };
  const Alignment rooms = align(map, truth, config);
  EXPECT_TRUE(rooms.aligned);
  EXPECT_TRUE(includes(rooms.by, AlignBy::Rooms));
}

TEST(Strangers, AWrongScaleIsNamed) {
  const OccupancyGrid truth = maze_of(4011, 9, 7);
  for (const double wrong : {0.5, 2.0}) {
    const MapScore score = score_map(scaled(truth, wrong), truth);
    EXPECT_FALSE(score.aligned);
    EXPECT_EQ(score.score, 0.0);
    EXPECT_EQ(score.scale_hint, 1.0 / wrong);
    EXPECT_NE(score.note.find("--resolution 0.05"), std::string::npos) << score.note;
  }
}

// The score stays that of the size that was given.
TEST(Strangers, AScaleThatIsOffByAFewPerCentIsNamed) {
  for (const Ground& ground : {Ground{"yellow", 8, 8, 4021}, {"orange", 7, 8, 4022}, {"maze", 7, 7, 4023}})
    for (const double wrong : {0.93, 1.07, 1.1}) {
      SCOPED_TRACE(ground.name() + ", " + std::to_string(wrong) + " times as large");
      const OccupancyGrid truth = truth_of(ground);
      const MapScore score = score_map(scaled(truth, wrong), truth);
      const std::size_t at = score.note.find("walls fit at ");
      ASSERT_NE(at, std::string::npos) << score.note;
      EXPECT_NEAR(std::stod(score.note.substr(at + std::string("walls fit at ").size())), 1.0 / wrong, 0.01);
      EXPECT_LT(score.score, 0.8);
    }
}

// As people mix it up who take the resolution of another map, or pixels a metre for centimetres a pixel.
TEST(Strangers, AScaleThatIsFarOffIsNamedWhetherTooSmallOrTooLarge) {
  std::size_t place = 0;
  for (const Ground& ground : {Ground{"yellow", 8, 8, 4041}, {"orange", 7, 8, 4042}, {"maze", 7, 7, 4043}})
    for (const double wrong : {0.4, 0.6, 0.7, 0.8, 1.25, 1.4, 1.7, 2.5}) {
      if (!is_tried(place++)) continue;
      SCOPED_TRACE(ground.name() + ", " + std::to_string(wrong) + " times as large");
      const OccupancyGrid truth = truth_of(ground);
      const OccupancyGrid map = with_phantoms(with_gaps(padded(truth, 15), 3, ground.seed), 2, ground.seed);
      const MapScore score = score_map(scaled(moved(map, 1.9, 3.0, 1.0, 0.025), wrong), truth);
      EXPECT_FALSE(score.aligned);
      EXPECT_EQ(score.score, 0.0);
      EXPECT_NEAR(score.scale_hint * wrong, 1.0, 0.01) << score.note;
      EXPECT_NE(score.note.find("give --resolution "), std::string::npos) << score.note;
    }
}

TEST(Strangers, NoOtherScaleIsNamedForAnotherArenaOfAnySize) {
  std::size_t place = 0;
  for (const std::uint64_t seed : {4051u, 4052u, 4053u})
    for (const double size : {0.5, 0.7, 1.0, 1.3, 2.0}) {
      if (!is_tried(place++)) continue;
      const OccupancyGrid truth = truth_of({"yellow", 8, 8, seed});
      const MapScore score = score_map(scaled(truth_of({"yellow", 8, 8, seed + 100}), size), truth);
      EXPECT_EQ(score.scale_hint, 0.0) << score.note;
      EXPECT_EQ(score.note.find("walls fit at"), std::string::npos) << score.note;
    }
}

TEST(Strangers, NoOtherScaleIsNamedWhereTheMapIsOnlyBad) {
  for (const std::uint64_t seed : {4031u, 4032u}) {
    const OccupancyGrid truth = truth_of({"yellow", 8, 8, seed});
    const OccupancyGrid other = truth_of({"yellow", 8, 8, seed + 100});
    OccupancyGrid worn = truth;  // every third column of a metre lost
    for (int y = 0; y < worn.height(); ++y)
      for (int x = 0; x < worn.width(); ++x)
        if (x / 20 % 3 == 0) worn[{x, y}] = Occupancy::Unknown;
    for (const OccupancyGrid* map : std::vector<const OccupancyGrid*>{&truth, &other, &worn})
      EXPECT_EQ(score_map(*map, truth).note.find("walls fit at"), std::string::npos) << score_map(*map, truth).note;
  }
}

}  // namespace
}  // namespace rubble::scoring
