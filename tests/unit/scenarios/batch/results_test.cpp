#include "scenarios/batch/results.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include "base/error.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

class Results : public FolderTest {
 protected:
  void append(const std::vector<RunRecord>& records) const {
    ResultsFile file(folder_, "");
    for (const auto& r : records) file.append(r, {{"wall_s", 1.5}});
  }
  std::string lines() const { return read(path("results.jsonl")); }
};

TEST_F(Results, ALineReadsBackToTheSameRecord) {
  RunRecord r = record("yellow", "mapper.icp=false", 12, 1.0 / 3.0);
  r.broken = {"score is 0.3, expected at least 0.5"};
  r.error = "quote \" and newline \n and \xff no UTF-8";
  r.score["aligned"] = true;
  r.score["psi_m"] = nullptr;
  const RunRecord again = from_line(to_line(r), "here");
  EXPECT_EQ(again.metric("score"), 1.0 / 3.0);
  EXPECT_EQ(again.metric("aligned"), 1.0);
  EXPECT_EQ(again.metric("completed"), 1.0);
  EXPECT_TRUE(std::isnan(again.metric("psi_m")));
  EXPECT_TRUE(std::isnan(again.metric("nothing")));
  EXPECT_EQ(again.seed, 12u);
  EXPECT_EQ(to_line(from_line(to_line(again), "here")), to_line(again));
  EXPECT_EQ(to_line(r).find('\n'), std::string::npos);
}

TEST_F(Results, ATornLastLineIsDroppedAtEveryLength) {
  append({record("a", "c", 1, 0.5), record("a", "c", 2, 0.6)});
  const std::string whole = lines();
  const std::size_t first = whole.find('\n') + 1;
  for (std::size_t cut = first; cut < whole.size(); cut += 7) {
    write("results.jsonl", whole.substr(0, cut));
    EXPECT_EQ(load_lines(folder_).size(), 1u) << cut;
    EXPECT_EQ(lines().size(), cut) << "reading changes nothing";
    EXPECT_EQ(ResultsFile(folder_, "").records().size(), 1u);
    EXPECT_EQ(lines(), whole.substr(0, first)) << "writing goes on after the last whole line";
  }
  write("results.jsonl", whole.substr(0, first) + std::string(50, '\0') + "\n");
  EXPECT_EQ(ResultsFile(folder_, "").records().size(), 1u) << "zeros of a lost block";
}

TEST_F(Results, AForeignLineBeforeTheLastIsNamed) {
  append({record("a", "c", 1, 0.5)});
  write("results.jsonl", "what is this\n" + lines());
  try {
    load_lines(folder_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("results.jsonl:1: "));
  }
}

/// A line of somebody else: `score` in place of the run's.
std::string with_score(const std::string& score) {
  const std::string line = to_line(record("a", "c", 1, 0.5));
  const std::size_t from = line.find("\"score\":{"), to = line.find("},", from);
  return line.substr(0, from) + "\"score\":" + score + line.substr(to + 1);
}

TEST_F(Results, AScoreThatIsNoneIsNoLine) {
  EXPECT_EQ(from_line(with_score("{\"score\": 0.25}"), "here").metric("score"), 0.25);
  // Whatever walks over this value later would use up the stack.
  EXPECT_THROW(from_line(with_score("{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}"), "here"),
               InputError);
  std::string keys;
  for (int i = 0; i < 100000; ++i) keys += "\"k" + std::to_string(i) + "\":0,";
  EXPECT_THROW(from_line(with_score("{" + keys + "\"score\":1}"), "here"), InputError) << "takes their square in time";
  for (const char* seed : {"1.5", "1e300", "-1", "\"1\""}) {
    std::string line = to_line(record("a", "c", 7, 0.5));
    line.replace(line.find("\"seed\":7"), 8, std::string("\"seed\":") + seed);
    EXPECT_THROW(from_line(line, "here"), InputError) << seed;
  }
}

TEST_F(Results, AHundredThousandRunsAreNoTooLargeFile) {
  append({record("a", "c", 1, 0.5)});
  std::filesystem::resize_file(path("results.jsonl"),
                               std::size_t{300} << 20);  // they take so much; here a last line that is torn
  EXPECT_EQ(load_lines(folder_).size(), 1u);
}

TEST_F(Results, TimesAreKeptApart) {
  append({record("a", "c", 1, 0.5)});
  EXPECT_EQ(lines().find("wall_s"), std::string::npos);
  EXPECT_EQ(load_timing(folder_).at("a-c-1")["wall_s"], 1.5);
}

TEST_F(Results, AFullDiskLeavesWholeLinesOnly) {
  append({record("a", "c", 1, 0.5)});
  const std::string before = lines();
  const pid_t child = fork();
  if (child == 0) {  // the limit of file size stands for a full disk; in a process of its own, for it stays
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{before.size() + 40, before.size() + 40};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      append({record("a", "c", 2, 0.6)});
    } catch (const RunError& error) {
      _exit(std::string(error.what()).find("free some space") == std::string::npos ? 2 : 0);
    }
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(lines(), before);
  append({record("a", "c", 2, 0.6)});
  EXPECT_EQ(load_lines(folder_).size(), 2u);
}

TEST_F(Results, TwoProcessesCannotWriteOneFile) {
  const ResultsFile held(folder_, "");
  const pid_t child = fork();
  if (child == 0) {
    try {
      const ResultsFile second(folder_, "");
    } catch (const InputError& error) {
      _exit(std::string(error.what()).find("another rubble") == std::string::npos ? 2 : 0);
    }
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(Results, OneRecordARunStands) {
  RunRecord failed = record("a", "c", 1, 0.0);
  failed.status = RunStatus::Failed;
  const RunRecord good = record("a", "c", 1, 0.5), other = record("a", "b", 9, 0.1);
  const auto unique = unique_runs({good, failed, good, other}, "test");
  ASSERT_EQ(unique.size(), 2u);
  EXPECT_EQ(unique[0].configuration, "b");
  EXPECT_TRUE(unique[1].ok());
  EXPECT_THROW(unique_runs({good, record("a", "c", 1, 0.6)}, "test"), InputError);
}

TEST_F(Results, AFolderWithoutResultsIsNamed) { EXPECT_THROW(load_lines(folder_), InputError); }

}  // namespace
}  // namespace rubble::scenarios
