#include "slam/grid/count_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "base/rng.h"
#include "slam/scan/level_scan.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Is p inside the triangle? `sure` becomes false next to an edge, where rounding decides.
bool in_triangle(const TPoint2D& p, const TPoint2D& a, const TPoint2D& b, const TPoint2D& c, bool& sure) {
  const auto side = [&](const TPoint2D& u, const TPoint2D& v) {
    const double area = (v.x - u.x) * (p.y - u.y) - (v.y - u.y) * (p.x - u.x);
    if (std::abs(area) < 1e-9) sure = false;
    return area > 0.0;
  };
  const bool s0 = side(a, b);
  const bool s1 = side(b, c);
  const bool s2 = side(c, a);
  return s0 == s1 && s1 == s2;
}

/// Length of the part of the line a-b that lies in a cell (Liang and Barsky).
double length_inside(const GridFrame& frame, Cell c, const TPoint2D& a, const TPoint2D& b) {
  double from = 0.0, to = 1.0;
  const auto clip = [&](double start, double delta, double low) {
    const double high = low + frame.resolution;
    if (delta == 0.0) {
      if (start < low || start > high) to = -1.0;
      return;
    }
    const double u = (low - start) / delta;
    const double v = (high - start) / delta;
    from = std::max(from, std::min(u, v));
    to = std::min(to, std::max(u, v));
  };
  clip(a.x, b.x - a.x, frame.x0 + c.x * frame.resolution);
  clip(a.y, b.y - a.y, frame.y0 + c.y * frame.resolution);
  return std::max(0.0, to - from) * std::hypot(b.x - a.x, b.y - a.y);
}

/// The rule of scan_polygon.h by brute force: every cell centre against every triangle of the scan polygons.
struct Oracle {
  std::set<std::pair<int, int>> hits;
  std::map<std::pair<int, int>, bool> passed;  ///< value: certain
};

Oracle touched_cells(const GridFrame& frame, const TPose2D& T_map_base, const ScanPoints& scan) {
  Oracle oracle;
  const TPoint2D origin = T_map_base.composePoint(scan.origin);
  const auto turned = [&](const TPoint2D& p, double angle) {
    return TPoint2D{origin.x + std::cos(angle) * (p.x - origin.x) - std::sin(angle) * (p.y - origin.y),
                    origin.y + std::sin(angle) * (p.x - origin.x) + std::cos(angle) * (p.y - origin.y)};
  };
  std::vector<std::pair<TPoint2D, TPoint2D>> chords;
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    const TPoint2D p = T_map_base.composePoint(scan.rays[i].end);
    if (scan.rays[i].hit) oracle.hits.insert({frame.cell(p).x, frame.cell(p).y});
    if (i == 0 || !scan.rays[i - 1].joined) chords.push_back({turned(p, -0.5 * scan.beam_width), p});
    if (scan.rays[i].joined) {
      chords.push_back({p, T_map_base.composePoint(scan.rays[i + 1].end)});
    } else {
      chords.push_back({p, turned(p, 0.5 * scan.beam_width)});
    }
  }
  std::vector<std::pair<TPoint2D, TPoint2D>> surfaces;
  for (std::size_t i = 0; i + 1 < scan.rays.size(); ++i) {
    const TPoint2D a = T_map_base.composePoint(scan.rays[i].end);
    const TPoint2D b = T_map_base.composePoint(scan.rays[i + 1].end);
    const bool neighbours = scan.rays[i].joined && scan.rays[i].hit && scan.rays[i + 1].hit;
    if (neighbours && std::hypot(b.x - a.x, b.y - a.y) <= kSurfaceGap) surfaces.push_back({a, b});
  }
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      if (oracle.hits.count({x, y}) != 0) continue;
      bool inside = false;
      bool sure = true;
      double crossing = 0.0;
      for (const auto& [a, b] : surfaces) crossing = std::max(crossing, length_inside(frame, {x, y}, a, b));
      if (crossing > 1e-9) continue;
      if (crossing > 0.0) sure = false;
      for (const auto& [a, b] : chords) inside = in_triangle(frame.centre({x, y}), origin, a, b, sure) || inside;
      if (inside || !sure) oracle.passed[{x, y}] = sure;
    }
  }
  return oracle;
}

/// A made-up scan: random ranges with jumps, misses and gaps.
ScanPoints random_scan(Rng& rng) {
  ScanPoints scan;
  scan.origin = {rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2)};
  scan.beam_width = deg_to_rad(240.0) / 90.0;
  double range = rng.uniform(0.3, 3.0);
  bool joined_before = false;
  for (int beam = 0; beam < 90; ++beam) {
    const double kind = rng.uniform();
    const double jump = rng.uniform(0.1, 3.9);
    range = kind < 0.1 ? jump : range;
    if (kind > 0.9) {
      if (joined_before) scan.rays.back().joined = false;
      joined_before = false;
      continue;
    }
    const double bearing = -2.0 + beam * scan.beam_width;
    const TPoint2D end{scan.origin.x + range * std::cos(bearing), scan.origin.y + range * std::sin(bearing)};
    const bool hit = kind < 0.7;
    scan.rays.push_back({end, hit, true});
    (hit ? scan.hits : scan.passes).push_back(end);
    joined_before = true;
  }
  if (!scan.rays.empty()) scan.rays.back().joined = false;
  return scan;
}

TEST(CountMap, StampEqualsBruteForceOverAllCells) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "scan");
    CountMap map(200, 200, 0.05);
    const double x = rng.uniform(-0.5, 0.5);
    const double y = rng.uniform(-0.5, 0.5);
    const double phi = rng.uniform(-kPi, kPi);
    const TPose2D T_map_base{x, y, phi};
    const ScanPoints scan = random_scan(rng);
    map.stamp(T_map_base, scan);
    ASSERT_EQ(map.frame().width, 200);
    const Oracle oracle = touched_cells(map.frame(), T_map_base, scan);
    for (int row = 0; row < 200; ++row) {
      for (int column = 0; column < 200; ++column) {
        const std::pair<int, int> key{column, row};
        const bool hit = oracle.hits.count(key) != 0;
        const auto pass = oracle.passed.find(key);
        if (pass != oracle.passed.end() && !pass->second) continue;  // on an edge
        EXPECT_EQ(map.occupied({column, row}), hit ? 1 : 0) << column << ' ' << row;
        EXPECT_EQ(map.seen({column, row}), hit || pass != oracle.passed.end() ? 1 : 0) << column << ' ' << row;
      }
    }
  }
}

ScanPoints room_scan(const TPose2D& T_world_base, std::uint64_t seed) {
  const robot::RobotModel model;
  Rng noise(seed, "scan");
  LevelScanConfig config;
  config.carve_misses = true;
  LevelScan level_scan(model.T_base_laser, config);
  return level_scan.points(slam_test::scan_at(slam_test::furnished_room(), T_world_base, model, Stamp{0}, 0.01, noise));
}

TEST(CountMap, RatioIsEquationOneAndIsRoundedTo255ths) {
  CountMap map(400, 400, 0.05);
  for (std::uint64_t k = 0; k < 40; ++k) map.stamp(TPose2D(0.01 * static_cast<double>(k), 0.0, 0.0), room_scan({}, k));
  int seen = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) {
      const Cell c{x, y};
      const double ratio = map.seen(c) == 0 ? 0.0 : static_cast<double>(map.occupied(c)) / map.seen(c);  // eq. (1)
      EXPECT_EQ(map.p_occ(c), ratio);
      EXPECT_NEAR(map.p_occ_255(c) / 255.0, ratio, 0.5 / 255.0 + 1e-12);
      EXPECT_LE(map.occupied(c), map.seen(c));
      seen += map.seen(c) > 0;
    }
  }
  EXPECT_GT(seen, 5000);
}

TEST(CountMap, EachTouchedCellCountsOncePerScan) {
  CountMap map(400, 400, 0.05);
  map.stamp(TPose2D(), room_scan({}, 1));
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) EXPECT_LE(map.seen({x, y}), 1);
  }
}

TEST(CountMap, HitCellIsNotFreedByOtherBeamsOfTheScan) {
  CountMap map(100, 100, 0.1);
  ScanPoints scan;
  scan.hits = {{1.02, 0.0}};                  // in the cell that ...
  scan.passes = {{3.0, 0.01}, {3.0, -0.01}};  // ... these go through
  for (int k = 0; k < 10; ++k) map.stamp(TPose2D(0.0, 0.05, 0.0), scan);
  EXPECT_EQ(map.p_occ(map.frame().cell({1.02, 0.05})), 1.0);
  EXPECT_EQ(map.p_occ(map.frame().cell({0.52, 0.05})), 0.0);
  EXPECT_EQ(map.seen(map.frame().cell({0.52, 0.05})), 10);
}

TEST(CountMap, NoGapsNearTheRobot) {
  CountMap map(400, 400, 0.05);
  const ScanPoints scan = room_scan({}, 3);
  map.stamp(TPose2D(), scan);
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) {
      const TPoint2D p = map.frame().centre({x, y});
      const double dx = p.x - scan.origin.x;
      const double dy = p.y - scan.origin.y;
      const bool in_view = std::abs(std::atan2(dy, dx)) < deg_to_rad(118.0);
      if (in_view && std::hypot(dx, dy) < 0.8) {
        EXPECT_EQ(map.seen({x, y}), 1) << p.x << ' ' << p.y;
      }
    }
  }
}

TEST(CountMap, UnknownFreeAndOccupiedStayApart) {
  CountMap map(100, 100, 0.1);
  ScanPoints scan;
  scan.hits = {{2.0, 0.0}};
  map.stamp(TPose2D(0.0, 0.05, 0.0), scan);
  const OccupancyGrid grid = map.classify();
  EXPECT_EQ(grid[grid.cell({2.0, 0.05})], Occupancy::Occupied);
  EXPECT_EQ(grid[grid.cell({1.0, 0.05})], Occupancy::Free);
  EXPECT_EQ(grid[grid.cell({3.0, 0.05})], Occupancy::Unknown);
}

TEST(CountMap, BeamsOfUnknownOrderGiveTheSameMapAsOrderedOnes) {
  ScanPoints ordered = room_scan({}, 5);
  ScanPoints shuffled = ordered;
  shuffled.rays.clear();
  std::reverse(shuffled.hits.begin(), shuffled.hits.end());
  CountMap a(400, 400, 0.05);
  CountMap b(400, 400, 0.05);
  a.stamp(TPose2D(0.1, 0.2, 0.3), ordered);
  b.stamp(TPose2D(0.1, 0.2, 0.3), shuffled);
  EXPECT_EQ(slam_test::p_occ_of(a), slam_test::p_occ_of(b));
  int differing = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) differing += a.seen({x, y}) != b.seen({x, y});
  }
  EXPECT_EQ(differing, 0);
}

TEST(CountMap, GrowthKeepsWhatIsKnownWhereItIs) {
  CountMap small(64, 64, 0.05);
  CountMap large(1200, 1200, 0.05);
  for (int k = 0; k < 30; ++k) {
    const TPose2D T_map_base{0.5 * k, -0.4 * k, 0.2 * k};
    const ScanPoints scan = room_scan({}, static_cast<std::uint64_t>(k));
    small.stamp(T_map_base, scan);
    large.stamp(T_map_base, scan);
  }
  EXPECT_GT(small.frame().width, 64);
  for (int y = 0; y < small.frame().height; ++y) {
    for (int x = 0; x < small.frame().width; ++x) {
      const Cell there = large.frame().cell(small.frame().centre({x, y}));
      ASSERT_EQ(small.seen({x, y}), large.seen(there));
      ASSERT_EQ(small.occupied({x, y}), large.occupied(there));
    }
  }
}

TEST(CountMap, BeyondTheLargestSizePointsAreDroppedAndCounted) {
  CountMap map(100, 100, 0.1, 356);
  ScanPoints scan;
  scan.hits = {{500.0, 0.0}, {2.0, 1.0}};
  map.stamp(TPose2D(), scan);
  EXPECT_EQ(map.frame().width, 356);
  EXPECT_EQ(map.frame().height, 100);
  EXPECT_EQ(map.dropped_hits(), 1u);
  EXPECT_EQ(map.p_occ(map.frame().cell({2.0, 1.0})), 1.0);
  map.stamp(TPose2D(-9000.0, 0.0, 0.0), scan);
  EXPECT_EQ(map.dropped_hits(), 3u);
}

TEST(CountMap, FullCountsAreHalvedAndTheRatioStays) {
  CountMap map(20, 20, 0.1);
  ScanPoints hit;
  hit.hits = {{0.5, 0.0}};
  ScanPoints pass;
  pass.passes = {{0.8, 0.0}};
  const TPose2D T_map_base{0.0, 0.05, 0.0};
  const Cell cell = map.frame().cell({0.5, 0.05});
  for (int k = 0; k < 70000; ++k) {
    map.stamp(T_map_base, k % 4 == 0 ? hit : pass);
    ASSERT_LE(map.occupied(cell), map.seen(cell));
  }
  EXPECT_GT(map.seen(cell), 30000);
  EXPECT_LT(map.seen(cell), 40000);
  EXPECT_NEAR(map.p_occ(cell), 0.25, 0.01);
}

/// What `earlier` counted, in the frame of a map that grew out of it.
void take_back_to(const CountMap& earlier, CountMap& map) {
  const GridFrame& frame = map.frame();
  std::vector<std::uint16_t> seen(frame.size(), 0), occupied(frame.size(), 0);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const Cell then = earlier.frame().cell(frame.centre({x, y}));
      if (!earlier.frame().inside(then)) continue;
      seen[frame.index({x, y})] = static_cast<std::uint16_t>(earlier.seen(then));
      occupied[frame.index({x, y})] = static_cast<std::uint16_t>(earlier.occupied(then));
    }
  map.assign(frame, std::move(seen), std::move(occupied));
}

void expect_the_same_cells(const CountMap& one, const CountMap& other) {
  ASSERT_EQ(one.frame(), other.frame());
  for (int y = 0; y < one.frame().height; ++y)
    for (int x = 0; x < one.frame().width; ++x) {
      ASSERT_EQ(one.seen({x, y}), other.seen({x, y})) << x << ' ' << y;
      ASSERT_EQ(one.occupied({x, y}), other.occupied({x, y})) << x << ' ' << y;
    }
  EXPECT_EQ(slam_test::p_occ_of(one), slam_test::p_occ_of(other));
}

TEST(CountMap, RestampingIsTakingBackAndStampingAnew) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "restamp");
    CountMap one(100, 100, 0.05, 612);  // grows, and ends before all scans fit
    CountMap other(100, 100, 0.05, 612);
    for (int k = 0; k < 12; ++k) {
      const ScanPoints scan = room_scan({}, seed * 100 + static_cast<std::uint64_t>(k));
      const double far = k % 3 == 0 ? 12.0 : 0.05;
      const double x = rng.uniform(-12.0, 12.0), y = rng.uniform(-12.0, 12.0), phi = rng.uniform(-3.0, 3.0);
      const double dx = rng.uniform(-far, far), dy = rng.uniform(-far, far), turn = rng.uniform(-0.3, 0.3);
      const TPose2D before{x, y, phi};
      const TPose2D after{x + dx, y + dy, phi + turn};
      const CountMap earlier = one;
      one.stamp(before, scan);
      take_back_to(earlier, one);
      one.stamp(after, scan);
      other.stamp(before, scan);
      other.restamp(before, after, scan);
    }
    ASSERT_EQ(one.dropped_hits(), other.dropped_hits());
    expect_the_same_cells(one, other);
  }
}

TEST(CountMap, StretchesOfARowHoldWhatItsCellsCounted) {
  CountMap map(300, 100, 0.05);  // not whole tiles
  for (int k = 0; k < 5; ++k) map.stamp({2.0 * k, -1.5 * k, 0.3 * k}, room_scan({}, static_cast<std::uint64_t>(k)));
  const GridFrame& frame = map.frame();
  Rng rng(1, "stretches");
  for (int y = 0; y < frame.height; ++y) {
    const int from = static_cast<int>(rng.uniform(0.0, frame.width));
    const int to = static_cast<int>(rng.uniform(from, frame.width + 1.0));
    std::vector<int> seen(static_cast<std::size_t>(frame.width), 0), occupied = seen;
    int last = from;
    map.for_seen(y, from, to, [&](int x, int count, const std::uint16_t* n, const std::uint16_t* hits) {
      ASSERT_GE(x, last);
      ASSERT_LE(x + count, to);
      last = x + count;
      std::copy_n(n, count, seen.begin() + x);
      std::copy_n(hits, count, occupied.begin() + x);
    });
    for (int x = 0; x < frame.width; ++x) {
      const bool asked = x >= from && x < to;
      ASSERT_EQ(seen[static_cast<std::size_t>(x)], asked ? map.seen({x, y}) : 0) << x << ' ' << y;
      ASSERT_EQ(occupied[static_cast<std::size_t>(x)], asked ? map.occupied({x, y}) : 0) << x << ' ' << y;
    }
  }
}

TEST(CountMap, TakesMemoryOnlyWhereSomethingWasSeen) {
  CountMap map(64, 64, 0.05);
  for (int k = 0; k < 400; ++k)  // along two corridors of 200 m, round a corner
    map.stamp({std::min(k, 200) * 1.0, std::max(0, k - 200) * 1.0, 0.0}, room_scan({}, 7));
  const GridFrame& frame = map.frame();
  EXPECT_GT(frame.width, 4000);
  EXPECT_GT(frame.height, 4000);
  std::size_t tiles = 0;
  for (int y = 0; y < frame.height; y += CountTiles::kSide)
    for (int x = 0; x < frame.width; x += CountTiles::kSide) tiles += map.tiles().counted({x, y}) != nullptr ? 1 : 0;
  // Scans reach 4.5 m: a way of 400 m has seen at most 3,700 m2, its edges touch three tiles for each along it.
  EXPECT_LT(tiles, 3700 / (3.2 * 3.2) + 2 * 400 / 3.2 + 20);
  EXPECT_GT(tiles, 400u / 3);
}

TEST(CountMap, BegunAnewOrCopiedItKeepsNothingOfBefore) {
  CountMap used(100, 100, 0.05);
  for (int k = 0; k < 6; ++k) used.stamp({3.0 * k, 1.0, 0.5 * k}, room_scan({}, 11));
  const CountMap before = used;
  const std::vector<std::uint8_t> known = slam_test::p_occ_of(used);
  ASSERT_GT(std::count(known.begin(), known.end(), 255), 50);
  used.begin_anew(0.0, 0.0);
  for (const std::uint8_t p_occ : slam_test::p_occ_of(used)) ASSERT_EQ(p_occ, 0);
  EXPECT_EQ(slam_test::p_occ_of(before), known) << "a copy has memory of its own";
  CountMap fresh(used.frame().width, used.frame().height, 0.05);
  fresh.begin_anew(used.frame().x0 - fresh.frame().x0, used.frame().y0 - fresh.frame().y0);
  for (CountMap* const map : {&used, &fresh})
    for (int k = 0; k < 6; ++k) map->stamp({2.0 * k, 0.5, -0.5 * k}, room_scan({}, 12));
  expect_the_same_cells(used, fresh);
}

TEST(CountMap, ImpossibleSizesAreRefused) {
  EXPECT_THROW(CountMap(0, 10, 0.05), std::invalid_argument);
  EXPECT_THROW(CountMap(10, 10, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace rubble::slam
