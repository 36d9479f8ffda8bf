#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "arenas/model/arena.h"
#include "base/trajectory.h"
#include "robot/robot.h"
#include "sim/sim_robot.h"

namespace rubble::sim {

/// One robot of a team and where it starts.
struct TeamMember {
  robot::RobotModel model;
  mrpt::math::TPose2D start;
};

/// Several robots in one arena, each behind its own Robot. They see, block and push each other.
///
/// In lock step: the first robot that asks for a new tick advances the world for all, under the commands given so far;
/// the others find their measurements of that tick when they read. Used from one thread, in any order that is the same
/// from run to run, a run is the same to the bit.
class SimTeam {
 public:
  /// Throws InputError when the team is empty, a physics step does not fit, the ticks differ, or two robots start in
  /// one place. The first robot's noise is that of a SimRobot with the same seed.
  SimTeam(const arenas::Arena& arena, const std::vector<TeamMember>& members, const SimConfig& config,
          std::uint64_t seed);
  ~SimTeam();

  std::size_t size() const;
  robot::Robot& robot(std::size_t i);
  /// True poses of robot i, one entry a tick, from stamp 0 on.
  const Trajectory& truth(std::size_t i) const;

 private:
  struct Impl;
  class Member;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::sim
