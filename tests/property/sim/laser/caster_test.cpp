#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "sim/body/servos.h"
#include "sim/laser/plane_cast.h"
#include "sim/laser/ray_walk.h"
#include "sim/laser/rays.h"
#include "sim/laser/sweep_cast.h"
#include "tests/support/sim_arena.h"
#include "tests/support/sim_random_scene.h"

namespace rubble::sim::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Plain geometry as a second oracle: every face, no index. The crossing number in the face's plane decides.
double brute_force(const std::vector<arenas::Face>& faces, const Ray& ray, double max_range) {
  double best = kInf;
  for (const arenas::Face& face : faces) {
    std::vector<Eigen::Vector3d> v;
    for (const auto& p : face.vertices) v.emplace_back(p.x, p.y, p.z);
    for (std::size_t i = 1; i + 1 < v.size(); ++i) {  // Moeller and Trumbore 1997, a fan of triangles
      const Eigen::Vector3d e1 = v[i] - v[0];
      const Eigen::Vector3d e2 = v[i + 1] - v[0];
      const Eigen::Vector3d h = ray.direction.cross(e2);
      const double a = e1.dot(h);
      if (std::abs(a) < 1e-14) continue;
      const Eigen::Vector3d s = ray.origin - v[0];
      const double u = s.dot(h) / a;
      const Eigen::Vector3d q = s.cross(e1);
      const double w = ray.direction.dot(q) / a;
      const double t = e2.dot(q) / a;
      if (u >= -1e-9 && w >= -1e-9 && u + w <= 1.0 + 1e-9 && t > 0.0 && t <= max_range) best = std::min(best, t);
    }
  }
  return best;
}

/// True when `range` is what the oracle sees along the ray or along one a hair beside it: a beam that passes an edge by
/// 30 um may go either way.
template <class Oracle>
bool agrees(double range, const Ray& ray, const Oracle& oracle) {
  double low = kInf;
  double high = 0.0;
  const Eigen::Vector3d side = ray.direction.unitOrthogonal();
  const Eigen::Vector3d other = ray.direction.cross(side);
  for (int i = 0; i <= 8; ++i) {
    Ray beside = ray;
    if (i > 0) {
      const double a = kPi / 4.0 * i;
      beside.origin += 3e-5 * (std::cos(a) * side + std::sin(a) * other);
    }
    const double seen = oracle(beside);
    if (std::abs(seen - range) <= 1e-3 || seen == range) return true;
    low = std::min(low, seen);
    high = std::max(high, seen);
  }
  return high - low > 1e-3 && range >= low - 1e-3 && range <= high + 1e-3;
}

/// `most_tilting`, `most_aiming`: the fastest that the robot pitches and the servos turn [rad/s].
std::vector<WorldState> random_motion(const WorldState& start, Rng& rng, double most_tilting = 1.0,
                                      double most_aiming = 2.0) {
  const double v = rng.uniform(-0.7, 0.7);
  const double w = rng.uniform(-1.7, 1.7);
  const double tilting = rng.uniform(-most_tilting, most_tilting);
  const double aiming = rng.uniform(-most_aiming, most_aiming);
  std::vector<WorldState> states(9, start);
  for (std::size_t i = 1; i < states.size(); ++i) {
    WorldState& s = states[i];
    s = states[i - 1];
    s.stamp = s.stamp + 0.01;
    s.pose.x += 0.01 * v * std::cos(s.pose.phi);
    s.pose.y += 0.01 * v * std::sin(s.pose.phi);
    s.pose.phi += 0.01 * w;
    s.stance.pitch += 0.01 * tilting;
    s.aim.roll += 0.01 * aiming;
  }
  return states;
}

TEST(Casters, TheRayWalkSeesWhatPlainGeometrySees) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    const std::vector<arenas::Face> faces = arenas::faces(arena);
    const RayWalk walk(faces);
    Rng rng(seed, "rays");
    for (int i = 0; i < 5000; ++i) {
      const WorldState state = random_state(arena, rng);
      const double bearing = rng.uniform(-kPi, kPi);
      const Placement laser = laser_placement(state, robot::RobotModel{});
      const Ray ray{laser.p, laser.R * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0)};
      const double range = walk.cast(ray, 4.0);
      ASSERT_TRUE(agrees(range, ray, [&](const Ray& r) { return brute_force(faces, r, 4.0); }))
          << "bearing " << bearing << " range " << range << " truth " << brute_force(faces, ray, 4.0);
    }
  }
}

/// Beams of a fast caster against the ray walk: how many, how far off, and how many passed an edge.
struct Comparison {
  long beams = 0;
  int beside = 0;
  double worst = 0.0;  ///< of those that met the same surface [m]

  testing::AssertionResult add(double range, const Ray& ray, const RayWalk& walk, const std::vector<Sphere>& balls,
                               double reach = 4.0) {
    const double truth = walk.cast(ray, reach, balls);
    ++beams;
    if (range == truth) return testing::AssertionSuccess();
    if (std::abs(range - truth) <= 1e-3) {
      worst = std::max(worst, std::abs(range - truth));
      return testing::AssertionSuccess();
    }
    ++beside;
    if (agrees(range, ray, [&](const Ray& r) { return walk.cast(r, reach + 1e-4, balls); })) {
      return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << range << " m, walked " << truth << " m";
  }
  /// Prints, and sees to it that edges are no excuse for more than a beam in ten thousand.
  void print() const {
    EXPECT_LE(beside, 1 + static_cast<int>(1e-4 * static_cast<double>(beams)));
    std::cout << beams << " beams: within " << worst * 1e3 << " mm; " << beside << " passed an edge by a hair\n";
  }
};

Ray level_ray(const Placement& laser, const BeamTable& table, std::size_t beam) {
  const double bearing = table.angle_min + static_cast<double>(beam) * table.angle_step;
  return {laser.p, laser.R * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0)};
}

TEST(Casters, TheSweepAgreesWithTheRayWalkToOneMillimetre) {
  const robot::RobotModel model;
  const BeamTable table(model.laser);
  Comparison comparison;
  for (std::uint64_t seed = 1; comparison.beams < 1000000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    const std::vector<arenas::Face> all = arenas::faces(arena);
    const RayWalk walk(all);
    const ScanFaces faces(all);
    SweepCast sweep(faces);
    Rng rng(seed, "sweeps");
    for (int k = 0; k < 60; ++k) {
      const WorldState state = random_state(arena, rng);
      const std::vector<Sphere> balls = random_balls(arena, state, 5, rng);
      Beams beams;
      swept_beams(random_motion(state, rng), model, table, Stamp::from_seconds(0.0043), model.laser.beam_period, beams);
      std::vector<float> ranges;
      sweep.cast(beams, table, 4.0, balls, ranges);
      for (std::size_t i = 0; i < beams.count; ++i) {
        ASSERT_TRUE(comparison.add(ranges[i], beams.ray(i), walk, balls)) << "scan " << k << " beam " << i;
      }
    }
  }
  comparison.print();
}

/// The laser's axis pierces a floor of one piece, whose sides are far away though the floor is near, while the servos
/// turn as fast as they can.
TEST(Casters, ASweepSeesAllOfAWideFloorWhileThePlatformTurnsAtItsLimit) {
  const robot::RobotModel model;
  const BeamTable table(model.laser);
  const ServoParameters servos;
  arenas::Arena arena = room(-12, -12, 12, 12);
  add_wall(arena, 6.5, -1, 6.52, 3);
  const std::vector<arenas::Face> all = arenas::faces(arena);
  const RayWalk walk(all);
  const ScanFaces faces(all);
  SweepCast sweep(faces);
  Rng rng(1, "wide floor");
  Comparison comparison;
  long floor_hits = 0;
  for (int k = 0; k < 300; ++k) {
    WorldState state;
    state.pose = {rng.uniform(-6, 6), rng.uniform(-6, 6), rng.uniform(-kPi, kPi)};
    state.stance.pitch = rng.uniform(-0.2, 0.2);
    state.aim.roll = rng.uniform(-0.4, 0.4);
    Beams beams;
    swept_beams(random_motion(state, rng, servos.max_rate, servos.max_rate), model, table, Stamp::from_seconds(0.0043),
                model.laser.beam_period, beams);
    std::vector<float> ranges;
    sweep.cast(beams, table, 4.0, {}, ranges);
    for (std::size_t i = 0; i < beams.count; ++i) {
      ASSERT_TRUE(comparison.add(ranges[i], beams.ray(i), walk, {})) << "scan " << k << " beam " << i;
      floor_hits += ranges[i] < 4.0f;
    }
  }
  comparison.print();
  EXPECT_GT(floor_hits, 20000);
}

/// Both casters, their oracle, and faces that they get beside their own.
struct CastersAndOracle {
  PlaneCast& plane;
  SweepCast& sweep;
  const RayWalk& walk;
  const ScanFaces* moving;
};

/// Scans from anywhere in the arena, swept and from a pose at rest, beam by beam against the ray walk.
void compare_both(const arenas::Arena& arena, const robot::RobotModel& model, const CastersAndOracle& casters,
                  int scans, Rng& rng, Comparison& swept, Comparison& still) {
  const BeamTable table(model.laser);
  const double reach = model.laser.range_max;
  for (int k = 0; k < scans; ++k) {
    const WorldState state = random_state(arena, rng);
    Beams beams;
    swept_beams(random_motion(state, rng), model, table, Stamp::from_seconds(0.0043), model.laser.beam_period, beams);
    const Placement laser = laser_placement(state, model);
    std::vector<float> ranges, flat;
    casters.sweep.cast(beams, table, reach, {}, ranges, casters.moving);
    casters.plane.cast(laser, table, reach, {}, flat, casters.moving);
    for (std::size_t i = 0; i < table.count; ++i) {
      ASSERT_TRUE(swept.add(ranges[i], beams.ray(i), casters.walk, {}, reach)) << "swept scan " << k << " beam " << i;
      ASSERT_TRUE(still.add(flat[i], level_ray(laser, table, i), casters.walk, {}, reach))
          << "scan " << k << " beam " << i;
    }
  }
}

TEST(Casters, BothAgreeWithTheRayWalkAtLongRange) {
  robot::RobotModel model;
  model.laser = robot::laser_model("UTM-30LX");
  Comparison swept, still;
  for (std::uint64_t seed = 300; seed < 305; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    const std::vector<arenas::Face> all = arenas::faces(arena);
    const RayWalk walk(all);
    const ScanFaces faces(all);
    PlaneCast plane(faces);
    SweepCast sweep(faces);
    Rng rng(seed, "long range");
    compare_both(arena, model, {plane, sweep, walk, nullptr}, 15, rng, swept, still);
  }
  swept.print();
  still.print();
}

TEST(Casters, ThePlaneCastAgreesWithTheRayWalkToOneMillimetre) {
  const robot::RobotModel model;
  const BeamTable table(model.laser);
  Comparison comparison;
  for (std::uint64_t seed = 100; comparison.beams < 1000000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    const std::vector<arenas::Face> all = arenas::faces(arena);
    const RayWalk walk(all);
    const ScanFaces faces(all);
    PlaneCast plane(faces);
    Rng rng(seed, "planes");
    for (int k = 0; k < 100; ++k) {
      const WorldState state = random_state(arena, rng);
      const std::vector<Sphere> balls = random_balls(arena, state, 5, rng);
      const Placement laser = laser_placement(state, model);
      std::vector<float> ranges;
      plane.cast(laser, table, 4.0, balls, ranges);
      for (std::size_t i = 0; i < table.count; ++i) {
        ASSERT_TRUE(comparison.add(ranges[i], level_ray(laser, table, i), walk, balls))
            << "scan " << k << " beam " << i;
      }
    }
  }
  comparison.print();
}

/// Other robots and loose objects come as faces of their own: with every third face handed over that way both casters
/// see what the ray walk sees in all of them together.
TEST(Casters, FacesThatMoveAreSeenBesideThoseThatStand) {
  const robot::RobotModel model;
  Comparison swept, still_laser;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const arenas::Arena arena = random_maze(seed);
    const std::vector<arenas::Face> all = arenas::faces(arena);
    std::vector<arenas::Face> still, moving;
    for (std::size_t i = 0; i < all.size(); ++i) (i % 3 == 0 ? moving : still).push_back(all[i]);
    const RayWalk walk(all);
    const ScanFaces still_faces(still), moving_faces(moving);
    PlaneCast plane(still_faces);
    SweepCast sweep(still_faces);
    Rng rng(seed, "moving");
    compare_both(arena, model, {plane, sweep, walk, &moving_faces}, 20, rng, swept, still_laser);
  }
}

}  // namespace
}  // namespace rubble::sim::test
