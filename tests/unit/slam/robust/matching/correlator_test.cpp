#include "slam/robust/matching/correlator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/planar.h"
#include "tests/support/slam_surfels.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kCell = 0.05;
constexpr double kBlur = 0.06;

/// Some walls, different for each seed.
slam_test::World random_walls(Rng& rng) {
  slam_test::World world;
  slam_test::add_box(world, -2.0, -1.5, 2.5, 1.8);
  for (int k = 0; k < 4; ++k) {
    const double x = rng.uniform(-1.8, 1.5);
    const double y = rng.uniform(-1.3, 1.0);
    slam_test::add_box(world, x, y, x + rng.uniform(0.1, 0.7), y + rng.uniform(0.1, 0.7));
  }
  return world;
}

struct Scene {
  SurfelGrid target;
  Correlator correlator;
  std::vector<OrientedPoint> points;
};

Scene random_scene(Rng& rng, const TPose2D& T_target_points) {
  Scene scene;
  const slam_test::World world = random_walls(rng);
  scene.target = slam_test::surfel_grid(slam_test::surface_points(world, 0.04), 0.1);
  scene.correlator.build(scene.target.surfels(), kCell, kBlur);
  std::vector<OrientedPoint> some;
  for (const OrientedPoint& p : slam_test::surface_points(world, 0.09))
    if (rng.uniform() < 0.5) some.push_back(p);
  scene.points = slam_test::seen_from(T_target_points, some);
  return scene;
}

/// The cells of points turned by phi and moved to (x, y), as the definition has it.
std::vector<Cell> cells_at(const Scene& scene, double phi, double x, double y) {
  std::vector<Cell> cells;
  const auto c = static_cast<float>(std::cos(phi));
  const auto s = static_cast<float>(std::sin(phi));
  for (const OrientedPoint& p : scene.points)
    cells.push_back(
        scene.correlator.cell(c * p.x - s * p.y + static_cast<float>(x), s * p.x + c * p.y + static_cast<float>(y)));
  return cells;
}

/// The whole search at once.
std::optional<CorrelativeSearch::Found> search(const Correlator& target, const std::vector<OrientedPoint>& points,
                                               const SearchWindow& window, double floor,
                                               const std::optional<SearchExclusion>& exclusion, Work* work = nullptr) {
  CorrelativeSearch search;
  search.start(target, points, window, floor, exclusion);
  Work budget = std::numeric_limits<Work>::max();
  search.advance(budget);
  if (work != nullptr) *work += std::numeric_limits<Work>::max() - budget;
  return search.found();
}

/// The best score of all poses on the search's raster, one by one.
double best_by_trying(const Scene& scene, const SearchWindow& window, double angle_step,
                      const std::optional<SearchExclusion>& exclusion) {
  double best = 0.0;
  const int angles = static_cast<int>(std::ceil(window.angle / angle_step));
  const int cells = static_cast<int>(std::ceil(window.distance / kCell));
  for (int a = -angles; a <= angles; ++a) {
    const double phi = window.centre.phi + a * angle_step;
    const std::vector<Cell> turned = cells_at(scene, phi, window.centre.x, window.centre.y);
    for (int y = -cells; y <= cells; ++y)
      for (int x = -cells; x <= cells; ++x) {
        const TPose2D pose{window.centre.x + x * kCell, window.centre.y + y * kCell, phi};
        if (exclusion && length(pose.x - exclusion->pose.x, pose.y - exclusion->pose.y) < exclusion->distance &&
            std::abs(wrap_angle(pose.phi - exclusion->pose.phi)) < exclusion->angle)
          continue;
        best = std::max(best, scene.correlator.value(turned, x, y, 0));
      }
  }
  return best;
}

/// Angles are as fine as a cell at the farthest point asks for.
double angle_step_of(const std::vector<OrientedPoint>& points) {
  double reach = 0.5;
  for (const OrientedPoint& p : points) reach = std::max(reach, static_cast<double>(std::sqrt(p.x * p.x + p.y * p.y)));
  return std::max(kCell / std::min(reach, 12.0), deg_to_rad(0.4));
}

TEST(Correlator, ValueFallsOffFromSurfelsAsAGaussian) {
  Rng rng(1, "walls");
  const Scene scene = random_scene(rng, {});
  for (int k = 0; k < 500; ++k) {
    const auto x = static_cast<float>(rng.uniform(-2.0, 2.5));
    const auto y = static_cast<float>(rng.uniform(-1.5, 1.8));
    const Cell cell = scene.correlator.cell(x, y);
    double expected = 0.0;
    for (const Surfel& q : scene.target.surfels()) {
      const Cell c = scene.correlator.cell(q.x, q.y);
      const double d = kCell * length(c.x - cell.x, c.y - cell.y);
      const int reach = std::max(std::abs(c.x - cell.x), std::abs(c.y - cell.y));
      if (reach <= 3) expected = std::max(expected, std::exp(-0.5 * d * d / (kBlur * kBlur)));
    }
    EXPECT_NEAR(scene.correlator.value({cell}, 0, 0, 0), expected, 1.01 / 255.0);
  }
}

/// Walls of rooms strewn over a square of `side` metres about the origin.
SurfelGrid strewn_rooms(double side, std::uint64_t seed) {
  Rng rng(seed, "rooms");
  slam_test::World world;
  for (int k = 0; k < 40; ++k) {
    const double x = rng.uniform(-0.5, 0.45) * side;
    const double y = rng.uniform(-0.5, 0.45) * side;
    slam_test::add_box(world, x, y, x + rng.uniform(1.0, 0.05 * side), y + rng.uniform(1.0, 0.05 * side));
  }
  slam_test::add_box(world, -0.5 * side, -0.5 * side, 0.5 * side, 0.5 * side);
  return slam_test::surfel_grid(slam_test::surface_points(world, 0.1), 0.15);
}

/// The raster of what lies far apart is coarser, and so no larger than that of a hall; the place is found to a cell.
TEST(Correlator, TheRasterOfWhatLiesFarApartTakesNoMoreWorkThanThatOfAHall) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const double side : {70.0, 100.0, 300.0, 600.0}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", side " + std::to_string(side));
      const SurfelGrid rooms = strewn_rooms(side, seed);
      Correlator correlator;
      Work work = 0;
      correlator.build(rooms.surfels(), kCell, kBlur, &work);
      EXPECT_EQ(correlator.resolution() > kCell, side > 70.0);
      EXPECT_LT(work - 30 * static_cast<Work>(rooms.surfels().size()), 5200000);
      const TPose2D truth(0.3, -0.2, 0.02);
      const auto found = search(correlator, slam_test::seen_from(truth, rooms.thinned_to(kSearchedPoints)),
                                {{}, 0.6, 0.1}, 0.3, std::nullopt);
      ASSERT_TRUE(found);
      EXPECT_LT(length(found->pose.x - truth.x, found->pose.y - truth.y), 1.5 * correlator.resolution());
      EXPECT_LT(std::abs(wrap_angle(found->pose.phi - truth.phi)), 0.02);
    }
}

TEST(Correlator, LevelsAreMaximaOverSquares) {
  Rng rng(2, "walls");
  const Scene scene = random_scene(rng, {});
  for (int level = 0; level < Correlator::kLevels; ++level)
    for (int k = 0; k < 200; ++k) {
      const Cell cell =
          scene.correlator.cell(static_cast<float>(rng.uniform(-3.5, 4.0)), static_cast<float>(rng.uniform(-3.0, 3.3)));
      double most = 0.0;
      for (int v = 0; v < (1 << level); ++v)
        for (int u = 0; u < (1 << level); ++u) most = std::max(most, scene.correlator.value({cell}, u, v, 0));
      EXPECT_EQ(scene.correlator.value({cell}, 0, 0, level), most);
    }
}

TEST(CorrelativeSearch, FindsTheBestOfAllPoses) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "search");
    const TPose2D truth{rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.2, 0.2)};
    const Scene scene = random_scene(rng, truth);
    const SearchWindow window{{0.0, 0.0, 0.0}, 0.45, 0.25};
    const double step = angle_step_of(scene.points);

    const auto found = search(scene.correlator, scene.points, window, 0.2, std::nullopt);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->score, best_by_trying(scene, window, step, std::nullopt), 1e-12);
    EXPECT_LT(length(found->pose.x - truth.x, found->pose.y - truth.y), 0.08);
    EXPECT_LT(std::abs(wrap_angle(found->pose.phi - truth.phi)), 0.03);

    const SearchExclusion exclusion{found->pose, 0.2, 0.1};
    const auto other = search(scene.correlator, scene.points, window, 0.1, exclusion);
    ASSERT_TRUE(other);
    EXPECT_NEAR(other->score, best_by_trying(scene, window, step, exclusion), 1e-12);
    EXPECT_TRUE(length(other->pose.x - found->pose.x, other->pose.y - found->pose.y) >= 0.2 ||
                std::abs(wrap_angle(other->pose.phi - found->pose.phi)) >= 0.1);
  }
}

TEST(RivalSearch, IsTheBestAndThenTheBestElsewhereWhereverItIsStopped) {
  int rivals = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "search");
    const Scene scene = random_scene(rng, {0.1, -0.1, 0.05});
    const SearchWindow window{{0.05, 0.0, 0.0}, 0.5, 0.2};
    const RivalConfig config{0.3, 0.12 * static_cast<double>(seed), 0.2, 0.1};
    const auto best = search(scene.correlator, scene.points, window, config.least_score, std::nullopt);
    ASSERT_TRUE(best);
    const auto rival = search(scene.correlator, scene.points, window, config.share * best->score,
                              SearchExclusion{best->pose, config.distance, config.angle});
    rivals += rival ? 1 : 0;
    for (const Work slice : {Work{1}, Work{20000}, std::numeric_limits<Work>::max()}) {
      RivalSearch both(config);
      EXPECT_FALSE(both.running());
      both.start(scene.correlator, scene.points, window);
      EXPECT_TRUE(both.running());
      Work budget = slice;
      while (!both.advance(budget)) {
        ASSERT_LE(budget, 0) << "gave up with work left";
        budget = slice;
      }
      EXPECT_FALSE(both.running());
      ASSERT_TRUE(both.best());
      EXPECT_EQ(both.best()->score, best->score);
      EXPECT_EQ(both.best()->pose, best->pose);
      ASSERT_EQ(both.rival().has_value(), rival.has_value());
      if (rival) {
        EXPECT_EQ(both.rival()->score, rival->score);
      }
    }
  }
  EXPECT_GT(rivals, 0);
  EXPECT_LT(rivals, 8);
}

TEST(RivalSearch, WithoutABestPlaceThereIsNoRival) {
  Rng rng(1, "search");
  const Scene scene = random_scene(rng, {0.1, -0.1, 0.05});
  RivalSearch both({0.2, 0.9});
  Work budget = std::numeric_limits<Work>::max();
  both.start(scene.correlator, scene.points, {{}, 0.3, 0.1});
  ASSERT_TRUE(both.advance(budget));
  ASSERT_TRUE(both.best());
  both.start(scene.correlator, scene.points, {{30.0, 30.0, 0.0}, 0.3, 0.1});
  ASSERT_TRUE(both.advance(budget));
  EXPECT_FALSE(both.best()) << "of the search before";
  EXPECT_FALSE(both.rival());
}

TEST(CorrelativeSearch, LookingAgainFindsWhatANewSearchFinds) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "search");
    const Scene scene = random_scene(rng, {0.1, -0.1, 0.05});
    const SearchWindow window{{0.05, 0.0, 0.0}, 0.5, 0.2};
    CorrelativeSearch twice;
    twice.start(scene.correlator, scene.points, window, 0.4, std::nullopt, 0.2);
    Work budget = std::numeric_limits<Work>::max();
    ASSERT_TRUE(twice.advance(budget));
    ASSERT_TRUE(twice.found());
    const SearchExclusion exclusion{twice.found()->pose, 0.2, 0.1};
    twice.start_again(0.25, exclusion);
    ASSERT_TRUE(twice.advance(budget));
    const auto anew = search(scene.correlator, scene.points, window, 0.25, exclusion);
    ASSERT_EQ(twice.found().has_value(), anew.has_value());
    if (!anew) continue;
    EXPECT_EQ(twice.found()->pose, anew->pose);
    EXPECT_EQ(twice.found()->score, anew->score);
  }
}

TEST(Correlator, QuartersAreExactAboveTheFloorAndGivenUpOnlyBelow) {
  Rng rng(7, "bounds");
  const Scene scene = random_scene(rng, {});
  int exact = 0;
  int given_up = 0;
  for (int k = 0; k < 2000; ++k) {
    const std::vector<Cell> cells =
        cells_at(scene, rng.uniform(-0.3, 0.3), rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5));
    const int level = static_cast<int>(rng.below(Correlator::kLevels));
    const double floor = rng.uniform(0.0, 1.0);
    const double whole = 255.0 * static_cast<double>(cells.size());
    std::vector<Correlator::Sums> around;
    Correlator::RootWork work;
    scene.correlator.roots(cells, 0, 0, 1, 1, work, around);
    Work looked_at = 0;
    const auto quarters =
        scene.correlator.quarters(cells, 0, 0, level, around[0], static_cast<std::uint32_t>(floor * whole), looked_at);
    EXPECT_LE(looked_at, static_cast<Work>(cells.size()));
    for (std::size_t q = 0; q < 4; ++q) {
      const int half = 1 << level;
      const double value = scene.correlator.value(cells, (q & 1) != 0 ? half : 0, (q & 2) != 0 ? half : 0, level);
      if (!quarters) {
        EXPECT_LE(value, floor);
        ++given_up;
        continue;
      }
      EXPECT_EQ((*quarters)[q].whole / whole, value);
      std::uint32_t sum = 0;
      for (const std::uint32_t part : (*quarters)[q].parts) sum += part;
      EXPECT_EQ(sum, (*quarters)[q].whole);
      ++exact;
    }
  }
  EXPECT_GT(exact, 1000);
  EXPECT_GT(given_up, 1000);
}

TEST(Correlator, RootsBoundAllThatBeginsInThemPartByPart) {
  Rng rng(8, "roots");
  const Scene scene = random_scene(rng, {});
  int tight = 0;
  for (int k = 0; k < 40; ++k) {
    const std::vector<Cell> cells =
        cells_at(scene, rng.uniform(-3.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0));
    const int columns = 1 + static_cast<int>(rng.below(20));
    const int rows = 1 + static_cast<int>(rng.below(6));
    const int x = static_cast<int>(rng.below(40)) - 20 - columns * Correlator::kRootCells / 2;
    const int y = static_cast<int>(rng.below(40)) - 20 - rows * Correlator::kRootCells / 2;
    std::vector<Correlator::Sums> roots;
    Correlator::RootWork work;
    scene.correlator.roots(cells, x, y, columns, rows, work, roots);
    ASSERT_EQ(roots.size(), static_cast<std::size_t>(columns * rows));
    for (int n = 0; n < 60; ++n) {
      const int u = static_cast<int>(rng.below(static_cast<std::uint32_t>(columns * Correlator::kRootCells)));
      const int v = static_cast<int>(rng.below(static_cast<std::uint32_t>(rows * Correlator::kRootCells)));
      const Correlator::Sums& root =
          roots[static_cast<std::size_t>(v / Correlator::kRootCells * columns + u / Correlator::kRootCells)];
      for (std::size_t s = 0; s < Correlator::kStretches; ++s) {
        const std::size_t begin = cells.size() * s / Correlator::kStretches;
        const std::size_t end = cells.size() * (s + 1) / Correlator::kStretches;
        const std::vector<Cell> part(cells.begin() + static_cast<std::ptrdiff_t>(begin),
                                     cells.begin() + static_cast<std::ptrdiff_t>(end));
        const double sum = scene.correlator.value(part, x + u, y + v, 0) * 255.0 * static_cast<double>(part.size());
        EXPECT_GE(root.parts[s] + 1e-6, sum);
        tight += sum > 0.5 * root.parts[s] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(tight, 100);
}

TEST(CorrelativeSearch, NothingIsFoundBelowTheFloor) {
  Rng rng(3, "search");
  const Scene scene = random_scene(rng, {0.1, 0.1, 0.1});
  const SearchWindow window{{}, 0.3, 0.2};
  const auto best = search(scene.correlator, scene.points, window, 0.0, std::nullopt);
  ASSERT_TRUE(best);
  EXPECT_FALSE(search(scene.correlator, scene.points, window, best->score, std::nullopt));
  EXPECT_TRUE(search(scene.correlator, scene.points, window, best->score - 1e-9, std::nullopt));
}

TEST(CorrelativeSearch, SlicesOfAnySizeEndAlike) {
  Rng rng(4, "search");
  const Scene scene = random_scene(rng, {0.2, -0.1, 0.15});
  const SearchWindow window{{}, 0.6, 0.3};
  const auto whole = search(scene.correlator, scene.points, window, 0.3, std::nullopt);
  ASSERT_TRUE(whole);
  for (const Work slice : {Work{1}, Work{1000}, Work{12345}, Work{1000000}}) {
    CorrelativeSearch sliced;
    sliced.start(scene.correlator, scene.points, window, 0.3);
    int slices = 0;
    for (bool over = false; !over; ++slices) {
      Work budget = slice;
      over = sliced.advance(budget);
      ASSERT_LT(slices, 10000000);
    }
    if (slice <= 12345) {
      EXPECT_GT(slices, 5) << slice;
    }
    ASSERT_TRUE(sliced.found());
    EXPECT_EQ(sliced.found()->pose, whole->pose);
    EXPECT_EQ(sliced.found()->score, whole->score);
  }
}

TEST(CorrelativeSearch, WorkIsCountedAndTakenFromTheBudget) {
  Rng rng(5, "search");
  const Scene scene = random_scene(rng, {});
  Work small = 0;
  Work large = 0;
  search(scene.correlator, scene.points, {{}, 0.2, 0.1}, 0.3, std::nullopt, &small);
  search(scene.correlator, scene.points, {{}, 1.5, 0.5}, 0.3, std::nullopt, &large);
  EXPECT_GT(small, 0);
  EXPECT_GT(large, small);
}

TEST(CorrelativeSearch, WithoutPointsOrTargetNothingIsFound) {
  Rng rng(6, "search");
  const Scene scene = random_scene(rng, {});
  EXPECT_FALSE(search(scene.correlator, {}, {{}, 0.5, 0.2}, 0.1, std::nullopt));
  Correlator empty;
  empty.build({}, kCell, kBlur);
  EXPECT_FALSE(search(empty, scene.points, {{}, 0.5, 0.2}, 0.1, std::nullopt));
}

}  // namespace
}  // namespace rubble::slam
