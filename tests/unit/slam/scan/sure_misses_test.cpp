#include "slam/scan/sure_misses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"

namespace rubble::slam {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Beams of 0.36 deg over 240 deg, reach 4 m, that all missed.
robot::LaserScan nothing_around() {
  robot::LaserScan scan;
  scan.angle_min = deg_to_rad(-120.0);
  scan.angle_step = deg_to_rad(0.36);
  scan.range_min = 0.02;
  scan.range_max = 4.0;
  scan.ranges.assign(667, kNothing);
  scan.codes.assign(667, 0);
  return scan;
}

/// A straight wall from (x0, y) to (x1, y), of which beams at less than `grazing` get no echo.
void see_wall(robot::LaserScan& scan, double x0, double x1, double y, double grazing) {
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double sine = std::sin(scan.bearing(i));
    if (sine * y <= 0.0) continue;
    const double range = y / sine;
    const double x = range * std::cos(scan.bearing(i));
    if (x < x0 || x > x1 || range > scan.range_max || std::abs(sine) < std::sin(grazing)) continue;
    scan.ranges[i] = static_cast<float>(range);
  }
}

int misses(const robot::LaserScan& scan) {
  return static_cast<int>(std::count(scan.ranges.begin(), scan.ranges.end(), kNothing));
}

TEST(SureMisses, OfAnOpenHallAllAre) { EXPECT_EQ(misses(with_sure_misses(nothing_around())), 667); }

/// A log of bare ranges: a dark wall and an open hall look alike.
TEST(SureMisses, WithoutTheScannersCodesNoneIs) {
  robot::LaserScan scan = nothing_around();
  scan.codes.clear();
  EXPECT_EQ(misses(with_sure_misses(scan)), 0);
  scan = nothing_around();
  std::fill(scan.codes.begin() + 100, scan.codes.begin() + 200, std::uint8_t{1});  // too little light came back
  EXPECT_EQ(misses(with_sure_misses(scan)), 567 - 4);
}

TEST(SureMisses, RangesStayAsTheyAre) {
  robot::LaserScan scan = nothing_around();
  see_wall(scan, -1.0, 1.0, 1.5, 0.0);
  const robot::LaserScan sure = with_sure_misses(scan);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (std::isfinite(scan.ranges[i])) {
      EXPECT_EQ(sure.ranges[i], scan.ranges[i]) << i;
    } else {
      EXPECT_FALSE(std::isfinite(sure.ranges[i])) << i;
    }
  }
}

TEST(SureMisses, AFewBeamsBetweenHitsMayBeADarkPost) {
  for (const int width : {1, 4, 5, 30}) {
    robot::LaserScan scan = nothing_around();
    for (float& range : scan.ranges) range = 2.0F;
    std::fill_n(scan.ranges.begin() + 300, width, kNothing);
    EXPECT_EQ(misses(with_sure_misses(scan)), width < 5 ? 0 : width - 4) << width;  // but for two at either end
  }
}

/// A long wall beside the robot, of which the far end, met at less than 10 deg, gives no echo: the beams there did meet
/// it. Beams that would meet it beyond the scanner's reach, and those on the other side, saw nothing.
TEST(SureMisses, AWallThatGoesOnAtAFlatAngleSwallowsEchoes) {
  robot::LaserScan scan = nothing_around();
  see_wall(scan, -0.5, 20.0, 0.4, deg_to_rad(10.0));
  const robot::LaserScan sure = with_sure_misses(scan);
  int swallowed = 0;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double bearing = scan.bearing(i);
    const bool meets = bearing > 0.0 && bearing < deg_to_rad(10.0) && 0.4 / std::sin(bearing) < 4.0;
    if (!meets) continue;
    ++swallowed;
    EXPECT_TRUE(std::isnan(sure.ranges[i])) << rad_to_deg(bearing);
  }
  EXPECT_GT(swallowed, 10);
  EXPECT_NEAR(misses(sure), misses(scan) - swallowed, 4);

  // Mirrored, the same beams from the other end.
  robot::LaserScan mirrored = scan;
  std::reverse(mirrored.ranges.begin(), mirrored.ranges.end());
  mirrored.angle_min = -(scan.angle_min + 666.0 * scan.angle_step);
  EXPECT_EQ(misses(with_sure_misses(mirrored)), misses(sure));
}

/// A wall that ends: beams beside it that it would meet at a steep angle went past.
TEST(SureMisses, PastTheEndOfAWallSteepBeamsAreSure) {
  robot::LaserScan scan = nothing_around();
  see_wall(scan, -0.5, 0.5, 1.5, 0.0);
  EXPECT_EQ(misses(with_sure_misses(scan)), misses(scan) - 4);
}

TEST(SureMisses, AsTheMapperIsTold) {
  robot::LaserScan scan = nothing_around();
  scan.codes.clear();
  EXPECT_EQ(misses(with_trusted_misses(scan, MissTrust::All)), 667);
  EXPECT_EQ(misses(with_trusted_misses(scan, MissTrust::Sure)), 0);
}

TEST(SureMisses, OfNoBeamsOrOneAreNone) {
  robot::LaserScan scan = nothing_around();
  scan.ranges.clear();
  scan.codes.clear();
  EXPECT_TRUE(with_sure_misses(scan).ranges.empty());
  scan.ranges = {kNothing};
  scan.codes = {0};
  EXPECT_EQ(misses(with_sure_misses(scan)), 0);
}

}  // namespace
}  // namespace rubble::slam
