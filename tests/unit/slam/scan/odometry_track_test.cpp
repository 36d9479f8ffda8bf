#include "slam/scan/odometry_track.h"

#include <gtest/gtest.h>

#include "base/angle.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

robot::Odometry at(double t, const TPose2D& pose, double v = 0.0, double w = 0.0) {
  return {Stamp::from_seconds(t), pose, v, w, false};
}

Stamp s(double t) { return Stamp::from_seconds(t); }

TEST(OdometryTrack, EmptyTrackKnowsNoMotion) {
  const OdometryTrack track;
  EXPECT_TRUE(track.empty());
  EXPECT_EQ(track.pose_at(s(3.0)), TPose2D());
  EXPECT_EQ(track.between(s(1.0), s(2.0)), TPose2D());
}

TEST(OdometryTrack, InterpolatesLinearlyBetweenTheNeighbours) {
  OdometryTrack track;
  track.add(at(1.0, {1.0, 2.0, 0.1}));
  track.add(at(1.1, {1.2, 2.4, 0.3}));
  const TPose2D pose = track.pose_at(s(1.025));
  EXPECT_NEAR(pose.x, 1.05, 1e-12);
  EXPECT_NEAR(pose.y, 2.1, 1e-12);
  EXPECT_NEAR(pose.phi, 0.15, 1e-12);
}

TEST(OdometryTrack, InterpolatesTheAngleTheShortWayRound) {
  OdometryTrack track;
  track.add(at(0.0, {0.0, 0.0, kPi - 0.1}));
  track.add(at(1.0, {0.0, 0.0, -kPi + 0.3}));
  EXPECT_NEAR(wrap_angle(track.pose_at(s(0.25)).phi - kPi), 0.0, 1e-12);
  EXPECT_NEAR(track.pose_at(s(0.5)).phi, -kPi + 0.1, 1e-12);
}

TEST(OdometryTrack, ScanOlderThanTheFirstOdometrySeesNoMotion) {
  OdometryTrack track;
  track.add(at(1.0, {1.0, 2.0, 0.1}));
  track.add(at(1.1, {1.2, 2.4, 0.3}));
  EXPECT_EQ(track.between(s(0.2), s(0.9)), TPose2D());
}

TEST(OdometryTrack, CarriesOnByItsSpeedForAFifthOfASecondAtMost) {
  OdometryTrack straight;
  straight.add(at(1.0, {1.0, 0.0, 0.0}, 0.5, 0.0));
  EXPECT_NEAR(straight.pose_at(s(1.1)).x, 1.05, 1e-12);
  EXPECT_NEAR(straight.pose_at(s(9.0)).x, 1.1, 1e-12);
  OdometryTrack arc;
  arc.add(at(0.0, {0.0, 0.0, 0.0}, 1.0, kPi));  // radius 1 / pi
  const TPose2D pose = arc.pose_at(s(0.2));
  EXPECT_NEAR(pose.x, std::sin(0.2 * kPi) / kPi, 1e-12);
  EXPECT_NEAR(pose.y, (1.0 - std::cos(0.2 * kPi)) / kPi, 1e-12);
  EXPECT_NEAR(pose.phi, 0.2 * kPi, 1e-12);
}

TEST(OdometryTrack, MotionIsSeenFromThePoseBefore) {
  OdometryTrack track;
  track.add(at(0.0, {5.0, 5.0, kPi / 2.0}));
  track.add(at(1.0, {5.0, 6.0, kPi / 2.0}));
  const TPose2D motion = track.between(s(0.0), s(1.0));
  EXPECT_NEAR(motion.x, 1.0, 1e-12);
  EXPECT_NEAR(motion.y, 0.0, 1e-12);
}

TEST(OdometryTrack, IgnoresWhatIsNotYounger) {
  OdometryTrack track;
  track.add(at(1.0, {1.0, 0.0, 0.0}));
  track.add(at(1.0, {9.0, 0.0, 0.0}));
  track.add(at(0.5, {8.0, 0.0, 0.0}));
  EXPECT_EQ(track.size(), 1u);
  EXPECT_EQ(track.pose_at(s(1.0)).x, 1.0);
}

TEST(OdometryTrack, ForgettingDoesNotChangeLaterAnswers) {
  OdometryTrack track;
  for (int i = 0; i < 50; ++i) track.add(at(0.1 * i, {0.1 * i * i, 0.0, 0.0}));
  const TPose2D before = track.pose_at(s(3.03));
  track.forget_before(s(3.03));
  EXPECT_LT(track.size(), 30u);
  EXPECT_EQ(track.pose_at(s(3.03)), before);
}

}  // namespace
}  // namespace rubble::slam
