#include "scoring/rooms/rooms.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "base/angle.h"
#include "scoring/rooms/room_clusters.h"
#include "tests/support/scoring_floor_maps.h"
#include "tests/support/scoring_maze.h"
#include "tests/support/scoring_plan.h"

namespace rubble::scoring {
namespace {

using namespace testing;

RoomAgreement compare(const Rooms& rooms, const Plan& plan) {
  cv::Mat truth(plan.truth.height(), plan.truth.width(), CV_32S);
  for (int y = 0; y < truth.rows; ++y)
    for (int x = 0; x < truth.cols; ++x) truth.at<int>(y, x) = plan.truth[{x, y}];
  return compare_rooms(rooms.labels, truth);
}

OccupancyGrid box(int width, int height) {
  OccupancyGrid grid(GridFrame{width + 20, height + 20, 0.05, 1.0, -2.0});
  for (int y = 9; y < height + 11; ++y)
    for (int x = 9; x < width + 11; ++x) {
      const bool wall = x < 10 || y < 10 || x >= width + 10 || y >= height + 10;
      grid[{x, y}] = wall ? Occupancy::Occupied : Occupancy::Free;
    }
  return grid;
}

TEST(Rooms, EveryRoomOfAGeneratedPlanIsFound) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    PlanSpec spec;
    spec.seed = seed;
    const Plan plan = floor_plan(spec);
    const RoomAgreement agreement = compare(extract_rooms(plan.grid), plan);
    EXPECT_EQ(agreement.segments, plan.rooms);
    EXPECT_GT(agreement.iou, 0.95);
  }
}

TEST(Rooms, HolesInWallsAndClutterChangeNothing) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    PlanSpec spec;
    spec.seed = seed;
    spec.table_legs = 10;
    spec.wall_holes = 10;
    const Plan plan = floor_plan(spec);
    const RoomAgreement agreement = compare(extract_rooms(plan.grid), plan);
    EXPECT_EQ(agreement.segments, plan.rooms);
    EXPECT_GT(agreement.iou, 0.93);
  }
}

TEST(Rooms, RaggedWallsOfASensorMapStillSeparateRooms) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    PlanSpec spec;
    spec.seed = seed;
    spec.table_legs = 5;
    Plan plan = floor_plan(spec);
    plan.grid = ragged(plan.grid, 2, seed);
    EXPECT_GT(compare(extract_rooms(plan.grid), plan).iou, 0.85);
  }
}

TEST(Rooms, VisibilityClustersFindTheRoomsOfAGeneratedPlan) {
  RoomConfig config;
  config.method = RoomMethod::Visibility;
  PlanSpec spec;
  const Plan plan = floor_plan(spec);
  EXPECT_GT(compare(extract_rooms(plan.grid, config), plan).iou, 0.7);
}

TEST(Rooms, TurnedMapHasTheSameRoomsElsewhere) {
  const Plan plan = floor_plan({});
  const TPose2D T(3.0, -1.5, deg_to_rad(33.0));
  const Rooms straight = extract_rooms(plan.grid);
  const Rooms turned = extract_rooms(moved(plan.grid, T.phi, T.x, T.y));
  ASSERT_EQ(straight.rooms.size(), turned.rooms.size());
  for (const Room& room : straight.rooms) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Room& other : turned.rooms)
      if (room_difference(room, other) < 0.2)
        nearest = std::min(nearest, (T.composePoint(room.centre) - other.centre).norm());
    EXPECT_LT(nearest, 0.15);
  }
}

TEST(Rooms, RectangleIsMeasuredExactly) {
  const Rooms rooms = extract_rooms(box(100, 60));
  ASSERT_EQ(rooms.rooms.size(), 1u);
  const Room& room = rooms.rooms.front();
  EXPECT_NEAR(room.area, 5.0 * 3.0, 1e-9);
  EXPECT_NEAR(room.elongation, 5.0 / 3.0, 1e-3);
  EXPECT_NEAR(room.perimeter, 2.0 * (5.0 + 3.0), 0.25);  // along the centres of the outermost cells
  EXPECT_NEAR(room.direction, 0.0, 1e-9);
  EXPECT_NEAR(room.centre.x, 1.0 + 0.5 + 2.5, 1e-9);
  EXPECT_NEAR(room.centre.y, -2.0 + 0.5 + 1.5, 1e-9);
  EXPECT_NEAR(room.box_min.x, 1.5, 1e-9);
  EXPECT_NEAR(room.box_max.y, 1.5, 1e-9);
}

TEST(Rooms, FinerMapHasTheSameRooms) {
  const Plan plan = floor_plan({});
  const Rooms coarse = extract_rooms(plan.grid);
  const Rooms fine = extract_rooms(moved(plan.grid, 0.0, 0.0, 0.0, 0.025));
  ASSERT_EQ(coarse.rooms.size(), fine.rooms.size());
  for (std::size_t i = 0; i < coarse.rooms.size(); ++i)
    EXPECT_LT((coarse.rooms[i].centre - fine.rooms[i].centre).norm(), 0.1);
}

TEST(Rooms, MapsWithoutFloorHaveNone) {
  for (const Occupancy all : {Occupancy::Unknown, Occupancy::Occupied})
    for (const RoomMethod method : {RoomMethod::Passages, RoomMethod::Visibility}) {
      RoomConfig config;
      config.method = method;
      EXPECT_TRUE(extract_rooms(OccupancyGrid(GridFrame{60, 40, 0.05, 0.0, 0.0}, all), config).rooms.empty());
    }
  EXPECT_TRUE(extract_rooms(OccupancyGrid()).rooms.empty());
  EXPECT_TRUE(extract_rooms(OccupancyGrid(GridFrame{1, 1, 0.05, 0.0, 0.0}, Occupancy::Free)).rooms.empty());
}

TEST(Rooms, NoiseIsSurvived) {
  const OccupancyGrid noise = with_salt(OccupancyGrid(GridFrame{300, 300, 0.05, 0.0, 0.0}, Occupancy::Free), 0.3, 4);
  for (const RoomMethod method : {RoomMethod::Passages, RoomMethod::Visibility}) {
    RoomConfig config;
    config.method = method;
    const Rooms rooms = extract_rooms(noise, config);
    for (const Room& room : rooms.rooms) EXPECT_TRUE(std::isfinite(room.elongation + room.shape[3]));
  }
}

/// Joins the most similar pair of clusters until none is similar enough: the definition, O(n^3).
std::vector<int> brute_force_clusters(const VisibilityMatrix& seen, double least) {
  std::vector<std::vector<std::size_t>> clusters;
  for (std::size_t i = 0; i < seen.size; ++i) clusters.push_back({i});
  const auto similarity = [&](std::size_t i, std::size_t j) {
    double both = 0.0;
    double any = 0.0;
    for (std::size_t k = 0; k < seen.size; ++k) {
      both += seen.get(i, k) && seen.get(j, k) ? 1.0 : 0.0;
      any += seen.get(i, k) || seen.get(j, k) ? 1.0 : 0.0;
    }
    return any > 0.0 ? both / any : 0.0;
  };
  while (true) {
    double best = least;
    std::pair<std::size_t, std::size_t> pair{0, 0};
    for (std::size_t a = 0; a < clusters.size(); ++a)
      for (std::size_t b = a + 1; b < clusters.size(); ++b) {
        double mean = 0.0;
        for (const std::size_t i : clusters[a])
          for (const std::size_t j : clusters[b]) mean += similarity(i, j);
        mean /= static_cast<double>(clusters[a].size() * clusters[b].size());
        if (mean > best) {
          best = mean;
          pair = {a, b};
        }
      }
    if (pair.second == 0) break;
    auto& into = clusters[pair.first];
    auto& from = clusters[pair.second];
    into.insert(into.end(), from.begin(), from.end());
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(pair.second));
  }
  std::vector<int> out(seen.size, -1);
  int next = 0;
  for (std::size_t i = 0; i < seen.size; ++i)
    for (const auto& cluster : clusters)
      if (out[i] < 0 && std::find(cluster.begin(), cluster.end(), i) != cluster.end()) {
        for (const std::size_t k : cluster) out[k] = next;
        ++next;
      }
  return out;
}

TEST(RoomClusters, ChainsGiveTheClustersOfTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed, "matrix");
    VisibilityMatrix seen;
    seen.size = 40;
    seen.words = 1;
    seen.bits.assign(seen.size, 0);
    for (std::size_t i = 0; i < seen.size; ++i)
      for (std::size_t j = i; j < seen.size; ++j)
        if (i == j || rng.uniform() < (i / 10 == j / 10 ? 0.7 : 0.15)) {
          seen.set(i, j);
          seen.set(j, i);
        }
    EXPECT_EQ(cluster_rows(seen, 0.25), brute_force_clusters(seen, 0.25));
  }
}

TEST(Rooms, PublicFloorMapsNotTunedOnAgreeWithRoomsDrawnByHand) {
  const char* data = std::getenv("RUBBLE_DATA");
  if (data == nullptr) GTEST_SKIP() << "set RUBBLE_DATA to the folder with the public data";
  for (const bool furnished : {false, true}) {
    RoomAgreement sum;
    double n = 0.0;
    for (const FloorMap& floor : floor_maps()) {
      if (floor.tuned) continue;
      const std::string base = std::string(data) + "/rooms/" + floor.name;
      const Rooms rooms = extract_rooms(read_floor_map(base + (furnished ? "_furnitures.png" : ".png")));
      const RoomAgreement agreement = compare_rooms(rooms.labels, read_true_rooms(base + "_gt_segmentation.png"));
      sum.precision += agreement.precision;
      sum.recall += agreement.recall;
      sum.iou += agreement.iou;
      n += 1.0;
    }
    EXPECT_GE(sum.precision / n, furnished ? 0.92 : 0.95);
    EXPECT_GE(sum.recall / n, furnished ? 0.92 : 0.95);
    EXPECT_GE(sum.iou / n, 0.82);
  }
}

}  // namespace
}  // namespace rubble::scoring
