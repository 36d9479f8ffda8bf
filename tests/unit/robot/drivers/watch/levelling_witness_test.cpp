// A platform that is levelled the wrong way, or not at all.
#include "robot/drivers/watch/levelling_witness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.h"
#include "robot/hardware_units.h"
#include "robot/levelling.h"

namespace rubble::robot {
namespace {

using testing::HasSubstr;

/// The levelling loop on a body that tilts; the servos turn by `gain` of what they are told.
class Platform {
 public:
  /// Seconds until it is found out, of `most` [s].
  double run(double body_pitch_deg, double body_roll_deg, double gain, double most = 10.0) {
    for (int i = 0; i < 50.0 * most; ++i) {
      now_ = now_ + 0.02;
      const Acceleration felt{now_, kGravity * std::sin(deg_to_rad(body_pitch_deg) + gain * aim_.pitch),
                              kGravity * std::sin(deg_to_rad(body_roll_deg) + gain * aim_.roll)};
      Inputs inputs;
      inputs.now = now_;
      inputs.accelerations = {felt};
      inputs.aims = {{now_, aim_.pitch, aim_.roll}};
      witness.look(felt, inputs.aims.front());
      if (!witness.finding().empty()) return 0.02 * i;
      aim_ = levelling_.update(inputs);
    }
    return most;
  }
  LevellingWitness witness;

 private:
  Levelling levelling_{LevellingConfig{}, RobotModel()};
  LaserAim aim_;
  Stamp now_ = Stamp::from_seconds(10.0);
};

TEST(LevellingWitness, APlatformThatIsLevelledIsNeverBlamed) {
  Platform platform;
  for (const double tilt : {0.0, 10.0, -10.0, 28.0, -28.0, 3.0})
    EXPECT_EQ(platform.run(tilt, -0.7 * tilt, 1.0, 3.0), 3.0) << tilt << ": " << platform.witness.finding();
}

TEST(LevellingWitness, OneThatTurnsTheWrongWayIsFoundWithinSeconds) {
  for (const double tilt : {1.0, -1.0, 8.0}) {
    Platform pitch, roll;
    EXPECT_LT(pitch.run(tilt, 0.0, -1.0), 5.0) << tilt;
    EXPECT_THAT(pitch.witness.finding(), HasSubstr("devices.levelling.pitch.deg_per_us"));
    EXPECT_LT(roll.run(0.0, tilt, -1.0), 5.0) << tilt;
    EXPECT_THAT(roll.witness.finding(), HasSubstr("devices.levelling.roll.deg_per_us"));
    roll.witness = LevellingWitness();
    EXPECT_EQ(roll.witness.finding(), "");
  }
}

TEST(LevellingWitness, OneThatDoesNotTurnIsFoundWhereItMatters) {
  Platform flat, ramp;
  EXPECT_EQ(flat.run(2.0, 0.0, 0.0), 10.0);
  EXPECT_LT(ramp.run(12.0, 0.0, 0.0), 5.0);
  EXPECT_THAT(ramp.witness.finding(), HasSubstr("does its servo turn"));
}

}  // namespace
}  // namespace rubble::robot
