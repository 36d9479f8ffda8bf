#include "scenarios/batch/batch.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <random>
#include <sstream>

#include "base/error.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

class Batch : public FolderTest {
 protected:
  static std::vector<Job> jobs(std::uint64_t count) {
    std::vector<Job> jobs;
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
      Job job;
      job.kind->scenario.name = "arena";
      job.kind->configuration = "default";
      job.seed = seed;
      char id[17];
      std::snprintf(id, sizeof id, "%016llx", static_cast<unsigned long long>(seed * 0x9e3779b97f4a7c15ull));
      job.run_id = id;
      jobs.push_back(job);
    }
    return jobs;
  }
  BatchOptions options(const std::string& out, int workers = 2) const {
    BatchOptions options;
    options.out = path(out);
    options.workers = workers;
    options.run_limit = 60.0;
    options.code = "test";
    return options;
  }
  /// Leaves a line in DIR/made for each run that it begins and another when it ends.
  static RunOutcome fake(const Job& job, const std::string& folder) {
    fs::create_directories(folder);
    note(folder, "begin", job);
    RunOutcome outcome;
    *outcome.score = {{"score", 1.0 / static_cast<double>(job.seed)}, {"wall_s", static_cast<double>(getpid())}};
    outcome.end = "explored";
    outcome.broken = {"score is 0.1, expected at least 0.5", "wall_s is 12, expected at most 10"};
    note(folder, "end", job);
    return outcome;
  }
  static void note(const std::string& folder, const std::string& what, const Job& job) {
    std::ofstream(fs::path(folder).parent_path().parent_path() / "made", std::ios::app)
        << what + " " + std::to_string(job.seed) + "\n";
  }
  static std::vector<std::string> sorted_lines(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    std::sort(lines.begin(), lines.end());
    return lines;
  }
};

TEST_F(Batch, ResultsAreTheSameBytesForAnyNumberOfWorkersAndShards) {
  for (const int workers : {1, 2, 3}) run_batch(jobs(20), fake, options("w" + std::to_string(workers), workers));
  const auto one = sorted_lines(read(path("w1/results.jsonl")));
  EXPECT_EQ(one.size(), 20u);
  EXPECT_EQ(one, sorted_lines(read(path("w2/results.jsonl"))));
  EXPECT_EQ(one, sorted_lines(read(path("w3/results.jsonl"))));
  std::string parts;
  for (int i = 1; i <= 3; ++i) {
    BatchOptions part = options("shards");
    part.shard = {i, 3};
    run_batch(jobs(20), fake, part);
    parts += read(path("shards/results" + shard_suffix(part.shard) + ".jsonl"));
  }
  EXPECT_EQ(one, sorted_lines(parts));
}

TEST_F(Batch, FinishedRunsAreSkippedWhicheverShardMadeThem) {
  BatchOptions part = options("out");
  part.shard = {2, 3};
  const auto first = run_batch(jobs(20), fake, part).progress;
  EXPECT_EQ(first.done, first.total);
  const auto whole = run_batch(jobs(20), fake, options("out")).progress;
  EXPECT_EQ(whole.skipped, first.done);
  EXPECT_EQ(whole.done, 20u - first.done);
  const auto again = run_batch(jobs(25), fake, options("out")).progress;
  EXPECT_EQ(again.skipped, 20u);
  EXPECT_EQ(again.done, 5u);
  EXPECT_EQ(load_lines(path("out")).size(), 25u);
}

TEST_F(Batch, FailuresAndHangsAreRecordedAndMadeAgainOnlyWhenAsked) {
  BatchOptions with_limit = options("out");
  with_limit.run_limit = 1.0;
  const Runner faulty = [](const Job& job, const std::string& folder) {
    if (job.seed == 2) throw InputError("arena 2 has no start");
    if (job.seed == 3) std::abort();
    if (job.seed == 4)
      for (;;) pause();
    RunOutcome outcome = fake(job, folder);
    if (job.seed == 5) outcome.failure = "laser lost";
    return outcome;
  };
  const auto report = run_batch(jobs(8), faulty, with_limit);
  EXPECT_EQ(report.progress.done, 8u);
  EXPECT_EQ(report.progress.failed, 4u);
  const auto records = load_lines(with_limit.out);
  ASSERT_EQ(records.size(), 8u);
  EXPECT_EQ(name_of(records[1].status) + ": " + records[1].error, "failed: arena 2 has no start");
  EXPECT_THAT(records[2].error, testing::HasSubstr("signal 6"));
  EXPECT_EQ(records[3].status, RunStatus::TimedOut);
  EXPECT_EQ(name_of(records[4].status) + ": " + records[4].error, "failed: laser lost");
  EXPECT_EQ(records[4].metric("score"), 0.2) << "a lost robot still has a score";
  EXPECT_TRUE(records[5].ok());
  EXPECT_EQ(run_batch(jobs(8), fake, with_limit).progress.done, 0u);
  with_limit.retry = true;
  EXPECT_EQ(run_batch(jobs(8), fake, with_limit).progress.done, 4u);
  for (const auto& record : load_lines(with_limit.out)) EXPECT_TRUE(record.ok()) << record.seed;
}

TEST_F(Batch, VictimsThatNobodyCanSeeAreKeptBesideTheFigures) {
  const auto runner = [](const Job& job, const std::string& folder) {
    RunOutcome outcome = fake(job, folder);
    if (job.seed == 2) (*outcome.score)["unseen_victims"] = {"true victim2"};
    return outcome;
  };
  run_batch(jobs(2), runner, options("out"));
  for (const RunRecord& run : load_lines(path("out")))
    EXPECT_EQ(run.score->contains("unseen_victims"), run.seed == 2) << run.score->dump();
}

TEST_F(Batch, ExpectationsAboutTheMachineAreNoPartOfTheResult) {
  run_batch(jobs(1), fake, options("out"));
  EXPECT_THAT(load_lines(path("out"))[0].broken, testing::ElementsAre("score is 0.1, expected at least 0.5"));
  EXPECT_EQ(load_timing(path("out")).begin()->second["broken"][0], "wall_s is 12, expected at most 10");
}

TEST_F(Batch, AKillLosesNoRunAndMakesNoneTwice) {
  const Runner slow = [](const Job& job, const std::string& folder) {
    usleep(50000);
    return fake(job, folder);
  };
  const auto all = jobs(40);
  for (int round = 0; round < 4; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      run_batch(all, slow, options("out"));
      _exit(0);
    }
    usleep(150000 + 30000 * static_cast<unsigned>(round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    usleep(100000);  // the workers die with their parent; what they noted is then on disk
  }
  EXPECT_EQ(run_batch(all, slow, options("out")).progress.failed, 0u);
  EXPECT_EQ(sorted_lines(read(path("out/results.jsonl"))).size(), 40u) << "one line a run";
  EXPECT_EQ(load_lines(path("out")).size(), 40u);
  // Only a run that had not been recorded may have been begun again: two workers, four kills.
  EXPECT_LE(sorted_lines(read(path("out/made"))).size(), 2u * (40u + 2u * 4u));
}

TEST_F(Batch, AStopKeepsWhatIsFinished) {
  std::size_t seen = 0;
  BatchOptions o = options("out", 1);
  o.progress = [&](const BatchProgress& p) { seen = p.done; };
  o.stop = [&] { return seen >= 5; };
  const auto report = run_batch(jobs(20), fake, o);
  EXPECT_TRUE(report.interrupted);
  EXPECT_GE(report.progress.done, 5u);
  EXPECT_EQ(load_lines(path("out")).size(), report.progress.done);
  EXPECT_EQ(run_batch(jobs(20), fake, options("out")).progress.skipped, report.progress.done);
}

/// Where each line stays: over a batch of random pace, nine lines at most of short ones, one in half a minute of long
/// ones.
TEST(ProgressPace, TellsEachTenthOrHalfMinuteAndNeverOnceAllIsDone) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    BatchProgress now;
    now.total = 20 + below(300);
    now.skipped = below(10);
    const std::size_t to_make = now.total - now.skipped;
    const double mean_s = 0.05 * static_cast<double>(1 + below(400));  // of a run
    ProgressPace pace;
    double told_s = 0.0;
    std::size_t told_done = 0, lines = 0;
    while (now.finished() < now.total) {
      now.elapsed_s += 0.1;
      if (now.elapsed_s >= mean_s * static_cast<double>(now.done + 1) && below(2) == 0) ++now.done;
      const bool tells = pace.due(now);
      const double since = now.elapsed_s - told_s;
      const bool is_tenth = 10 * (now.done - told_done) >= to_make;
      const bool last = now.finished() == now.total;
      ASSERT_EQ(tells, !last && now.done > told_done && since >= (is_tenth ? 10.0 : 30.0)) << now.elapsed_s << " s";
      if (!tells) continue;
      told_s = now.elapsed_s;
      told_done = now.done;
      ++lines;
    }
    EXPECT_LE(lines, now.elapsed_s < 100.0 ? 9U : static_cast<std::size_t>(10.0 + now.elapsed_s / 30.0));
    if (now.elapsed_s > 60.0) {
      EXPECT_GE(lines, 1U);
    }
  }
}

TEST(ProgressPace, IsSilentWhileNothingEnds) {
  ProgressPace pace;
  BatchProgress now;
  now.total = 3;
  for (now.elapsed_s = 0.0; now.elapsed_s < 500.0; now.elapsed_s += 1.0) EXPECT_FALSE(pace.due(now));
  now.done = 1;
  EXPECT_TRUE(pace.due(now));
  EXPECT_FALSE(pace.due(now));
}

TEST_F(Batch, AFolderThatCannotBeMadeIsNamed) {
  write("file", "");
  EXPECT_THROW(run_batch(jobs(1), fake, options("file/out")), InputError);
}

}  // namespace
}  // namespace rubble::scenarios
