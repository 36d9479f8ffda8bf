#include "slam/robust/matching/cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rng.h"
#include "tests/support/slam_key_frames.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::RobotModel;

double distance_to_walls(const slam_test::World& world, const TPoint2D& p) {
  double nearest = 1e9;
  for (const slam_test::Segment& s : world) {
    const TPoint2D along = s.b - s.a;
    const double t = ((p.x - s.a.x) * along.x + (p.y - s.a.y) * along.y) / (along.x * along.x + along.y * along.y);
    nearest = std::min(nearest, distance(p, s.a + along * std::min(1.0, std::max(0.0, t))));
  }
  return nearest;
}

TPoint2D at(double bearing, double range) { return {range * std::cos(bearing), range * std::sin(bearing)}; }

TPoint2D point(const OrientedPoint& p) { return {static_cast<double>(p.x), static_cast<double>(p.y)}; }

TEST(Cloud, PointsLieOnWallsApartAndLookAtTheLaser) {
  const RobotModel model;
  const slam_test::World world = slam_test::furnished_room();
  const Cloud cloud = slam_test::cloud_at(world, {}, model);
  ASSERT_GT(cloud.points.size(), 80u);
  int oriented = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const TPoint2D p = point(cloud.points[i]);
    EXPECT_LT(distance_to_walls(world, p), 1e-3);
    if (i > 0) {
      EXPECT_GT(distance(p, point(cloud.points[i - 1])), 0.079);
    }
    if (!cloud.points[i].has_normal()) continue;
    ++oriented;
    const TPoint2D n(static_cast<double>(cloud.points[i].nx), static_cast<double>(cloud.points[i].ny));
    EXPECT_NEAR(length(n), 1.0, 1e-5);
    EXPECT_LE(n.x * (p.x - cloud.laser.x) + n.y * (p.y - cloud.laser.y), 1e-6);
  }
  EXPECT_GT(oriented, static_cast<int>(cloud.points.size()) * 3 / 4);
}

TEST(Cloud, NormalsStandOnAWall) {
  const RobotModel model;
  const slam_test::World wall{{{2.0, -3.0}, {2.0, 3.0}}};
  for (const OrientedPoint& p : slam_test::cloud_at(wall, {}, model).points) {
    if (!p.has_normal()) continue;
    EXPECT_NEAR(p.nx, -1.0, 1e-4);
    EXPECT_NEAR(p.ny, 0.0, 1e-2);
  }
}

RobotModel coarse_far_sight() {
  RobotModel model;
  model.laser.beams = 181;
  model.laser.angle_step = deg_to_rad(1.0);
  model.laser.angle_min = deg_to_rad(-90.0);
  model.laser.range_max = 30.0;
  return model;
}

TEST(Cloud, WallsSeenAtAGrazingAngleHaveNormals) {
  const slam_test::World corridor{{{-2.0, 1.0}, {20.0, 1.0}}, {{-2.0, -1.0}, {20.0, -1.0}}};
  int far = 0;
  for (const OrientedPoint& p : slam_test::cloud_at(corridor, {}, coarse_far_sight()).points) {
    if (p.x < 3.0F || p.x > 5.0F) continue;
    ++far;
    ASSERT_TRUE(p.has_normal()) << p.x << " " << p.y;
    EXPECT_NEAR(p.nx, 0.0, 1e-2);
    EXPECT_LT(p.ny * p.y, 0.0F) << "normals look at the laser";
  }
  EXPECT_GT(far, 10);
}

TEST(Cloud, HitsFarApartThatLieOnNoLineHaveNoNormal) {
  ScanPoints scan;  // a hedge along the way: every second hit 0.1 m deeper, farther apart than the usual reach
  scan.beam_width = deg_to_rad(1.0);
  for (int beam = 0; beam < 10; ++beam) {
    const double bearing = deg_to_rad(20.0 - beam);
    const TPoint2D end(1.0 / std::tan(bearing), 1.0 + 0.1 * (beam % 2));
    scan.hits.push_back(end);
    scan.rays.push_back({end, true, true, beam});
  }
  const Cloud cloud = cloud_of(scan, {});
  ASSERT_EQ(cloud.points.size(), 10u);
  for (const OrientedPoint& p : cloud.points) EXPECT_FALSE(p.has_normal()) << p.x << " " << p.y;
}

TEST(Cloud, FilledPointsLieOnTheSurfaceToo) {
  RobotModel model;
  model.laser.beams = 121;  // two degrees apart: gaps of 0.15 m and more
  model.laser.angle_step = deg_to_rad(2.0);
  model.laser.angle_min = deg_to_rad(-120.0);
  model.laser.range_max = 12.0;
  const slam_test::World wall{{{8.0, -6.0}, {8.0, 6.0}}};
  const Cloud cloud = slam_test::cloud_at(wall, {}, model);
  ASSERT_GT(cloud.filled.size(), 20u);
  for (const OrientedPoint& p : cloud.filled) EXPECT_LT(distance_to_walls(wall, point(p)), 1e-3);
}

TEST(Cloud, SinglePixelsBetweenTwoDepthsAreNoSurface) {
  ScanPoints scan;
  scan.beam_width = deg_to_rad(0.5);
  for (int beam = 0; beam < 60; ++beam) {
    const double bearing = deg_to_rad(0.5 * beam);
    const double range = beam < 30 ? 1.0 : beam == 30 ? 2.0 : 3.0;
    const TPoint2D end(range * std::cos(bearing), range * std::sin(bearing));
    scan.hits.push_back(end);
    scan.rays.push_back({end, true, true, beam});
  }
  for (const OrientedPoint& p : cloud_of(scan, {}).points) EXPECT_GT(std::abs(length(point(p)) - 2.0), 0.5);
}

TEST(Cloud, AWallThatStandsFreeTellsItsEnds) {
  const slam_test::World before_a_wall{{{1.5, -0.6}, {1.5, 0.5}}, {{3.0, -4.0}, {3.0, 4.0}}};
  const slam_test::World in_the_open{{{1.5, -0.6}, {1.5, 0.5}}, {{-1.0, 3.3}, {1.0, 3.3}}, {{-1.0, -3.4}, {1.0, -3.4}}};
  for (const slam_test::World& world : {before_a_wall, in_the_open}) {
    const Cloud cloud = slam_test::cloud_at(world, {}, RobotModel());
    int left = 0;
    int right = 0;
    for (const OrientedPoint& end : cloud.ends) {
      EXPECT_NEAR(end.x, 1.5, 0.01) << "what is hidden or as far as the scanner sees has no end";
      EXPECT_NEAR(end.nx, 0.0, 0.02);
      EXPECT_NEAR(end.y, end.ny > 0.0F ? 0.5 : -0.6, 0.012);
      EXPECT_NEAR(std::abs(end.ny), 1.0, 0.01);
      ++(end.ny > 0.0F ? left : right);
    }
    EXPECT_GE(left, 1);
    EXPECT_GE(right, 1);
  }
}

TEST(Cloud, CornersAndWallsOutOfSightHaveNoEnds) {
  const slam_test::World room{{{-2.0, -2.0}, {2.0, -2.0}}, {{2.0, -2.0}, {2.0, 2.0}}, {{2.0, 2.0}, {-2.0, 2.0}}};
  EXPECT_TRUE(slam_test::cloud_at(room, {}, RobotModel()).ends.empty());
  const slam_test::World corridor{{{-20.0, 0.7}, {20.0, 0.7}}, {{-20.0, -0.7}, {20.0, -0.7}}};
  EXPECT_TRUE(slam_test::cloud_at(corridor, {}, RobotModel()).ends.empty());
}

/// Where a tilted scan plane dips into the floor nothing is left of the beams; the wall goes on behind.
TEST(Cloud, AWallDoesNotEndWhereTheFloorBegins) {
  const auto wall = [](const std::vector<int>& floor_beams, bool clockwise) {
    ScanPoints scan;
    scan.beam_width = deg_to_rad(0.5);
    for (int beam = 0; beam < 120; ++beam) {
      const double bearing = deg_to_rad(0.5 * beam - 30.0);
      const TPoint2D across(1.0, std::tan(bearing));
      const TPoint2D far(3.5 * std::cos(bearing), 3.5 * std::sin(bearing));
      if (beam >= 60 && beam < 110) continue;  // nothing beside the wall, and far off something again
      scan.rays.push_back({beam < 60 ? across : far, true, true, beam});
    }
    for (const ScanRay& ray : scan.rays) scan.hits.push_back(ray.end);
    if (clockwise) std::reverse(scan.rays.begin(), scan.rays.end());
    scan.floor_beams = floor_beams;
    return cloud_of(scan, {});
  };
  for (const bool clockwise : {false, true}) {
    const Cloud silence = wall({}, clockwise);
    ASSERT_FALSE(silence.ends.empty()) << "nothing was at stake";
    EXPECT_NEAR(silence.ends.front().y, 0.0, 0.02);
    EXPECT_TRUE(wall({60}, clockwise).ends.empty());
    EXPECT_TRUE(wall({75, 109}, clockwise).ends.empty());
    EXPECT_FALSE(wall({20, 112}, clockwise).ends.empty()) << "floor elsewhere hides no end";
  }
}

/// The robot may push it along; what is larger, farther off or part of a wall stays where it is.
TEST(Cloud, SmallFreeThingsNearTheRobotAreLeftOut) {
  const RobotModel model;
  const auto points_at = [&](double x, double half, bool walled) {
    slam_test::World world{{{3.0, -3.0}, {3.0, 3.0}}, {{x, -half}, {x, half}}};
    if (walled) world.push_back({{x, half}, {x, 3.0}});
    const Cloud cloud = slam_test::cloud_at(world, {}, model);
    return std::count_if(cloud.points.begin(), cloud.points.end(), [&](const OrientedPoint& p) {
      return std::abs(point(p).x - x) < 0.01 && std::abs(point(p).y) <= half;
    });
  };
  EXPECT_EQ(points_at(0.6, 0.1, false), 0);
  EXPECT_EQ(points_at(1.1, 0.15, false), 0);
  EXPECT_GE(points_at(1.4, 0.1, false), 2);
  EXPECT_EQ(points_at(0.6, 0.21, false), 0) << "a large ball right before the robot";
  EXPECT_GE(points_at(0.9, 0.21, false), 4);
  EXPECT_GE(points_at(0.6, 0.25, false), 4);
  const slam_test::World beside{{{3.0, -3.0}, {3.0, 3.0}}, {{-3.0, 3.0}, {3.0, 3.0}}, {{-0.2, 0.6}, {0.2, 0.6}}};
  const Cloud cloud = slam_test::cloud_at(beside, {}, model);
  EXPECT_GE(std::count_if(cloud.points.begin(), cloud.points.end(),
                          [](const OrientedPoint& p) { return std::abs(point(p).y - 0.6) < 0.01; }),
            3)
      << "what is as large beside the robot it does not push";
  EXPECT_GE(points_at(0.6, 0.1, true), 2);
}

TEST(Cloud, AnEmptyScanGivesAnEmptyCloud) {
  const Cloud cloud = cloud_of({}, {});
  EXPECT_TRUE(cloud.points.empty());
  EXPECT_TRUE(cloud.ends.empty());
  EXPECT_TRUE(cloud.filled.empty());
  EXPECT_EQ(cloud.sight.judge(at(0.3, 1.0)), SightFan::Verdict::Nothing);
  EXPECT_EQ(sight_of({}).judge(at(0.3, 1.0)), SightFan::Verdict::Nothing);
}

TEST(SightFan, TellsInFrontFromBehind) {
  SightFan fan;
  for (int deg = -10; deg <= 10; ++deg) fan.add(deg_to_rad(deg + 0.5), 3.0);
  EXPECT_EQ(fan.judge(at(0.0, 2.0)), SightFan::Verdict::InFront);
  EXPECT_EQ(fan.judge(at(0.0, 3.0)), SightFan::Verdict::Agrees);
  EXPECT_EQ(fan.judge(at(0.0, 3.1)), SightFan::Verdict::Agrees);
  EXPECT_EQ(fan.judge(at(0.0, 5.0)), SightFan::Verdict::Behind);
  EXPECT_EQ(fan.judge(at(deg_to_rad(40.0), 2.0)), SightFan::Verdict::Nothing);
  EXPECT_EQ(fan.judge(at(deg_to_rad(10.9), 2.0)), SightFan::Verdict::Nothing) << "a neighbour saw nothing";
}

/// Of a wall seen along it, its other face lies far in front, along the beam; but at right angles it is at hand, and
/// what stands across the beam is in front both ways.
TEST(SightFan, TheOtherFaceOfAWallIsInFrontAlongTheBeamOnly) {
  SightFan fan;
  for (int deg = 5; deg <= 60; ++deg) fan.add(deg_to_rad(deg + 0.5), 0.60 / std::sin(deg_to_rad(deg + 0.5)));
  const PlanarTransform T(TPose2D(0.4, -0.3, 2.0));  // of the points, as seen from the base
  const TPoint2D laser(0.1, 0.05);
  const auto seen_from_there = [&](const TPoint2D& from_laser, const TPoint2D& normal) {
    const TPoint2D p = T.inverse(from_laser + laser);
    const TPoint2D n = T.turned_back(normal.x, normal.y);
    return OrientedPoint{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(n.x),
                         static_cast<float>(n.y)};
  };
  std::vector<OrientedPoint> other_face, across, no_normals;
  for (double x = 1.5; x < 3.5; x += 0.1) {
    other_face.push_back(seen_from_there({x, 0.49}, {0.0, 1.0}));
    across.push_back(seen_from_there({x, 0.40}, {-1.0, 0.0}));
    no_normals.push_back(seen_from_there({x, 0.40}, {0.0, 0.0}));
  }
  const auto in_front = [&](const std::vector<OrientedPoint>& points, SightFan::Slack slack) {
    return fan.judge(points, T, laser, slack).in_front;
  };
  EXPECT_GT(in_front(other_face, SightFan::Slack::AlongBeam), 12);
  EXPECT_EQ(in_front(other_face, SightFan::Slack::AcrossSurface), 0);
  EXPECT_EQ(in_front(across, SightFan::Slack::AcrossSurface), in_front(across, SightFan::Slack::AlongBeam));
  EXPECT_GT(in_front(across, SightFan::Slack::AcrossSurface), 15);
  EXPECT_EQ(in_front(no_normals, SightFan::Slack::AcrossSurface), in_front(no_normals, SightFan::Slack::AlongBeam));
}

/// The same by the arc tangent and the bins alone.
SightFan::Verdict verdict_by_bins(const SightFan::Bins& bins, const TPoint2D& p) {
  const int middle = static_cast<int>(std::floor(rad_to_deg(std::atan2(p.y, p.x)))) + SightFan::kBins;
  double nearest = 1e9, farthest = 0.0;
  for (int side = -1; side <= 1; ++side) {
    const auto& [near, far] = bins[static_cast<std::size_t>((middle + side) % SightFan::kBins)];
    if (far == 0) return SightFan::Verdict::Nothing;
    nearest = std::min(nearest, 0.01 * near);
    farthest = std::max(farthest, 0.01 * far);
  }
  if (length(p) < nearest - 1.0) return SightFan::Verdict::InFront;
  return length(p) > farthest + 1.0 ? SightFan::Verdict::Behind : SightFan::Verdict::Agrees;
}

TEST(SightFan, JudgesByTheBinThatTheArcTangentTells) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Rng rng(kSeed, "bearings");
  SightFan fan;
  for (int bin = 0; bin < SightFan::kBins; ++bin)
    if (rng.uniform() < 0.8) fan.add(deg_to_rad(bin + 0.5), rng.uniform() < 0.5 ? 10.0 : 30.0);
  const SightFan::Bins bins = fan.bins();
  const auto expect_same = [&](const TPoint2D& p) {
    EXPECT_EQ(fan.judge(p), verdict_by_bins(bins, p)) << p.x << " " << p.y;
  };
  for (int k = 0; k < 200'000; ++k) expect_same(at(rng.uniform(-kPi, kPi), 20.0));
  for (int bin = -180; bin <= 180; ++bin)  // where bins meet
    for (const double off : {-1e-3, -1e-5, -1e-9, 0.0, 1e-9, 1e-5, 1e-3}) expect_same(at(deg_to_rad(bin + off), 20.0));
  for (const TPoint2D& p : {TPoint2D{20.0, 0.0}, {0.0, 20.0}, {-20.0, 0.0}, {0.0, -20.0}, {-20.0, -0.0}, {0.0, 0.0}})
    expect_same(p);
}

TEST(SightFan, JudgesManyAsOneByOne) {
  Rng rng(8, "points");
  SightFan fan;
  for (int bin = 0; bin < SightFan::kBins; ++bin)
    if (rng.uniform() < 0.9) fan.add(deg_to_rad(bin + 0.5), rng.uniform(1.0, 6.0));
  const TPoint2D laser(0.3, -0.1);
  for (const std::size_t count : {0U, 1U, 63U, 64U, 65U, 500U}) {
    const PlanarTransform T(TPose2D(rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-kPi, kPi)));
    std::vector<OrientedPoint> points(count);
    for (OrientedPoint& p : points) {
      p.x = static_cast<float>(rng.uniform(-6.0, 6.0));
      p.y = static_cast<float>(rng.uniform(-6.0, 6.0));
    }
    int in_front = 0, agrees = 0;
    for (const OrientedPoint& p : points) {
      const SightFan::Verdict one = fan.judge(T({static_cast<double>(p.x), static_cast<double>(p.y)}) - laser);
      in_front += one == SightFan::Verdict::InFront ? 1 : 0;
      agrees += one == SightFan::Verdict::Agrees ? 1 : 0;
    }
    const SightFan::Judged all = fan.judge(points, T, laser);
    EXPECT_EQ(all.in_front, in_front) << count;
    EXPECT_EQ(all.agrees, agrees) << count;
  }
}

}  // namespace
}  // namespace rubble::slam
