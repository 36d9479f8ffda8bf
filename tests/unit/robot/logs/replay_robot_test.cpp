#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "robot/logs/log.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

/// Of a CARMEN log whose scans are so far apart by its stamps, the line that doubts them; empty: none.
std::string doubt_of(double seconds, int scans) {
  const testing::TempFolder folder;
  const std::string name = folder.file("scans.log");
  {
    std::ofstream log(name);
    for (int i = 0; i < scans; ++i) {
      log << "FLASER 180";
      for (int beam = 0; beam < 180; ++beam) log << " 2.0";
      log << " 0 0 0 0 0 0 " << std::to_string(seconds * i) << " robot " << std::to_string(seconds * i) << "\n";
    }
  }
  const ReplayRobot robot(name);
  for (const std::string& note : robot.notes())
    if (note.find("apart (median)") != std::string::npos) return note;
  return "";
}

/// Stamps of another unit map a robot as slow as a plant or faster than a bullet, and nothing else tells.
TEST(ReplayedLog, StampsOfAnotherUnitAreTold) {
  for (const double period : {0.025, 0.1, 0.2, 1.0, 25.0}) {
    EXPECT_EQ(doubt_of(period, 20), "") << period;
    EXPECT_NE(doubt_of(1e3 * std::max(period, 0.1), 20), "") << period << " in ms";
    EXPECT_NE(doubt_of(1e-3 * std::min(period, 1.0), 20), "") << period;
  }
  EXPECT_EQ(doubt_of(0.0, 20), "") << "a clock that stands";
  EXPECT_EQ(doubt_of(1e3, 2), "") << "two scans tell no period";
}

}  // namespace
}  // namespace rubble::robot
