#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include "explore/explorer.h"
#include "robot/robot.h"
#include "scenarios/run/core.h"
#include "scenarios/run/run_folder.h"
#include "scoring/figures/evidence.h"

namespace rubble::scenarios {

/// How far a run is, for a progress line.
struct Progress {
  double sim_s = 0.0;     ///< time covered so far [s]
  double share = 0.0;     ///< of the time limit or of the log, 0..1
  double known_m2 = 0.0;  ///< area mapped so far [m^2]
  double real_time_factor = 0.0;
};

/// What a loop asks and tells while it goes. Each may be empty.
struct LoopHooks {
  std::function<bool()> interrupted;  ///< asked each tick; true ends the loop
  std::function<std::string()> over;  ///< asked each tick; says why the run is over, else nothing
  std::function<double()> share;      ///< how far the robot is, 0..1
  /// Each tick: from what came in and what the core commands to what the robot is told; empty: what the core commands.
  std::function<robot::Commands(const robot::Inputs&, const robot::Commands&)> steer;
  std::function<void(double sim_s)> each_second;          ///< of run time, and at the end
  std::function<void()> stop;                             ///< the last command was given; what follows may take seconds
  std::function<void(const Progress&)> progress;          ///< called a few times a second of wall time
  std::function<void(const explore::Decision&)> decided;  ///< called for each decision of the explorer, in order
  std::function<void(const explore::Decision&)> waits;    ///< called once when the robot waits in vain, see Core::waits
};

/// How a loop ended.
struct LoopEnd {
  std::string reason;
  std::string failure;       ///< the robot or the mapper was lost
  bool robot_ended = false;  ///< the robot gave no more; its owner may know why
  bool interrupted = false;
  double sim_s = 0.0;  ///< time covered [s]
};

/// The one loop, for simulator, log and hardware alike: reads, maps, decides, commands, until the robot's time is over,
/// the explorer has finished or somebody interrupts; then the mapper ends what it put off. Saves the trajectories every
/// second of run time and the map after the first of these, then ever more seldom up to every few seconds of wall time.
/// Afterwards the folder holds the final trajectory and map.
class Loop {
 public:
  Loop(const Scenario& scenario, RunFolder& folder, Core& core, LoopHooks hooks);

  LoopEnd run(robot::Robot& robot);

  /// Trajectories and map as they are, out of turn.
  void save_now();

 private:
  using Clock = std::chrono::steady_clock;

  void drive(robot::Robot& robot, LoopEnd& end);
  void tell_decisions();
  void save(double sim_s);
  double seconds_since(Clock::time_point then) const;

  const Scenario& scenario_;
  RunFolder& folder_;
  Core& core_;
  LoopHooks hooks_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_save_ = start_;
  Clock::time_point last_report_ = start_;
  std::size_t told_ = 0;  ///< decisions of the explorer
  bool told_waits_ = false;
  double save_period_ = 0.0;  ///< grows: a run of a few seconds leaves a map too when it is killed [s]
};

/// What mapper and explorer did in `sim_s` seconds of run time. `reason`: why it ended, for people.
scoring::RunFigures run_figures(const Core& core, double sim_s, const std::string& reason);

/// Time of the wall clock since `start` [s]: for what a run costs, never for what it does.
double seconds_since(std::chrono::steady_clock::time_point start);

/// The most memory this process has held so far.
double peak_megabytes();

}  // namespace rubble::scenarios
