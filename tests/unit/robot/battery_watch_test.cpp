#include "robot/battery_watch.h"

#include <gtest/gtest.h>

namespace rubble::robot {
namespace {

class Battery {
 public:
  void hold(double volts, double seconds) {
    for (int i = 0; i < 10.0 * seconds; ++i) watch.look(volts, now_ = now_ + 0.1);
  }
  BatteryWatch watch{11.5, 11.0};

 private:
  Stamp now_ = Stamp::from_seconds(10.0);
};

TEST(BatteryWatch, OnlyWhatLastsCounts) {
  Battery battery;
  for (int i = 0; i < 10; ++i) {  // motors that start
    battery.hold(10.5, 0.8 * BatteryWatch::kLasts);
    battery.hold(12.0, 1.0);
  }
  EXPECT_FALSE(battery.watch.low());
  battery.hold(11.3, 1.1 * BatteryWatch::kLasts);
  EXPECT_TRUE(battery.watch.low());
  EXPECT_FALSE(battery.watch.empty());
  battery.hold(11.6, 60.0);
  EXPECT_TRUE(battery.watch.low()) << "at rest it seems to have recovered";
  battery.hold(10.9, 1.1 * BatteryWatch::kLasts);
  EXPECT_TRUE(battery.watch.empty());
  battery.hold(12.5, 1.0);
  EXPECT_FALSE(battery.watch.low());
  EXPECT_FALSE(battery.watch.empty());
}

TEST(BatteryWatch, WhoTakesItOnHimselfDrivesOn) {
  Battery battery;
  battery.watch.pardon();
  battery.hold(7.0, 20.0);
  EXPECT_TRUE(battery.watch.empty()) << "nobody had known of it";
  battery.watch.pardon();
  battery.hold(7.0, 20.0);
  EXPECT_FALSE(battery.watch.empty());
  EXPECT_TRUE(battery.watch.low());
}

TEST(BatteryWatch, WhatABaseDoesNotTellAndALimitOfNothingAreNoAlarm) {
  Battery silent;
  silent.hold(0.0, 60.0);
  EXPECT_FALSE(silent.watch.low());
  BatteryWatch off{0.0, 0.0};
  for (int i = 0; i < 600; ++i) off.look(3.0, Stamp::from_seconds(i));
  EXPECT_FALSE(off.low() || off.empty());
}

}  // namespace
}  // namespace rubble::robot
