#include "slam/robust/tracking/known_leans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/planar.h"
#include "base/rng.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

/// Of a body on a floor that rises by 0.2 along y: it depends on the heading alone.
Lean on_slope(double heading) { return {0.2 * std::sin(heading), 0.2 * std::cos(heading)}; }

/// Of a body on waves: it depends on the place as well.
Lean on_waves(const TPose2D& pose) { return Lean{0.2 * std::sin(pose.x), 0.2 * std::sin(pose.y)}.turned(pose.phi); }

void add_frame(KeyFrames& frames, const TPose2D& pose) {
  GraphEdge edge;
  edge.from = frames.last();
  edge.to = frames.size();
  frames.add({}, pose, edge);
}

/// Key frames in a row, a metre apart, each turned a little more; the first lies at T_map_first.
KeyFrames row_of(int frames, const TPose2D& T_map_first) {
  KeyFrames row;
  for (int i = 0; i < frames; ++i) add_frame(row, T_map_first + TPose2D(static_cast<double>(i), 0.0, 0.3 * i));
  return row;
}

TEST(KnownLeans, GrowWithTheGroundAndNotWithTheTime) {
  KnownLeans leans;
  for (int scan = 0; scan < 10000; ++scan) leans.add(0, {0.1, 0.0, 0.001 * scan}, {});
  EXPECT_EQ(leans.size(), 1u) << "of a robot that turns on the spot";
  Rng rng(1, "to and fro");
  for (int scan = 0; scan < 10000; ++scan) leans.add(1, {rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), 0.0}, {});
  EXPECT_LE(leans.size(), 100u) << "of one that drives to and fro around a key frame";
}

TEST(KnownLeans, ABodyLeansAsItStands) {
  const KeyFrames frames = row_of(1, {});
  KnownLeans leans;
  leans.add(0, {0.1, 0.0, 0.7}, on_slope(0.7));
  for (double heading = -3.0; heading < 3.0; heading += 0.5) {
    const Lean lean = leans.nearest(frames, {0.1, 0.2, heading}, 0.4, nullptr);
    EXPECT_NEAR(lean.pitch, on_slope(heading).pitch, 1e-9);
    EXPECT_NEAR(lean.roll, on_slope(heading).roll, 1e-9);
  }
  EXPECT_EQ(leans.nearest(frames, {0.1, 0.41, 0.0}, 0.4, nullptr).roll, 0.0) << "level where nobody was";
}

/// On the key frames, however they were moved since, and on those of another map.
TEST(KnownLeans, IsAsFeltNearest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "leans");
    const KeyFrames drive = row_of(10, {});
    const TPose2D T_map_drive(2.0, 1.0, 0.5);
    KnownLeans leans;
    for (int k = 0; k < 3000; ++k) {
      const TPose2D at(rng.uniform(-0.5, 9.5), rng.uniform(-0.3, 0.3), rng.uniform(-3.0, 3.0));
      const int frame = std::clamp(static_cast<int>(std::lround(at.x)), 0, 9);
      leans.add(frame, at - drive.pose(frame), on_waves(at));
    }
    const KeyFrames map = row_of(12, T_map_drive + TPose2D(-0.8, 0.1, 0.0));
    const KnownLeans elsewhere = leans.on(map, drive, T_map_drive);
    KnownLeans shifted = leans;
    shifted.shift(map.size());
    KeyFrames both = map;
    for (int i = 0; i < drive.size(); ++i) add_frame(both, T_map_drive + drive.pose(i));
    Work work = 0;
    for (int k = 0; k < 300; ++k) {
      const TPose2D at(rng.uniform(-0.3, 9.3), rng.uniform(-0.2, 0.2), rng.uniform(-3.0, 3.0));
      const Lean expected = on_waves(at);
      for (const Lean& lean :
           {leans.nearest(drive, at, 0.4, &work), shifted.nearest(both, T_map_drive + at, 0.4, &work),
            elsewhere.nearest(map, T_map_drive + at, 0.4, &work)}) {
        EXPECT_NEAR(lean.pitch, expected.pitch, 0.05) << at.asString();
        EXPECT_NEAR(lean.roll, expected.roll, 0.05) << at.asString();
      }
    }
    EXPECT_GT(work, 0);
  }
}

}  // namespace
}  // namespace rubble::slam
