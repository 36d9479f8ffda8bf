#include "scenarios/batch/worker_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>

#include "base/error.h"

namespace rubble::scenarios {
namespace {

std::map<std::size_t, TaskResult> run(std::size_t tasks, const PoolOptions& options,
                                      const std::function<std::string(std::size_t)>& work) {
  std::map<std::size_t, TaskResult> results;
  EXPECT_TRUE(run_pool(
      tasks, work,
      [&](const TaskResult& result) { EXPECT_TRUE(results.emplace(result.task, result).second) << "answered twice"; },
      options));
  return results;
}

PoolOptions workers(int count) {
  PoolOptions options;
  options.workers = count;
  options.time_limit = 60.0;
  return options;
}

TEST(WorkerPool, EveryTaskIsAnsweredOnceWhateverTheNumberOfWorkers) {
  for (const int count : {1, 2, 3, 100}) {
    const auto results = run(25, workers(count), [](std::size_t i) { return "task " + std::to_string(i * i); });
    ASSERT_EQ(results.size(), 25u);
    for (const auto& [task, result] : results) {
      EXPECT_EQ(result.end, TaskEnd::Done);
      EXPECT_EQ(result.text, "task " + std::to_string(task * task));
    }
  }
}

TEST(WorkerPool, NothingToDoIsDone) {
  EXPECT_TRUE(run(0, workers(2), [](std::size_t) { return ""; }).empty());
}

TEST(WorkerPool, OneProcessDoesManyTasks) {
  std::set<std::string> processes;
  for (const auto& entry : run(30, workers(2), [](std::size_t) { return std::to_string(getpid()); }))
    processes.insert(entry.second.text);
  EXPECT_LE(processes.size(), 2u);
  EXPECT_EQ(processes.count(std::to_string(getpid())), 0u);
}

TEST(WorkerPool, AnswersOfAnySizeArriveWhole) {
  const auto results = run(4, workers(2), [](std::size_t i) { return std::string(i * 3000000, 'x') + "end"; });
  for (const auto& [task, result] : results) EXPECT_EQ(result.text.size(), task * 3000000 + 3);
}

TEST(WorkerPool, ThrowCrashExitAndHangAreAnsweredAndTheRestGoesOn) {
  PoolOptions options = workers(2);
  options.time_limit = 1.0;
  const auto results = run(12, options, [](std::size_t i) -> std::string {
    if (i == 1) throw std::runtime_error("no wheels");
    if (i == 3) std::abort();
    if (i == 5) _exit(7);
    if (i == 7) raise(SIGKILL);
    if (i == 8)
      for (;;) pause();
    return "fine";
  });
  ASSERT_EQ(results.size(), 12u);
  for (const auto& [task, result] : results) {
    SCOPED_TRACE(task);
    if (task == 1) {
      EXPECT_EQ(result.text, "no wheels");
    } else if (task == 3) {
      EXPECT_NE(result.text.find("signal 6"), std::string::npos) << result.text;
    } else if (task == 5) {
      EXPECT_NE(result.text.find("exit code 7"), std::string::npos) << result.text;
    } else if (task == 7) {
      EXPECT_NE(result.text.find("signal 9"), std::string::npos) << result.text;
    } else if (task == 8) {
      EXPECT_EQ(result.end, TaskEnd::TimedOut);
    } else {
      EXPECT_EQ(result.text, "fine");
    }
    EXPECT_EQ(result.end == TaskEnd::Failed, task == 1 || task == 3 || task == 5 || task == 7);
  }
}

TEST(WorkerPool, AWorkerThatDiesBetweenTasksIsReplaced) {
  const auto results = run(6, workers(1), [](std::size_t i) {
    if (i == 2) alarm(1);  // the default action of SIGALRM ends the process, after the answer or during a later task
    if (i == 3) pause();
    return std::string("fine");
  });
  for (const auto& [task, result] : results) EXPECT_EQ(result.end == TaskEnd::Done, task != 3) << task;
}

TEST(WorkerPool, StopEndsItWithoutTheRest) {
  std::size_t finished = 0;
  PoolOptions options = workers(1);
  options.stop = [&] { return finished == 3; };
  EXPECT_FALSE(run_pool(
      10, [](std::size_t) { return std::string(); }, [&](const TaskResult&) { ++finished; }, options));
  EXPECT_EQ(finished, 3u);
}

TEST(WorkerPool, AnExceptionOfTheReceiverPassesOn) {
  EXPECT_THROW(run_pool(
                   10, [](std::size_t) { return std::string(); },
                   [](const TaskResult&) { throw RunError("disk full"); }, workers(2)),
               RunError);
}

}  // namespace
}  // namespace rubble::scenarios
