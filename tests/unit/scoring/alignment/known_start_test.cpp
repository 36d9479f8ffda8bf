#include <gtest/gtest.h>

#include "base/angle.h"
#include "scoring/alignment/alignment.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_grounds.h"

namespace rubble::scoring {
namespace {

using namespace testing;

/// A maze that looks the same from the other side.
OccupancyGrid symmetric(std::uint64_t seed, int columns, int rows) {
  OccupancyGrid truth = maze_of(seed, columns, rows);
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width() / 2; ++x) truth[{truth.width() - 1 - x, truth.height() - 1 - y}] = truth[{x, y}];
  return truth;
}

KnownStart start_at(const TPose2D& T_map_truth, const TPoint2D& p_truth) {
  return {TPose2D() - T_map_truth, T_map_truth.composePoint(p_truth)};
}

TEST(KnownStart, DecidesBetweenTheTwoPosesOfASymmetricArena) {
  for (const std::uint64_t seed : {7601u, 7602u, 7603u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const OccupancyGrid truth = crop_to_known(symmetric(seed, 8, 6), 0.0);
    const TPose2D T_map_truth(1.0, 2.0, 0.7);
    const OccupancyGrid map = crop_to_known(moved(with_gaps(truth, 8, seed), T_map_truth.phi, 1.0, 2.0), 0.0);
    AlignmentConfig config;
    EXPECT_FALSE(align(map, truth, config).aligned);
    config.start = start_at(T_map_truth, {0.6, 0.6});
    const Alignment found = align(map, truth, config);
    ASSERT_TRUE(found.aligned) << found.note;
    EXPECT_TRUE(includes(found.by, AlignBy::Start));
    const TPose2D rest = found.T_truth_map + T_map_truth;
    EXPECT_NEAR(rest.norm(), 0.0, 0.1);
    EXPECT_NEAR(wrap_angle(rest.phi), 0.0, 0.02);
  }
}

TEST(KnownStart, DoesNotMakeAStrangerOrAMirrorImageRight) {
  for (const std::uint64_t seed : {7604u, 7605u, 7606u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const OccupancyGrid truth = crop_to_known(maze_of(seed, 8, 6), 0.0);
    AlignmentConfig config;
    config.start = start_at({}, {0.6, 0.6});
    EXPECT_FALSE(align(crop_to_known(mirrored(truth), 0.0), truth, config).aligned);
    EXPECT_FALSE(align(crop_to_known(maze_of(seed + 500, 8, 6), 0.0), truth, config).aligned);
  }
}

TEST(KnownStart, ChangesNothingWhereThereIsNoDoubt) {
  const OccupancyGrid truth = crop_to_known(maze_of(7607, 9, 7), 0.0);
  const TPose2D T_map_truth(1.0, 2.0, 0.7);
  const OccupancyGrid map = crop_to_known(moved(with_gaps(truth, 12, 1), T_map_truth.phi, 1.0, 2.0), 0.0);
  AlignmentConfig config;
  const Alignment without = align(map, truth, config);
  config.start = start_at(T_map_truth, {0.6, 0.6});
  const Alignment with = align(map, truth, config);
  ASSERT_TRUE(without.aligned);
  EXPECT_EQ(with.T_truth_map, without.T_truth_map);
  EXPECT_EQ(with.by, without.by);
}

TEST(KnownStart, OneThatDoesNotFitIsSaidToBeSo) {
  const OccupancyGrid truth = crop_to_known(maze_of(7609, 9, 7), 0.0);
  AlignmentConfig config;
  config.start = start_at({}, {0.6, 0.6});
  EXPECT_EQ(align(truth, truth, config).note.find("start pose"), std::string::npos);
  config.start->T_truth_map = TPose2D(0.0, 0.0, deg_to_rad(90.0));
  const Alignment turned = align(truth, truth, config);
  EXPECT_TRUE(turned.aligned);
  EXPECT_NE(turned.note.find("start pose does not fit"), std::string::npos) << turned.note;
  EXPECT_NE(turned.note.find("turned by -90 deg"), std::string::npos) << turned.note;
  const Alignment stranger = align(crop_to_known(maze_of(8109, 9, 7), 0.0), truth, config);
  EXPECT_FALSE(stranger.aligned);
  EXPECT_EQ(stranger.note.find("start pose"), std::string::npos) << "its pose is not trusted: " << stranger.note;
}

/// Section IV.F as the way to a pose.
TEST(Equation7, FindsThePoseOfADamagedMapAndRefusesAStranger) {
  const OccupancyGrid truth = crop_to_known(truth_of({"yellow", 8, 7, 7608}), 0.0);
  const TPose2D T_map_truth(1.0, 2.0, 0.7);
  const OccupancyGrid map =
      crop_to_known(moved(with_gaps(with_phantoms(truth, 6, 1), 12, 1), T_map_truth.phi, 1.0, 2.0), 0.0);
  AlignmentConfig config;
  config.by = AlignBy::Equation7;
  const Alignment found = align(map, truth, config);
  ASSERT_TRUE(found.aligned) << found.note;
  EXPECT_TRUE(includes(found.by, AlignBy::Equation7));
  const TPose2D rest = found.T_truth_map + T_map_truth;
  EXPECT_NEAR(rest.norm(), 0.0, 0.15);
  EXPECT_FALSE(align(crop_to_known(truth_of({"yellow", 8, 7, 8108}), 0.0), truth, config).aligned);
}

}  // namespace
}  // namespace rubble::scoring
