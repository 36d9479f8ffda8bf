#pragma once

#include <vector>

#include "robot/drivers/base_driver.h"
#include "robot/drivers/black_box.h"
#include "robot/drivers/levelling_unit.h"

namespace rubble::robot {

/// What the drivers of base and levelling unit made of a black box.
struct ReplayedBox {
  std::vector<Odometry> odometry;
  std::vector<Acceleration> accelerations;
  std::vector<AimState> aims;
  std::size_t bad_sums = 0;   ///< of the base
  std::size_t jumps = 0;      ///< of its odometry
  std::size_t bad_lines = 0;  ///< of the levelling unit
};

/// Plays the bytes of the devices `base` (its driver by name) and `levelling` to their drivers, at the times they had.
ReplayedBox replay_black_box(const std::vector<BlackBoxEntry>& entries, const std::string& driver,
                             const BaseSettings& base, const LevellingUnitSettings& levelling);

}  // namespace rubble::robot
