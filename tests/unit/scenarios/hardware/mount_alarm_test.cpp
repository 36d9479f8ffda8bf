// Whole drives in arenas whose floors and walls make wheels slip: nobody is blamed who is not to blame, and who is to
// blame is found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "base/angle.h"
#include "robot/drivers/scanner.h"
#include "robot/drivers/watch/mount_witness.h"
#include "robot/logs/log.h"
#include "scenarios/config/scenario.h"
#include "scenarios/run/run.h"
#include "tests/support/base_files.h"
#include "tests/support/source_dir.h"

namespace rubble::scenarios {
namespace {

/// What is found in the drive of `log`, whose scanner looks `yaw` [rad] elsewhere than its file says or hangs upside
/// down; `gone`: after so many metres.
std::string found_in(const std::string& log, double yaw, bool upside_down, double& gone) {
  robot::ReplayRobot replay(log);
  const auto& mount = replay.model().T_base_laser;
  robot::MountWitness witness({mount.x, mount.y, mount.yaw + yaw});
  std::optional<mrpt::math::TPose2D> last;
  gone = 0.0;
  while (const auto inputs = replay.read()) {
    for (const robot::Odometry& report : inputs->odometry) {
      if (last) gone += std::hypot(report.pose.x - last->x, report.pose.y - last->y);
      last = report.pose;
      witness.look(report, inputs->now);
      if (witness.finding()) return witness.finding()->line();
    }
    for (robot::LaserScan scan : inputs->scans) {
      if (upside_down) robot::turn_over(scan);
      witness.see(scan, inputs->now);
    }
  }
  return "";
}

TEST(MountAlarm, SlipAndRampsOfAnOrangeArenaAreNoneAndAWrongMountIs) {
  const test::TempFolder folder;
  for (const int seed : {1, 2}) {
    Scenario scenario =
        load_scenario(std::string(RUBBLE_SOURCE_DIR) + "/scenarios/yellow.yaml", {{"arena.generate.kind", "orange"},
                                                                                  {"arena.generate.ramps", "0.5"},
                                                                                  {"seed", std::to_string(seed)},
                                                                                  {"time_limit_s", "120"}});
    RunOptions options;
    options.out = folder / ("run" + std::to_string(seed));
    run_scenario(scenario, options);
    const std::string log = options.out + "/log.rlog";
    double gone = 0.0;
    EXPECT_EQ(found_in(log, 0.0, false, gone), "");
    EXPECT_GT(gone, 10.0) << "it did not drive";
    EXPECT_THAT(found_in(log, kPi, false, gone), testing::HasSubstr("devices.urg.yaw_deg"));
    EXPECT_LT(gone, 10.0);
    EXPECT_THAT(found_in(log, 0.0, true, gone), testing::HasSubstr("devices.urg.upside_down"));
    EXPECT_LT(gone, 2.0);
  }
}

}  // namespace
}  // namespace rubble::scenarios
