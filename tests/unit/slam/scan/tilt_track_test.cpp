#include "slam/scan/tilt_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/angle.h"
#include "robot/hardware_units.h"

namespace rubble::slam {
namespace {

using robot::AccelerometerMount;
using robot::Inputs;
using robot::RobotModel;

/// A robot on a floor: how its body leans, how it moves, and where its servos hold the platform, by time [s].
struct Ride {
  std::function<double(double)> pitch = [](double) { return 0.0; };
  std::function<double(double)> roll = [](double) { return 0.0; };
  std::function<double(double)> v = [](double) { return 0.0; };
  std::function<double(double)> w = [](double) { return 0.0; };
  std::function<double(double)> servo = [](double) { return 0.0; };  ///< of the pitch, where it stands
  std::function<double(double)> pulse = [](double) { return 0.0; };  ///< of the pitch, what it is told
};

double slope(const std::function<double(double)>& f, double t) { return (f(t + 1e-5) - f(t - 1e-5)) / 2e-5; }

/// What the ride's sensors say in [0, seconds): acceleration and servos at 50 Hz, odometry at 10 Hz.
std::vector<Inputs> sensed(const Ride& ride, const RobotModel& model, double seconds) {
  std::vector<Inputs> ticks;
  const bool platform = model.accelerometer_mount == AccelerometerMount::Platform;
  const double x = platform ? model.T_base_laser.x : 0.0, y = platform ? model.T_base_laser.y : 0.0;
  for (int i = 0; i * 0.02 < seconds; ++i) {
    const double t = 0.02 * i;
    Inputs tick;
    tick.now = Stamp::from_seconds(t);
    const double pitch = ride.pitch(t) + (platform ? ride.servo(t) : 0.0), roll = ride.roll(t);
    const double v = ride.v(t), w = ride.w(t), alpha = slope(ride.w, t);
    tick.accelerations.push_back({tick.now,
                                  robot::kGravity * std::sin(pitch) + slope(ride.v, t) - alpha * y - w * w * x,
                                  robot::kGravity * std::sin(roll) * std::cos(pitch) + v * w + alpha * x - w * w * y});
    tick.aims.push_back({tick.now, ride.pulse(t), 0.0});
    if (i % 5 == 0) tick.odometry.push_back({tick.now, {}, v, w, false});
    ticks.push_back(tick);
  }
  return ticks;
}

struct Worst {
  double body_pitch = 0.0, body_roll = 0.0, pitch = 0.0;  ///< errors [deg]
  int scans = 0;
};

/// The errors of what is said of a scan every 0.1 s from 1 s on.
Worst worst(const Ride& ride, const RobotModel& model, double seconds) {
  TiltTrack track(model, {});
  Worst out;
  double next = 1.0;
  for (const Inputs& tick : sensed(ride, model, seconds)) {
    track.add(tick);
    while (track.ready(Stamp::from_seconds(next), tick.now) && Stamp::from_seconds(next) <= tick.now) {
      const auto tilt = track.at(Stamp::from_seconds(next));
      EXPECT_TRUE(tilt) << next;
      if (!tilt) return out;
      const auto raise = [](double& most, double error) { most = std::max(most, std::abs(rad_to_deg(error))); };
      raise(out.body_pitch, tilt->body_pitch - ride.pitch(next));
      raise(out.body_roll, tilt->body_roll - ride.roll(next));
      raise(out.pitch, tilt->pitch - ride.pitch(next) - ride.servo(next));
      ++out.scans;
      next += 0.1;
      track.forget_before(Stamp::from_seconds(next));
    }
  }
  return out;
}

/// The servo of the ride: told to swing, and there 40 ms and half a frame later.
void swing(Ride& ride, double angle, double per_second) {
  ride.pulse = [=](double t) { return angle * std::sin(per_second * t); };
  const double late = std::atan(per_second * 0.04), less = std::cos(late);
  ride.servo = [=](double t) { return angle * less * std::sin(per_second * (t - 0.01) - late); };
}

TEST(TiltTrack, AStandingRobotsLeanIsTold) {
  for (const double angle : {-10.0, 0.0, 3.0, 15.0}) {
    Ride ride;
    ride.pitch = [angle](double) { return deg_to_rad(angle); };
    ride.roll = [angle](double) { return deg_to_rad(-0.5 * angle); };
    const Worst error = worst(ride, {}, 4.0);
    EXPECT_GT(error.scans, 20);
    EXPECT_LT(error.body_pitch, 1e-3) << angle;
    EXPECT_LT(error.body_roll, 1e-3) << angle;
  }
}

TEST(TiltTrack, DrivingAndTurningOnALevelFloorIsNoLean) {
  Ride ride;
  ride.v = [](double t) { return 0.2 + 0.15 * std::sin(1.5 * t); };
  ride.w = [](double t) { return std::sin(1.1 * t); };
  for (const auto mount : {AccelerometerMount::Platform, AccelerometerMount::Body}) {
    RobotModel model;
    model.accelerometer_mount = mount;
    model.T_base_laser.y = 0.1;
    const Worst error = worst(ride, model, 12.0);
    EXPECT_GT(error.scans, 100);
    // Motion alone looks like 1.3 deg of pitch and 2.8 deg of roll, the lever of the platform like 0.9 and 0.9.
    EXPECT_LT(error.body_pitch, 0.1);
    EXPECT_LT(error.body_roll, 0.1);
  }
}

TEST(TiltTrack, ServosThatMoveFastMoveThePlatformAndNotTheBody) {
  Ride ride;
  ride.pitch = [](double) { return deg_to_rad(6.0); };
  swing(ride, deg_to_rad(8.0), 2.0 * kPi);
  for (const auto mount : {AccelerometerMount::Platform, AccelerometerMount::Body}) {
    RobotModel model;
    model.accelerometer_mount = mount;
    const Worst error = worst(ride, model, 6.0);
    EXPECT_LT(error.body_pitch, 0.5);
    EXPECT_LT(error.pitch, 0.9);
  }
}

TEST(TiltTrack, ARampIsFollowedWithinTwoDegrees) {
  Ride ride;  // 10 deg within half a second
  ride.pitch = [](double t) { return deg_to_rad(10.0) * std::clamp(2.0 * (t - 2.0), 0.0, 1.0); };
  const Worst error = worst(ride, {}, 5.0);
  EXPECT_LT(error.body_pitch, 2.0);
}

TEST(TiltTrack, SilentWheelsAreNotWaitedForAndTakeNothingAway) {
  RobotModel model;
  TiltTrack track(model, {});
  int told = 0;
  for (Inputs& tick : [&] {
         Ride ride;
         ride.roll = [](double) { return deg_to_rad(5.0); };
         return sensed(ride, model, 5.0);
       }()) {
    if (tick.now > Stamp::from_seconds(1.0)) tick.odometry.clear();
    track.add(tick);
    const Stamp scan = tick.now + -0.12;
    if (scan < Stamp::from_seconds(2.0)) continue;
    ASSERT_TRUE(track.ready(scan, tick.now));
    const auto tilt = track.at(scan);
    ASSERT_TRUE(tilt);
    EXPECT_NEAR(rad_to_deg(tilt->body_roll), 5.0, 1e-3);
    ++told;
  }
  EXPECT_GT(told, 100);
}

TEST(TiltTrack, StampsFromTheFutureChangeNothing) {
  Ride ride;
  ride.w = [](double t) { return std::sin(1.1 * t); };
  ride.pitch = [](double) { return deg_to_rad(4.0); };
  TiltTrack right(RobotModel(), {}), spoiled(RobotModel(), {});
  for (Inputs tick : sensed(ride, RobotModel(), 6.0)) {
    right.add(tick);
    if (tick.now == Stamp::from_seconds(2.0)) {
      const Stamp ahead = tick.now + 3600.0;
      tick.odometry.push_back({ahead, {}, 0.1, 0.1, false});
      tick.accelerations.push_back({ahead, 0.0, 0.0});
      tick.aims.push_back({ahead, 0.5, 0.5});
    }
    spoiled.add(tick);
  }
  const Stamp scan = Stamp::from_seconds(5.5);
  ASSERT_TRUE(right.at(scan));
  ASSERT_TRUE(spoiled.at(scan));
  EXPECT_EQ(right.at(scan)->pitch, spoiled.at(scan)->pitch);
  EXPECT_EQ(right.at(scan)->body_roll, spoiled.at(scan)->body_roll);
}

TEST(TiltTrack, WithoutAccelerationsNothingIsToldAndNothingWaitedFor) {
  TiltTrack track(RobotModel(), {});
  Inputs tick;
  tick.now = Stamp::from_seconds(1.0);
  tick.odometry.push_back({tick.now, {}, 0.1, 0.0, false});
  tick.aims.push_back({tick.now, 0.1, 0.0});
  track.add(tick);
  EXPECT_TRUE(track.ready(tick.now, tick.now));
  EXPECT_FALSE(track.at(tick.now));
}

/// Memory does not grow with the drive where no wheels tell what may be forgotten.
TEST(TiltTrack, WithoutOdometryAsMuchIsKeptAfterAMinuteAsAfterTenSeconds) {
  Ride ride;
  ride.pitch = [](double t) { return deg_to_rad(5.0) * std::sin(t); };
  ride.servo = ride.pulse = [](double) { return 0.0; };
  TiltTrack track(RobotModel(), {});
  std::size_t early = 0;
  for (Inputs tick : sensed(ride, RobotModel(), 60.0)) {
    tick.odometry.clear();
    track.add(tick);
    if (early == 0 && tick.now >= Stamp::from_seconds(10.0)) early = track.size();
    if (tick.now >= Stamp::from_seconds(2.0)) {
      EXPECT_TRUE(track.at(tick.now - 1.0));
    }
  }
  EXPECT_GT(early, 100u);
  EXPECT_LE(track.size(), early + 10);
}

TEST(TiltTrack, OfASilentUnitTheServosAreKnownToHold) {
  Ride ride;
  ride.pitch = [](double) { return deg_to_rad(8.0); };
  ride.servo = ride.pulse = [](double) { return deg_to_rad(-8.0); };
  TiltTrack track(RobotModel(), {});
  EXPECT_FALSE(track.knows_servos());
  for (const Inputs& tick : sensed(ride, RobotModel(), 3.0)) track.add(tick);
  const Stamp later = Stamp::from_seconds(10.0);
  Inputs silent;
  silent.now = later;
  track.add(silent);
  EXPECT_FALSE(track.at(later));
  ASSERT_TRUE(track.knows_servos());
  const ScanTilt flat = track.on_body(0.0, deg_to_rad(2.0), later);
  EXPECT_NEAR(rad_to_deg(flat.pitch), -8.0, 0.1);
  EXPECT_NEAR(rad_to_deg(flat.roll), 2.0, 0.1);
  EXPECT_EQ(flat.body_pitch, 0.0);
}

/// Servos that jammed on a ramp are told to turn to the end of their travel on level floor, and do not.
TEST(TiltTrack, AnglesOfServosThatJammedAreNoLeanOfTheBody) {
  Ride ride;
  ride.pitch = [](double t) { return t < 3.0 ? deg_to_rad(8.0) : 0.0; };
  ride.servo = [](double) { return deg_to_rad(-8.0); };
  ride.pulse = [](double t) { return deg_to_rad(t < 3.0 ? -8.0 : std::min(30.0, -8.0 + 40.0 * (t - 3.0))); };
  TiltTrack track(RobotModel(), {});
  for (const Inputs& tick : sensed(ride, RobotModel(), 8.0)) track.add(tick);
  const auto tilt = track.at(Stamp::from_seconds(7.5));
  ASSERT_TRUE(tilt);
  EXPECT_NEAR(rad_to_deg(tilt->pitch), -8.0, 1.0);
  EXPECT_NEAR(rad_to_deg(tilt->body_pitch), 0.0, 1.0);
}

}  // namespace
}  // namespace rubble::slam
