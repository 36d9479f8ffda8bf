#include "scenarios/batch/sweep.h"
#include "slam/paper/paper_mapper.h"

#include <gmock/gmock.h>
#include <malloc.h>

#include <set>

#include "base/error.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class SweepFile : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    write("small.yaml", "name: small\narena: {generate: {columns: 3, rows: 3}}\nmapper: {kind: paper}\n");
    write("other.yaml", "name: other\narena: {generate: {columns: 4, rows: 3}}\nmapper: {kind: paper}\n");
  }
  Sweep sweep(const std::string& text) const { return load_sweep(write("sweep.yaml", text)); }
  std::vector<Job> jobs(const std::string& text) const { return expand(sweep(text), "code"); }
  std::string error_of(const std::string& text) const {
    try {
      jobs(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  static std::vector<std::string> ids(const std::vector<Job>& jobs) {
    std::vector<std::string> ids;
    for (const auto& job : jobs) ids.push_back(job.run_id);
    return ids;
  }
};

TEST_F(SweepFile, TheFirstSeedsOrOthersMayBeChosen) {
  Sweep some = sweep("scenarios: [small.yaml]\nseeds: [9, 1, 4-5]\n");
  choose_seeds(some, "9");
  EXPECT_THAT(some.seeds, ElementsAre(9, 1, 4, 5)) << "there are no more";
  choose_seeds(some, "3");
  EXPECT_THAT(some.seeds, ElementsAre(9, 1, 4));
  choose_seeds(some, "101-103");
  EXPECT_THAT(some.seeds, ElementsAre(101, 102, 103));
  for (const char* bad : {"", "0", "-3", "3-", "8-1", "six", "1,2", "1000001", "1-1000001"}) {
    EXPECT_THROW(choose_seeds(some, bad), std::invalid_argument) << bad;
    EXPECT_THAT(some.seeds, ElementsAre(101, 102, 103)) << bad;
  }
  Sweep two = sweep("scenarios: [small.yaml]\nseeds: 1\nset: {robot.levelling: [false, true]}\n");
  EXPECT_NO_THROW(choose_seeds(two, "1-500000"));
  EXPECT_THROW(choose_seeds(two, "1-500001"), std::invalid_argument) << "a million runs";
}

TEST_F(SweepFile, SeedsAreARangeAListOrOne) {
  EXPECT_THAT(sweep("scenarios: [small.yaml]\nseeds: 2-5\n").seeds, ElementsAre(2, 3, 4, 5));
  EXPECT_THAT(sweep("scenarios: [small.yaml]\nseeds: [9, 1, 4-5]\n").seeds, ElementsAre(9, 1, 4, 5));
  EXPECT_THAT(sweep("scenarios: [small.yaml]\nseeds: 7\n").seeds, ElementsAre(7));
}

TEST_F(SweepFile, GridAndNamedSetsMultiply) {
  const Sweep s = sweep(
      "scenarios: [small.yaml, other.yaml]\nseeds: 1-3\n"
      "configs: {paper: {mapper.icp: false}, ours: {}}\n"
      "set: {mapper.particles: [50, 300], robot.levelling: [true, false], mapper.resolution_m: 0.1}\n");
  ASSERT_EQ(s.configurations.size(), 8u);
  EXPECT_EQ(s.configurations[0].name, "paper, mapper.particles=50, robot.levelling=true");
  EXPECT_EQ(s.configurations[7].name, "ours, mapper.particles=300, robot.levelling=false");
  const auto all = expand(s, "code");
  ASSERT_EQ(all.size(), 2u * 8u * 3u);
  EXPECT_EQ(all[0].scenario().name, "small");
  EXPECT_EQ(all[0].seed, 1u);
  EXPECT_FALSE(all[0].scenario().mapper.as<slam::PaperConfig>().icp);
  EXPECT_EQ(all[0].scenario().mapper.as<slam::PaperConfig>().particles, 50);
  EXPECT_EQ(all[0].scenario().mapper.as<slam::PaperConfig>().resolution, 0.1)
      << "a single value sets the key without lengthening the names";
  EXPECT_FALSE(all[23].scenario().levelling.on);
  EXPECT_EQ(all[47].scenario().name, "other");
  EXPECT_EQ(all[47].seed, 3u);
}

TEST_F(SweepFile, ConfigurationsAreMeasuredAgainstTheFirstValueOfTheFirstKeyAllElseEqual) {
  const auto grid =
      sweep("scenarios: [small.yaml]\nseeds: 1\nset: {robot.levelling: [false, true], mapper.particles: [50, 300]}\n");
  for (const auto& c : grid.configurations)
    EXPECT_EQ(c.reference, "robot.levelling=false" + c.name.substr(c.name.find(',')));
  const auto sets = sweep(
      "scenarios: [small.yaml]\nseeds: 1\nconfigs: {ours: {}, paper: {mapper.icp: true}}\nset: {mapper.particles: [50, "
      "300]}\n");
  EXPECT_EQ(sets.configurations[3].name, "paper, mapper.particles=300");
  EXPECT_EQ(sets.configurations[3].reference, "ours, mapper.particles=300");
}

TEST_F(SweepFile, WithoutSetsThereIsOneDefaultConfiguration) {
  const auto all = jobs("scenarios: [small.yaml]\nseeds: 1-2\n");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].kind->configuration, "default");
}

TEST_F(SweepFile, IdsNameEverythingThatDecidesARun) {
  const std::string text = "scenarios: [small.yaml]\nseeds: 1-20\nset: {mapper.particles: [50, 300]}\n";
  const Sweep s = sweep(text);
  const auto first = ids(expand(s, "code"));
  EXPECT_EQ(std::set<std::string>(first.begin(), first.end()).size(), 40u) << "no two runs share an id";
  EXPECT_EQ(first, ids(expand(s, "code"))) << "the same sweep gives the same ids";
  EXPECT_NE(first[0], ids(expand(s, "other code"))[0]);
  EXPECT_NE(first[0], ids(expand(s, "code", {{"mapper.icp", "false"}}))[0]);
  EXPECT_EQ(first[0].size(), 16u);
  const auto fewer = ids(jobs("scenarios: [small.yaml]\nseeds: 3\nset: {mapper.particles: [50, 300]}\n"));
  EXPECT_EQ(fewer[0], first[2]) << "an id does not depend on what else is in the sweep";
}

TEST_F(SweepFile, AnIdFollowsTheContentOfAnArenaFileNotItsPlace) {
  const std::string arena = "name: one", scenario = "name: drawn\narena: {file: arena.yaml}\n";
  write("a/arena.yaml", arena), write("a/drawn.yaml", scenario);
  write("b/arena.yaml", arena), write("b/drawn.yaml", scenario);
  write("c/arena.yaml", "name: two"), write("c/drawn.yaml", scenario);
  const auto id = [&](const std::string& where) {
    return jobs("scenarios: [" + where + "/drawn.yaml]\nseeds: 1\n")[0].run_id;
  };
  EXPECT_EQ(id("a"), id("b"));
  EXPECT_NE(id("a"), id("c"));
}

TEST_F(SweepFile, ShardsAreDisjointAndCoverTheSweep) {
  const auto all = jobs("scenarios: [small.yaml, other.yaml]\nseeds: 1-30\n");
  std::multiset<std::string> parts;
  for (int i = 1; i <= 7; ++i)
    for (const auto& job : in_shard(all, {i, 7})) parts.insert(job.run_id);
  const auto whole = ids(all);
  EXPECT_EQ(parts, std::multiset<std::string>(whole.begin(), whole.end()));
  EXPECT_EQ(ids(in_shard(all, {1, 1})), whole);
}

TEST_F(SweepFile, FoldersOfRunsAreReadableAndUnique) {
  std::set<std::string> folders;
  const auto all =
      jobs("scenarios: [small.yaml]\nseeds: 1-3\nset: {mapper.particles: [50, 300], robot.levelling: [true, false]}\n");
  for (const auto& job : all) {
    folders.insert(job.folder());
    EXPECT_EQ(job.folder().find_first_of("/ ,"), std::string::npos) << job.folder();
    EXPECT_THAT(job.folder(), HasSubstr("small-"));
  }
  EXPECT_EQ(folders.size(), all.size());
}

TEST_F(SweepFile, AFolderSaysYellowOfNoOrangeArenaAndNoKindTwice) {
  write("yellow.yaml", "name: yellow\narena: {generate: {columns: 3, rows: 3}}\n");
  const auto folder = [&](const std::string& configs) {
    return jobs("scenarios: [yellow.yaml]\nseeds: 1-1\n" + configs).at(0).folder();
  };
  EXPECT_THAT(folder(""), StartsWith("yellow-default-seed1-"));
  EXPECT_THAT(folder("configs: {yellow: {time_limit_s: 9}}\n"), StartsWith("yellow-seed1-"));
  EXPECT_THAT(folder("configs: {orange: {arena.generate.kind: orange}}\n"), StartsWith("orange-seed1-"));
  EXPECT_THAT(folder("configs: {orange-deaf: {arena.generate.kind: orange}}\n"), StartsWith("orange-deaf-seed1-"));
  EXPECT_THAT(folder("configs: {orange: {arena.generate.kind: orange}}\nset: {time_limit_s: [8, 9]}\n"),
              StartsWith("orange__time_limit_s=8-seed1-"));
  EXPECT_THAT(folder("configs: {yellowish: {time_limit_s: 9}}\n"), StartsWith("yellow-yellowish-seed1-"));
  EXPECT_THAT(folder("configs: {usual: {arena.generate.kind: red}}\n"), StartsWith("red-usual-seed1-"));
  const auto all = jobs("scenarios: [yellow.yaml]\nseeds: 1-1\nconfigs: {orange: {arena.generate.kind: orange}}\n");
  EXPECT_EQ(all.at(0).kind->scenario.name, "yellow") << "results are paired by it";
}

TEST_F(SweepFile, ShippedScenariosAreKnownByName) {
  write("shipped/yellow.yaml", "name: yellow\narena: {generate: {columns: 3, rows: 3}}\n");
  const Sweep s = load_sweep(write("sweep.yaml", "scenarios: [yellow]\nseeds: 1\n"), path("shipped"));
  EXPECT_EQ(expand(s, "code")[0].scenario().name, "yellow");
}

TEST_F(SweepFile, FaultsAreNamedWithPlaceAndRemedy) {
  EXPECT_THAT(error_of("scenarios: [small.yaml]\n"), HasSubstr("seeds: 1-24"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 5-2\n"), HasSubstr("sweep.yaml:2:1"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: [1, x]\n"), HasSubstr("'x'"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: [1, 3, 1-2]\n"), HasSubstr("seed 1 is there twice"));
  EXPECT_THAT(error_of("seeds: 1-2\n"), HasSubstr("scenarios"));
  EXPECT_THAT(error_of("scenarios: [nowhere.yaml]\nseeds: 1\n"), HasSubstr("nowhere.yaml"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nsedes: 1\n"), HasSubstr("seeds"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nset: {mapper.icp: []}\n"), HasSubstr("no values"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nset: {seed: [1, 2]}\n"), HasSubstr("'seeds'"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nset: {mapper.particles: [5, 5]}\n"), HasSubstr("twice"));
  EXPECT_THAT(error_of("scenarios: [small.yaml, small.yaml]\nseeds: 1\n"),
              HasSubstr("two scenarios are named 'small'"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nconfigs: {bad: {mapper.icpp: 1}}\n"),
              HasSubstr("sweep.yaml:3:17: unknown key 'icpp'"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nset: {mapper.kind: [paper, papr]}\n"),
              HasSubstr("sweep.yaml:3:7: 'kind' is 'papr'"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nconfigs: {bad: {mapper.icpp: 1}}\n"), HasSubstr("'bad'"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nconfigs: {bad: {mapper.icpp: 1}}\n"), HasSubstr("icp"));
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 0-99999999\n"), HasSubstr("million"));
}

// Each of these once took gigabytes before it was counted.
TEST_F(SweepFile, WhatIsTooMuchIsSaidBeforeItIsMade) {
  std::string ranges;
  for (int i = 0; i < 100; ++i)
    ranges += (i > 0 ? ", " : "") + std::to_string(i * 1000000) + "-" + std::to_string(i * 1000000 + 999999);
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: [" + ranges + "]\n"), HasSubstr("more than a million seeds"));
  std::string values = "1";
  for (int i = 2; i <= 1000; ++i) values += ", " + std::to_string(i);
  std::string grid;
  for (const char* key : {"time_limit_s", "mapper.particles", "mapper.icp"})
    grid += "  " + std::string(key) + ": [" + values + "]\n";
  EXPECT_THAT(error_of("scenarios: [small.yaml]\nseeds: 1\nset:\n" + grid), HasSubstr("more than a million config"));
  const std::string million = "  time_limit_s: [" + values + "]\n  mapper.particles: [" + values + "]\n";
  EXPECT_THAT(
      error_of("scenarios: [small.yaml]\nseeds: 1\nset:\n" + million + "  team: " + std::string(10000, 'x') + "\n"),
      HasSubstr("more than 1 GB"));
}

TEST_F(SweepFile, ASeedTakesNoScenarioOfItsOwn) {
  const Sweep many = sweep("scenarios: [small.yaml]\nseeds: 1-4000\n");
  const auto in_use = [] {
    const auto heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
  };
  const std::size_t before = in_use();
  const auto all = expand(many, "code");
  const auto shard = in_shard(all, {1, 1});
  EXPECT_LT(in_use() - before, 2 * 200 * all.size()) << "[bytes] a million of them are 200 MB";
  EXPECT_EQ(shard.back().scenario().seed, 4000u);
}

}  // namespace
}  // namespace rubble::scenarios
