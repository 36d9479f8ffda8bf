#include "robot/drivers/watch/standstill.h"

#include <gtest/gtest.h>

#include "robot/drivers/watch/freshness.h"

namespace rubble::robot {
namespace {

const Stamp kWoken = Stamp::from_seconds(100.0);

/// Looks fifty times a second for so long; whether it ever said that the computer stood still.
bool look_on(Standstill& standstill, Stamp& now, double seconds) {
  bool stood = false;
  for (const Stamp end = now + seconds; now < end;) {
    now = now + 0.02;
    stood = standstill.look(now, 0.0) || stood;
  }
  return stood;
}

TEST(Standstill, ABusyMomentIsNone) {
  Standstill standstill(kWoken, 0.0);
  Stamp now = kWoken;
  EXPECT_FALSE(look_on(standstill, now, 3.0));
  EXPECT_TRUE(standstill.is_over(now, 0.0));
  now = now + 0.9;
  EXPECT_TRUE(standstill.is_over(now, 0.0));
  EXPECT_FALSE(standstill.look(now, 0.0));
}

TEST(Standstill, WhoeverWakesFirstSeesItAndASecondMorePassesBeforeItIsOver) {
  Standstill standstill(kWoken, 0.0);
  Stamp now = kWoken;
  look_on(standstill, now, 1.0);
  now = now + 5.0;
  EXPECT_FALSE(standstill.is_over(now, 0.0)) << "the thread that looks still sleeps";
  EXPECT_TRUE(standstill.look(now, 0.0));
  EXPECT_NEAR(standstill.seconds(), 5.0, 1e-6);
  EXPECT_FALSE(look_on(standstill, now, kKeepsUp - 0.1));
  EXPECT_FALSE(standstill.is_over(now, 0.0));
  look_on(standstill, now, 0.2);
  EXPECT_TRUE(standstill.is_over(now, 0.0));
}

/// The clock that drivers go by stands still while the computer is suspended.
TEST(Standstill, ASuspendedComputerStoodStillThoughItsClockDidNotGoOn) {
  Standstill standstill(kWoken, 7.0);
  EXPECT_FALSE(standstill.is_over(kWoken + 0.02, 37.0));
  EXPECT_TRUE(standstill.look(kWoken + 0.02, 37.0));
  EXPECT_NEAR(standstill.seconds(), 30.02, 1e-6);
}

/// Other threads may ask before look() does.
TEST(Standstill, HowLongIsKnownBeforeItIsLookedAt) {
  const Stamp start = Stamp::from_seconds(100.0);
  Standstill standstill(start, 0.0);
  EXPECT_FALSE(standstill.is_over(start + 0.02, 5.0));
  EXPECT_NEAR(standstill.seconds(start + 0.02, 5.0), 5.02, 1e-6);
  EXPECT_TRUE(standstill.look(start + 0.02, 5.0));
  EXPECT_NEAR(standstill.seconds(start + 0.04, 5.0), 5.02, 1e-6);
}

}  // namespace
}  // namespace rubble::robot
