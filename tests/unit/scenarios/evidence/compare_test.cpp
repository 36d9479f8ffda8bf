#include "scenarios/evidence/compare.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "scenarios/evidence/compare_output.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using testing::HasSubstr;

/// `count` runs whose score is drawn by `draw(seed)`.
template <class Draw>
ResultSet runs(const std::string& configuration, std::uint64_t count, const Draw& draw) {
  ResultSet set;
  for (std::uint64_t seed = 1; seed <= count; ++seed)
    set.runs.push_back(record("yellow", configuration, seed, draw(seed)));
  return set;
}

const MetricComparison& metric(const Comparison& c, const std::string& key, std::size_t group = 0) {
  const auto& metrics = c.groups.at(group).metrics;
  const auto found = std::find_if(metrics.begin(), metrics.end(), [&](const auto& m) { return m.metric.key == key; });
  if (found == metrics.end()) throw std::runtime_error("no metric " + key);
  return *found;
}

/// Scores of an arena vary far more from seed to seed than a change makes: 0.1 against 0.02.
double arena_score(std::uint64_t seed) { return 0.7 + 0.1 * std::sin(static_cast<double>(seed) * 12.9898); }

TEST(Compare, PairingFindsASmallChangeInALargeSpread) {
  Rng rng(3, "test");
  const ResultSet a = runs("c", 24, arena_score);
  const ResultSet b = runs("c", 24, [&](std::uint64_t seed) { return arena_score(seed) + 0.02 + rng.gaussian(0.01); });
  const MetricComparison c = metric(compare(a, b, "A", "B"), "score");
  EXPECT_EQ(c.verdict, Verdict::Better);
  EXPECT_EQ(c.pairs, 24u);
  EXPECT_NEAR(c.difference, 0.02, 0.006);
  EXPECT_LT(c.interval.low, c.difference);
  EXPECT_GT(c.interval.low, 0.0);
  EXPECT_EQ(metric(compare(b, a, "B", "A"), "score").verdict, Verdict::Worse);
}

TEST(Compare, AFewLargeGainsAgainstManySmallLossesAreNoEvidence) {
  const ResultSet a = runs("c", 24, arena_score);
  const ResultSet b =
      runs("c", 24, [](std::uint64_t seed) { return arena_score(seed) + (seed % 4 == 0 ? 0.2 : -0.001); });
  const MetricComparison c = metric(compare(a, b, "A", "B"), "score");
  EXPECT_GT(c.interval.low, 0.0);
  EXPECT_LE(c.p_sign, 0.05);
  EXPECT_EQ(c.verdict, Verdict::NoEvidence);
}

TEST(Compare, ScoresOfOtherVersionsAreRefusedByName) {
  const ResultSet now = runs("c", 4, arena_score);
  ResultSet before = now;
  for (RunRecord& run : before.runs) run.score["score_version"] = 1;
  try {
    compare(before, now, "A", "B");
    ADD_FAILURE() << "compared";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("A has a score of version 1, B a score of version"));
  }
  EXPECT_NO_THROW(compare(before, before, "A", "B"));
  for (RunRecord& run : before.runs) run.score["score"] = nullptr;
  EXPECT_NO_THROW(compare(before, now, "A", "B")) << "logs without truth have no score";
}

TEST(Compare, AScoreVersionThatIsNoNumberIsNamedAsWhatItIs) {
  const ResultSet now = runs("c", 4, arena_score);
  ResultSet before = now;
  before.runs.front().score["score_version"] = "3";
  try {
    compare(before, now, "A", "B");
    ADD_FAILURE() << "compared";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has a score_version that is no whole number (\"3\")"));
  }
}

TEST(Compare, TheSameResultsAreIdentical) {
  const ResultSet a = runs("c", 10, arena_score);
  const auto comparison = compare(a, a, "A", "A");
  for (const auto& c : comparison.groups[0].metrics) EXPECT_EQ(c.verdict, Verdict::Identical);
}

TEST(Compare, WithoutAnEffectItRarelySpeaks) {
  int spoke = 0;
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    Rng rng(trial, "no effect");
    const auto noisy = [&](std::uint64_t seed) { return arena_score(seed) + rng.gaussian(0.05); };
    const ResultSet a = runs("c", 12, noisy), b = runs("c", 12, noisy);
    spoke += metric(compare(a, b, "A", "B"), "score").verdict != Verdict::NoEvidence ? 1 : 0;
  }
  EXPECT_LE(spoke, 10) << "5 % of 100, and its spread";
}

TEST(Compare, FiveSeedsAreNoEvidence) {
  const ResultSet a = runs("c", 5, arena_score);
  const ResultSet b = runs("c", 5, [](std::uint64_t seed) { return arena_score(seed) + 0.1; });
  EXPECT_EQ(metric(compare(a, b, "A", "B"), "score").verdict, Verdict::NoEvidence);
}

TEST(Compare, LowerErrorsAreBetter) {
  ResultSet a = runs("c", 10, arena_score), b = a;
  for (auto& r : a.runs) r.score["psi_m"] = 0.3 + 0.001 * static_cast<double>(r.seed);
  for (auto& r : b.runs) r.score["psi_m"] = 0.2;
  const MetricComparison c = metric(compare(a, b, "A", "B"), "psi_m");
  EXPECT_EQ(c.verdict, Verdict::Better);
  EXPECT_LT(c.difference, 0.0);
  EXPECT_EQ(c.better, 10u);
}

TEST(Compare, NumbersWithoutADirectionAreOnlyHigherOrLower) {
  ResultSet a = runs("c", 10, arena_score), b = a;
  for (auto& r : a.runs) r.score["scans"] = 100;
  for (auto& r : b.runs) r.score["scans"] = 100 + r.seed;
  CompareOptions all;
  all.all_metrics = true;
  EXPECT_EQ(metric(compare(a, b, "A", "B", all), "scans").verdict, Verdict::Higher);
  EXPECT_THROW(metric(compare(a, b, "A", "B"), "scans"), std::runtime_error);
}

TEST(Compare, FailedRunsCountAsNotCompleted) {
  ResultSet a = runs("c", 10, arena_score), b = a;
  for (auto& r : b.runs) {
    r.status = RunStatus::TimedOut;
    r.score->clear();
  }
  const Comparison c = compare(a, b, "A", "B");
  EXPECT_EQ(metric(c, "completed").verdict, Verdict::Worse);
  EXPECT_THROW(metric(c, "score"), std::runtime_error) << "no pair has it";
  b.runs[0] = a.runs[0];
  EXPECT_EQ(metric(compare(a, b, "A", "B"), "score").pairs, 1u);
  EXPECT_EQ(metric(compare(a, b, "A", "B"), "score").missing, 9u);
}

TEST(Compare, ConfigurationsOnOneArenaAreOnePieceOfEvidence) {
  ResultSet a, b;
  for (const char* configuration : {"c1", "c2", "c3", "c4"})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      a.runs.push_back(record("yellow", configuration, seed, 0.5));
      b.runs.push_back(record("yellow", configuration, seed, 0.6));
    }
  const MetricComparison c = metric(compare(a, b, "A", "B"), "score");
  EXPECT_EQ(c.pairs, 3u);
  EXPECT_EQ(c.verdict, Verdict::NoEvidence) << "12 runs, but three arenas";
}

TEST(Compare, ConfigurationsOfOneSweepArePairedByName) {
  ResultSet set = runs("on", 12, arena_score);
  const ResultSet off = runs("off", 12, [](std::uint64_t seed) { return arena_score(seed) - 0.05; });
  set.runs.insert(set.runs.end(), off.runs.begin(), off.runs.end());
  CompareOptions options;
  options.configuration_a = "off";
  options.configuration_b = "on";
  const Comparison c = compare(set, set, "sweep", "sweep", options);
  EXPECT_EQ(metric(c, "score").verdict, Verdict::Better);
  EXPECT_THAT(c.b, HasSubstr("on"));
  options.configuration_b = "onn";
  try {
    compare(set, set, "sweep", "sweep", options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'off', 'on'"));
  }
}

TEST(Compare, EachConfigurationCanBeShown) {
  ResultSet a = runs("one", 8, arena_score), b = a;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    a.runs.push_back(record("yellow", "two", seed, 0.5));
    b.runs.push_back(record("yellow", "two", seed, 0.4));
  }
  CompareOptions options;
  options.by_configuration = true;
  const Comparison c = compare(a, b, "A", "B", options);
  ASSERT_EQ(c.groups.size(), 3u);
  EXPECT_EQ(metric(c, "score", 1).verdict, Verdict::Identical);
  EXPECT_EQ(metric(c, "score", 2).verdict, Verdict::Worse);
}

TEST(Compare, UnpairedRunsAreCountedAndNothingInCommonIsAnError) {
  const ResultSet a = runs("c", 10, arena_score), b = runs("c", 7, arena_score), d = runs("d", 7, arena_score);
  const Comparison c = compare(a, b, "A", "B");
  EXPECT_EQ(c.pairs, 7u);
  EXPECT_EQ(c.only_a, 3u);
  EXPECT_EQ(c.only_b, 0u);
  EXPECT_THROW(compare(a, d, "A", "D"), InputError);
}

TEST(Compare, EveryFormSaysTheSame) {
  const ResultSet a = runs("c", 12, arena_score);
  const ResultSet b = runs("c", 12, [](std::uint64_t seed) { return arena_score(seed) - 0.05; });
  const Comparison c = compare(a, b, "old, \"quoted\"", "<new>");
  EXPECT_THAT(to_text(c), HasSubstr("worse"));
  EXPECT_THAT(to_csv(c), HasSubstr("all,score,12,0,"));
  const auto json = nlohmann::json::parse(to_json(c));
  EXPECT_EQ(json["groups"][0]["metrics"]["score"]["verdict"], "worse");
  EXPECT_NEAR(json["groups"][0]["metrics"]["score"]["difference"].get<double>(), -0.05, 1e-12);
  EXPECT_THAT(to_html(c), HasSubstr("&lt;new&gt;"));
  EXPECT_THAT(to_html(c), HasSubstr("class=worse>worse"));
  EXPECT_THAT(to_markdown(c), HasSubstr("| worse |"));
}

}  // namespace
}  // namespace rubble::scenarios
