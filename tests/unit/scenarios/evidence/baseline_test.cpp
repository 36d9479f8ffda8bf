#include "scenarios/evidence/baseline.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "base/text/text_file.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using testing::HasSubstr;

class BaselineFile : public FolderTest {
 protected:
  static std::vector<RunRecord> runs(double shift, double noise = 0.0, std::uint64_t noise_seed = 0) {
    Rng rng(noise_seed, "baseline test");
    std::vector<RunRecord> runs;
    for (const char* configuration : {"one", "two"})
      for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const double score = 0.75 + 0.08 * std::sin(static_cast<double>(seed) * 78.233) + shift + rng.gaussian(noise);
        RunRecord r = record("yellow", configuration, seed, score);
        r.score["psi_m"] = 0.2 - 0.1 * shift;
        runs.push_back(r);
      }
    return runs;
  }
  static std::vector<std::string> failed(const std::vector<CheckCase>& cases) {
    std::vector<std::string> names;
    for (const auto& c : cases)
      if (!c.passed) names.push_back(c.group + ": " + c.name);
    return names;
  }
};

TEST_F(BaselineFile, ReadsBackToItself) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  save_baseline(baseline, path("b.json"));
  const Baseline again = load_baseline(path("b.json"));
  save_baseline(again, path("c.json"));
  EXPECT_EQ(read(path("b.json")), read(path("c.json")));
  ASSERT_EQ(again.groups.size(), 2u);
  EXPECT_EQ(again.groups[0].seeds.size(), 12u);
  EXPECT_EQ(again.groups[0].metrics[0].key, "score");
}

TEST_F(BaselineFile, NothingChangedRaisesNoAlarm) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  for (int repetition = 0; repetition < 20; ++repetition)
    EXPECT_THAT(failed(check_runs(baseline, runs(0.0))), testing::IsEmpty());
}

TEST_F(BaselineFile, ANeutralChangeThatMovesEveryRunRaisesNoAlarm) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  int alarms = 0;
  for (std::uint64_t change = 1; change <= 20; ++change)
    alarms += failed(check_runs(baseline, runs(0.0, 0.02, change))).empty() ? 0 : 1;
  EXPECT_EQ(alarms, 0);
}

TEST_F(BaselineFile, AWorseMedianIsARegressionAndABetterIsNot) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  EXPECT_THAT(failed(check_runs(baseline, runs(-0.15))),
              testing::ElementsAre("yellow / one: score", "yellow / one: psi [m]", "yellow / two: score",
                                   "yellow / two: psi [m]"));
  EXPECT_THAT(failed(check_runs(baseline, runs(+0.15))), testing::IsEmpty());
}

TEST_F(BaselineFile, AFewRuinedRunsAreARegressionThoughTheMedianStands) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  std::vector<RunRecord> ruined = runs(0.0);
  for (std::size_t i = 0; i < 3; ++i) ruined[i].score["score"] = 0.2;
  EXPECT_THAT(failed(check_runs(baseline, ruined)), testing::ElementsAre("yellow / one: score"));
}

TEST_F(BaselineFile, RunsThatLoseANumberAreARegression) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  std::vector<RunRecord> poorer = runs(0.0);
  poorer[0].score["psi_m"] = nullptr;
  EXPECT_THAT(failed(check_runs(baseline, poorer)), testing::ElementsAre("yellow / one: psi [m]"));
}

TEST_F(BaselineFile, FailedRunsBrokenExpectationsAndLostMetricsAreRegressions) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  auto now = runs(0.0);
  now[0].status = RunStatus::TimedOut;
  now[3].broken = {"score is 0.2, expected at least 0.5"};
  for (auto& r : now)
    if (r.configuration == "two") r.score->erase("psi_m");
  const auto cases = check_runs(baseline, now);
  EXPECT_THAT(failed(cases), testing::ElementsAre("yellow / one: runs completed", "yellow / one: expectations",
                                                  "yellow / two: psi [m]"));
  EXPECT_EQ(failures(cases), 3u);
}

TEST_F(BaselineFile, OtherSeedsOrConfigurationsAreNoRegressionButAnError) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  auto fewer = runs(0.0);
  fewer.pop_back();
  EXPECT_THROW(check_runs(baseline, fewer), InputError);
  fewer.erase(fewer.begin() + 12, fewer.end());
  EXPECT_THROW(check_runs(baseline, fewer), InputError);
  auto more = runs(0.0);
  more.push_back(record("yellow", "three", 1, 0.5));
  EXPECT_THROW(check_runs(baseline, more), InputError);
}

TEST_F(BaselineFile, ForeignFilesAreNamed) {
  EXPECT_THROW(load_baseline(path("nowhere.json")), InputError);
  EXPECT_THROW(load_baseline(write("x.json", "{\"sweep\": 3}")), InputError);
  EXPECT_THROW(load_baseline(write("y.json", "not json")), InputError);
}

TEST_F(BaselineFile, ABombIsRefusedAtOnce) {
  const auto refused = [&](const std::string& text) {
    try {
      load_baseline(write("bomb.json", text));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_THAT(refused(std::string(20000000, '[')), HasSubstr("64 levels"));  // once 1.6 GB
  std::string keys = "{";
  for (int i = 0; i < 300000; ++i) keys += "\"k" + std::to_string(i) + "\":0,";
  EXPECT_THAT(refused(keys + "\"sweep\":1}"), HasSubstr("1000 keys"));  // once many minutes
}

TEST_F(BaselineFile, SeedsAndCountsAreWholeNumbers) {
  save_baseline(make_baseline("regression", runs(0.0)), path("b.json"));
  const std::string text = read_text_file(path("b.json"));
  for (const char* value : {"-1", "0.5", "1e300", "\"1\"", "null"}) {
    for (const char* key : {"\"failed\": ", "\"missing\": "}) {
      std::string wrong = text;
      const std::size_t from = wrong.find(key) + std::string(key).size();
      wrong.replace(from, 1, value);
      EXPECT_THROW(load_baseline(write("wrong.json", wrong)), InputError) << key << value;
    }
    std::string wrong = text;
    const std::size_t list = wrong.find("\"seeds\": [") + 10;
    wrong.insert(list, std::string(value) + ",");
    EXPECT_THROW(load_baseline(write("wrong.json", wrong)), InputError) << "seed " << value;
  }
}

TEST_F(BaselineFile, MisspeltKeysAreNamed) {
  save_baseline(make_baseline("regression", runs(0.0)), path("b.json"));
  for (const char* key : {"code", "failed", "mean_tolerance"}) {
    std::string text = read_text_file(path("b.json"));
    const std::string quoted = std::string("\"") + key + "\":";
    text.insert(text.find(quoted), std::string("\"") + key + "s\": 0, ");
    try {
      load_baseline(write("typo.json", text));
      ADD_FAILURE() << key;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string("unknown key '") + key + "s'"));
    }
  }
}

TEST_F(BaselineFile, WhetherItFitsIsKnownBeforeARunIsMade) {
  const Baseline baseline = make_baseline("regression", runs(0.0));
  std::vector<RunRecord> planned;
  for (const RunRecord& run : runs(0.0)) {
    planned.emplace_back();
    planned.back().scenario = run.scenario;
    planned.back().configuration = run.configuration;
    planned.back().seed = run.seed;
  }
  EXPECT_NO_THROW(require_fit(baseline, planned));
  Baseline foreign = baseline;
  foreign.groups[0].metrics[0].key = "beauty";
  EXPECT_THROW(require_fit(foreign, planned), InputError);
  planned.back().seed = 99;
  EXPECT_THROW(require_fit(baseline, planned), InputError);
}

/// A baseline of an older program, whose file does not say a version, is refused before runs are made and after.
TEST_F(BaselineFile, AnotherVersionOfTheScoreIsNoRegressionButAnError) {
  save_baseline(make_baseline("regression", runs(0.0)), path("b.json"));
  std::string text = read_text_file(path("b.json"));
  const std::string line = "  \"score_version\": " + std::to_string(scoring::kScoreVersion) + ",\n";
  ASSERT_NE(text.find(line), std::string::npos) << text;
  text.erase(text.find(line), line.size());
  const Baseline older = load_baseline(write("older.json", text));
  std::vector<RunRecord> planned = runs(0.0);
  for (RunRecord& run : planned) *run.score = nullptr;
  for (const auto& made : {planned, runs(0.0)}) try {
      require_fit(older, made);
      ADD_FAILURE() << "fits";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("score of version 1"));
      EXPECT_THAT(error.what(), HasSubstr("save the baseline again"));
    }
}

TEST_F(BaselineFile, ReportsCarryWhatFailed) {
  const auto cases = check_runs(make_baseline("regression", runs(0.0)), runs(-0.15));
  const std::string junit = to_junit(cases, "a & b");
  EXPECT_THAT(junit, HasSubstr("name=\"a &amp; b\" tests=\"8\" failures=\"4\""));
  EXPECT_THAT(junit, HasSubstr("<failure message=\"median"));
  EXPECT_THAT(to_github_annotations(cases), HasSubstr("::error title=Regression%3A score::yellow / one: median"));
  EXPECT_THAT(to_markdown(cases, "Check"), HasSubstr("4 of 8 checks passed"));
}

}  // namespace
}  // namespace rubble::scenarios
