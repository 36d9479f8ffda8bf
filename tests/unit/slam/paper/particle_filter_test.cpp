#include "slam/paper/particle_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/scan/level_scan.h"
#include "tests/support/slam_world.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

struct Spread {
  double mean;
  double sigma;
};

template <class Value>
Spread spread(const Particles& particles, Value value) {
  double sum = 0.0, squares = 0.0;
  for (const Particle& p : particles) sum += value(p.T_map_base);
  const double n = static_cast<double>(particles.size());
  for (const Particle& p : particles) squares += std::pow(value(p.T_map_base) - sum / n, 2);
  return {sum / n, std::sqrt(squares / n)};
}

TEST(Resample, KeepsTheNumberForAnyWeights) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "weights");
    Particles particles = particles_at(TPose2D(), 300);
    for (Particle& p : particles) {
      const double exponent = rng.uniform(0.0, 8.0);
      p.weight = std::pow(rng.uniform(), exponent);
    }
    const Particles children = resample(normalise(particles));
    EXPECT_EQ(children.size(), 300u);
    for (const Particle& child : children) EXPECT_DOUBLE_EQ(child.weight, 1.0 / 300.0);
  }
}

TEST(Resample, GivesHeavyParticlesTheirShareAndDropsTheLightest) {
  Particles particles = particles_at(TPose2D(), 10);
  for (int i = 0; i < 10; ++i) {
    particles[static_cast<std::size_t>(i)].T_map_base.x = i;
    particles[static_cast<std::size_t>(i)].weight = i == 3 ? 0.55 : 0.05;
  }
  const Particles children = resample(particles);
  std::vector<int> counts(10, 0);
  for (const Particle& child : children) ++counts[static_cast<std::size_t>(child.T_map_base.x)];
  EXPECT_EQ(counts[3], 6);  // round(10 * 0.55 + 0.5)
  EXPECT_EQ(counts[0], 1);  // round(10 * 0.05 + 0.5); then the list is full
  EXPECT_EQ(counts[9], 0);
}

TEST(Resample, FlatWeightsDoNotLetTheCloudDiverge) {
  // Nearly flat weights as in a maze: with round(N w) alone all particles would survive for ever.
  Rng rng(5, "drift");
  Particles particles = particles_at(TPose2D(), 300);
  for (int step = 0; step < 30; ++step) {
    particles = drift(resample(particles), {0.04, 0.0, 0.0}, {}, rng);
    for (Particle& p : particles) p.weight = 1.0 - std::abs(p.T_map_base.y);
    particles = normalise(particles);
  }
  Rng same(5, "drift");
  Particles loose = particles_at(TPose2D(), 300);
  for (int step = 0; step < 30; ++step) loose = drift(loose, {0.04, 0.0, 0.0}, {}, same);
  const auto y = [](const TPose2D& T) { return T.y; };
  EXPECT_LT(spread(particles, y).sigma, 0.3 * spread(loose, y).sigma);
}

TEST(Drift, NoMotionLeavesParticlesAlone) {
  Rng rng(1, "drift");
  const Particles particles = drift(particles_at({1.0, 2.0, 3.0}, 300), TPose2D(), {}, rng);
  for (const Particle& p : particles) EXPECT_EQ(p.T_map_base, TPose2D(1.0, 2.0, 3.0));
}

TEST(Drift, WithoutErrorsItIsTheOdometry) {
  Rng rng(1, "drift");
  const TPose2D start{1.0, 2.0, 3.0};
  const TPose2D motion{0.4, -0.1, 0.7};
  const TPose2D expected = start + motion;
  for (const Particle& p : drift(particles_at(start, 10), motion, {0.0, 0.0, 0.0}, rng)) {
    EXPECT_NEAR(p.T_map_base.x, expected.x, 1e-12);
    EXPECT_NEAR(p.T_map_base.y, expected.y, 1e-12);
    EXPECT_NEAR(wrap_angle(p.T_map_base.phi - expected.phi), 0.0, 1e-12);
  }
}

TEST(Drift, DistanceErrorIsFifteenPerCent) {
  Rng rng(11, "drift");
  MotionError error;
  error.heading_per_m = 0.0;
  const Particles particles = drift(particles_at(TPose2D(), 20000), {2.0, 0.0, 0.0}, error, rng);
  const Spread x = spread(particles, [](const TPose2D& T) { return T.x; });
  EXPECT_NEAR(x.mean, 2.0, 0.01);
  EXPECT_NEAR(x.sigma, 0.3, 0.005);
}

TEST(Drift, HeadingErrorIsFiveDegreesPerMetre) {
  Rng rng(12, "drift");
  const Particles particles = drift(particles_at(TPose2D(), 20000), {2.0, 0.0, 0.0}, {}, rng);
  const Spread phi = spread(particles, [](const TPose2D& T) { return T.phi; });
  EXPECT_NEAR(rad_to_deg(phi.mean), 0.0, 0.3);
  EXPECT_NEAR(rad_to_deg(phi.sigma), 10.0, 0.2);
}

TEST(Drift, InitialRotationErrorIsFivePerCentOfTheTurn) {
  Rng rng(13, "drift");
  const Particles particles = drift(particles_at(TPose2D(), 20000), {0.0, 0.0, deg_to_rad(60.0)}, {}, rng);
  const Spread phi = spread(particles, [](const TPose2D& T) { return T.phi; });
  EXPECT_NEAR(rad_to_deg(phi.mean), 60.0, 0.1);
  EXPECT_NEAR(rad_to_deg(phi.sigma), 3.0, 0.06);
}

/// 0.1 m/rad on 60 deg: 0.105 m each way, whatever the heading; with 0 nothing moves on the spot, as printed.
TEST(Drift, ATurnOnTheSpotSpreadsTheParticlesByItsDistanceError) {
  for (const double turn : {60.0, -60.0}) {
    Rng rng(15, "drift");
    MotionError error;
    error.distance_per_rad = 0.1;
    const TPose2D motion{0.0, 0.0, deg_to_rad(turn)};
    const Particles particles = drift(particles_at({1.0, 2.0, 0.7}, 20000), motion, error, rng);
    const Spread x = spread(particles, [](const TPose2D& T) { return T.x; });
    const Spread y = spread(particles, [](const TPose2D& T) { return T.y; });
    EXPECT_NEAR(x.mean, 1.0, 0.003);
    EXPECT_NEAR(y.mean, 2.0, 0.003);
    EXPECT_NEAR(x.sigma, 0.1047, 0.002);
    EXPECT_NEAR(y.sigma, 0.1047, 0.002);
    Rng other(15, "drift");
    for (const Particle& p : drift(particles_at({1.0, 2.0, 0.7}, 300), motion, {}, other)) {
      EXPECT_EQ(p.T_map_base.x, 1.0);
      EXPECT_EQ(p.T_map_base.y, 2.0);
    }
  }
}

/// Nothing is drawn for an error of 0 or without a turn: what comes after has the same bits.
TEST(Drift, AnErrorOfTurnsThatIsNoneLeavesTheOtherDraws) {
  const TPose2D straight{0.4, -0.1, 0.0};
  Rng printed(16, "drift");
  Rng ours(16, "drift");
  MotionError error;
  error.distance_per_rad = 0.2;
  const Particles a = drift(particles_at({1.0, 2.0, 3.0}, 300), straight, {}, printed);
  const Particles b = drift(particles_at({1.0, 2.0, 3.0}, 300), straight, error, ours);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].T_map_base, b[i].T_map_base);
  // Three draws a particle, as printed: rotation, distance, end of the turn.
  const TPose2D bent{0.4, -0.1, 0.7};
  error.distance_per_rad = 0.0;
  drift(particles_at({1.0, 2.0, 3.0}, 300), bent, error, printed);
  Rng counted(16, "drift");
  for (int i = 0; i < 2 * 3 * 300; ++i) counted.gaussian();
  EXPECT_EQ(printed.next_u32(), counted.next_u32());
}

TEST(Drift, EachParticleMovesAlongItsOwnHeading) {
  Rng rng(14, "drift");
  Particles particles = particles_at(TPose2D(), 2);
  particles[1].T_map_base.phi = kPi / 2.0;
  const Particles moved = drift(particles, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, rng);
  EXPECT_NEAR(moved[0].T_map_base.x, 1.0, 1e-12);
  EXPECT_NEAR(moved[1].T_map_base.y, 1.0, 1e-12);
}

CountMap room_map(std::vector<TPoint2D>& hits) {
  const robot::RobotModel model;
  Rng noise(3, "scan");
  LevelScan level_scan(model.T_base_laser, {});
  const ScanPoints points =
      level_scan.points(slam_test::scan_at(slam_test::furnished_room(), {}, model, Stamp{0}, 0.01, noise));
  hits = points.hits;
  CountMap map(300, 300, 0.05);
  for (int k = 0; k < 5; ++k) map.stamp(TPose2D(0.01 * k, 0.0, 0.0), points);
  return map;
}

TEST(Measure, EqualsTheNaiveSum) {
  std::vector<TPoint2D> hits;
  const CountMap map = room_map(hits);
  Rng rng(4, "poses");
  Particles particles = particles_at(TPose2D(), 500);
  for (Particle& p : particles) {  // near and far from the map's edge, some outside
    const double x = rng.gaussian(3.0);
    const double y = rng.gaussian(3.0);
    p.T_map_base = {x, y, rng.uniform(-kPi, kPi)};
  }
  const Particles measured = measure(particles, hits, map);
  for (const Particle& p : measured) {
    double low = 0.0, high = 0.0;  // single precision may put an end that lies on a cell border into either cell
    for (const TPoint2D& hit : hits) {
      const TPoint2D end = p.T_map_base.composePoint(hit);
      double least = 1.0, most = 0.0;
      for (const double dx : {-1e-5, 1e-5}) {
        for (const double dy : {-1e-5, 1e-5}) {
          const double p_occ = map.p_occ(map.frame().cell({end.x + dx, end.y + dy}));  // eq. (2)
          least = std::min(least, p_occ);
          most = std::max(most, p_occ);
        }
      }
      low += least;
      high += most;
    }
    const double rounding = 0.5 / 255.0 * static_cast<double>(hits.size());
    EXPECT_GE(p.weight / 255.0, low - rounding);
    EXPECT_LE(p.weight / 255.0, high + rounding);
  }
}

TEST(Measure, ThePoseThatMadeTheMapWeighsMost) {
  std::vector<TPoint2D> hits;
  const CountMap map = room_map(hits);
  Particles particles = particles_at(TPose2D(), 1);
  for (const double off : {0.15, -0.15, 0.3}) {
    particles.push_back({{off, 0.0, 0.0}, 0.0});
    particles.push_back({{0.0, off, 0.0}, 0.0});
    particles.push_back({{0.0, 0.0, off}, 0.0});
  }
  particles = measure(particles, hits, map);
  for (std::size_t i = 1; i < particles.size(); ++i) EXPECT_GT(particles[0].weight, 1.2 * particles[i].weight);
}

TEST(Normalise, WeightsSumToOne) {
  Particles particles = particles_at(TPose2D(), 4);
  for (std::size_t i = 0; i < 4; ++i) particles[i].weight = static_cast<double>(i);
  particles = normalise(particles);
  EXPECT_DOUBLE_EQ(particles[3].weight, 0.5);
  EXPECT_DOUBLE_EQ(particles[0].weight + particles[1].weight + particles[2].weight + particles[3].weight, 1.0);
}

TEST(Normalise, AllZeroBecomesUniform) {
  Particles particles = particles_at(TPose2D(), 4);
  for (Particle& p : particles) p.weight = 0.0;
  for (const Particle& p : normalise(particles)) EXPECT_DOUBLE_EQ(p.weight, 0.25);
}

TEST(MeanOfBest, TakesTheHeaviestShareOnly) {
  Particles particles = particles_at(TPose2D(), 100);
  for (std::size_t i = 0; i < 100; ++i) {
    particles[i].T_map_base.x = static_cast<double>(i);
    particles[i].weight = static_cast<double>(i);
  }
  EXPECT_DOUBLE_EQ(mean_of_best(particles, 0.05).x, 97.0);  // of 95 .. 99
  EXPECT_DOUBLE_EQ(mean_of_best(particles, 0.0).x, 99.0);
}

TEST(MeanOfBest, AnglesAreAveragedAcrossPi) {
  Particles particles = particles_at(TPose2D(), 2);
  particles[0].T_map_base.phi = kPi - 0.1;
  particles[1].T_map_base.phi = -kPi + 0.3;
  EXPECT_NEAR(mean_of_best(particles, 1.0).phi, -kPi + 0.1, 1e-9);
}

}  // namespace
}  // namespace rubble::slam
