#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace rubble::scenarios {

/// How a task ended.
enum class TaskEnd { Done, Failed, TimedOut };

struct TaskResult {
  std::size_t task = 0;
  TaskEnd end = TaskEnd::Done;
  std::string text;     ///< what the work returned, or why it failed
  double wall_s = 0.0;  ///< from handing out to the answer [s]
};

struct PoolState {
  std::size_t finished = 0;
  std::size_t running = 0;
  std::size_t tasks = 0;
};

struct PoolOptions {
  int workers = 1;
  double time_limit = 900.0;                       ///< a task that takes longer is killed [s]
  std::string log;                                 ///< file that takes what workers print; empty: nowhere
  std::function<bool()> stop;                      ///< asked several times a second; true ends the pool
  std::function<void(const PoolState&)> progress;  ///< called several times a second
};

/// Runs `work(0 .. tasks-1)` in forked processes, each of which does many tasks, handed out in order and one at a time.
/// Every answer comes back through `finished`, in this process, in order of completion. A task that throws, crashes its
/// process or takes too long is answered as such, and the rest goes on in a fresh process. An exception of `finished`
/// kills the workers and passes on; workers also die with this process. The caller must have no threads.
/// Returns whether every task was answered (false: stopped). Throws RunError when no process can be made.
bool run_pool(std::size_t tasks, const std::function<std::string(std::size_t)>& work,
              const std::function<void(const TaskResult&)>& finished, const PoolOptions& options);

}  // namespace rubble::scenarios
