#include "scenarios/batch/merge.h"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "base/error.h"
#include "base/rng.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

class Merge : public FolderTest {
 protected:
  void batch(const std::string& folder, const std::string& suffix, const std::vector<RunRecord>& records) const {
    std::filesystem::create_directories(path(folder));
    ResultsFile file(path(folder), suffix);
    for (const auto& r : records) file.append(r, {{"wall_s", 2.5}, {"broken", {"x"}}});
  }
  /// The first column of the first row.
  std::string query(const std::string& file, const char* sql) const {
    sqlite3* db = nullptr;
    sqlite3_open(path(file).c_str(), &db);
    std::string answer;
    sqlite3_exec(
        db, sql,
        [](void* to, int, char** columns, char**) {
          *static_cast<std::string*>(to) = columns[0] ? columns[0] : "null";
          return 0;
        },
        &answer, nullptr);
    sqlite3_close(db);
    return answer;
  }
};

TEST_F(Merge, GivesTheSameBytesInAnyOrderAndAnyNumberOfTimes) {
  std::vector<RunRecord> all;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    all.push_back(record("a", "c", seed, 1.0 / static_cast<double>(seed)));
  batch("whole", "", all);
  batch("one", "-1of2", {all.begin(), all.begin() + 7});
  batch("two", "-2of2", {all.begin() + 7, all.end()});
  EXPECT_EQ(merge({path("whole")}, path("whole.sqlite")).added, 20u);
  const std::string bytes = read(path("whole.sqlite"));
  merge({path("two"), path("one")}, path("parts.sqlite"));
  EXPECT_EQ(read(path("parts.sqlite")), bytes);
  EXPECT_EQ(merge({path("two"), path("one")}, path("parts.sqlite")).added, 0u);
  EXPECT_EQ(read(path("parts.sqlite")), bytes);
  EXPECT_EQ(merge({path("one")}, path("steps.sqlite")).runs, 7u);
  EXPECT_EQ(merge({path("two")}, path("steps.sqlite")).runs, 20u) << "what is there stays";
  EXPECT_EQ(read(path("steps.sqlite")), bytes);
}

TEST_F(Merge, WhatGoesInComesOut) {
  RunRecord odd = record("a", "x='1', \"y\"", 3, 0.25);
  odd.score["aligned"] = true;
  odd.score["align_note"] = "it's fine";
  odd.score["psi_m"] = nullptr;
  odd.broken = {"score is 0.25, expected at least 0.5"};
  RunRecord failed = record("a", "c", 4, 0.0);
  failed.status = RunStatus::TimedOut;
  batch("out", "", {odd, failed});
  merge({path("out")}, path("all.sqlite"));
  const ResultSet lines = load_results(path("out")), table = load_results(path("all.sqlite"));
  ASSERT_EQ(table.runs.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(to_line(table.runs[i]), to_line(lines.runs[i]));
  EXPECT_EQ(table.timing.at(odd.run_id)->at("wall_s"), 2.5);
}

TEST_F(Merge, AnybodyCanQueryIt) {
  RunRecord r = record("a", "c", 1, 0.5);
  r.score["aligned"] = true;
  r.score["note"] = "text";
  batch("out", "", {r, record("a", "c", 2, 0.25)});
  merge({path("out")}, path("all.sqlite"));
  EXPECT_EQ(query("all.sqlite", "SELECT count(*) FROM runs WHERE status = 'ok'"), "2");
  EXPECT_EQ(query("all.sqlite", "SELECT avg(value) FROM metrics WHERE key = 'score'"), "0.375");
  EXPECT_EQ(query("all.sqlite", "SELECT value FROM metrics WHERE key = 'aligned'"), "1.0");
  EXPECT_EQ(query("all.sqlite", "SELECT count(*) FROM metrics WHERE key = 'note'"), "0");
  EXPECT_EQ(query("all.sqlite", "PRAGMA integrity_check"), "ok");
}

TEST_F(Merge, DifferentResultsOfOneRunAreRefused) {
  batch("one", "", {record("a", "c", 1, 0.5)});
  batch("two", "", {record("a", "c", 1, 0.6)});
  merge({path("one")}, path("all.sqlite"));
  const std::string bytes = read(path("all.sqlite"));
  EXPECT_THROW(merge({path("two")}, path("all.sqlite")), InputError);
  EXPECT_EQ(read(path("all.sqlite")), bytes);
}

/// Runs of before versions existed are of version 1.
TEST_F(Merge, ScoresOfOtherVersionsAreRefusedByName) {
  RunRecord old = record("a", "c", 1, 0.5);
  old.score->erase("score_version");
  batch("old", "", {old});
  batch("new", "", {record("a", "c", 2, 0.6)});
  RunRecord without = record("a", "c", 3, 0.0);
  *without.score = {{"aligned", false}};
  batch("without", "", {without});
  EXPECT_EQ(merge({path("old"), path("without")}, path("all.sqlite")).runs, 2u) << "no score, no version";
  const std::string bytes = read(path("all.sqlite"));
  const auto refusal = [&](const std::vector<std::string>& sources, const std::string& out) -> std::string {
    try {
      merge(sources, out);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string into = refusal({path("new")}, path("all.sqlite"));
  EXPECT_NE(into.find("all.sqlite has a score of version 1"), std::string::npos) << into;
  EXPECT_NE(into.find("new a score of version " + std::to_string(scoring::kScoreVersion)), std::string::npos) << into;
  EXPECT_EQ(into.find('\n'), std::string::npos);
  EXPECT_EQ(read(path("all.sqlite")), bytes);
  EXPECT_NE(refusal({path("new"), path("without"), path("old")}, path("other.sqlite")), "");
  batch("both", "", {old, record("a", "c", 2, 0.6)});
  const std::string within = refusal({path("both")}, path("third.sqlite"));
  EXPECT_NE(within.find("both: run " + old.run_id), std::string::npos) << within;
}

TEST_F(Merge, ForeignFilesAreRefusedAndKept) {
  write("notes.txt", "mine");
  batch("one", "", {record("a", "c", 1, 0.5)});
  EXPECT_THROW(merge({path("one")}, path("notes.txt")), InputError);
  EXPECT_EQ(read(path("notes.txt")), "mine");
  EXPECT_THROW(load_results(path("nowhere")), InputError);
  EXPECT_THROW(load_results(path("notes.txt")), InputError);
  EXPECT_THROW(load_results(write("fake.sqlite", std::string("SQLite format 3\0garbage", 23))), InputError);
  EXPECT_THROW(merge({path("one")}, path("nowhere/all.sqlite")), RunError);
}

/// Whose file it is decides nothing: what computes, ends nowhere or holds more than its bytes is refused, and a file
/// that grew an index or a view of somebody's own is still read.
TEST_F(Merge, ADatabaseRunsNothingAndIsReadOnlyWhole) {
  batch("one", "", {record("a", "c", 1, 0.5), record("a", "c", 2, 0.25)});
  merge({path("one")}, path("good.sqlite"));
  const std::string good = read(path("good.sqlite"));
  const auto changed = [&](const char* sql) {
    const std::string file = write("changed.sqlite", good);
    query("changed.sqlite", sql);
    EXPECT_NE(read(file), good) << sql;
    return file;
  };
  for (const std::string table : {"runs", "timing"})
    for (const std::string view : {
             "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT z.* FROM z, c",
             "SELECT CAST(zeroblob(900000000) AS TEXT) AS code, * FROM z",
             "SELECT * FROM z",
         }) {
      const std::string sql = "ALTER TABLE " + table + " RENAME TO z; CREATE VIEW " + table + " AS " + view;
      EXPECT_THROW(load_results(changed(sql.c_str())), InputError) << sql;
    }
  EXPECT_THROW(load_results(changed("ALTER TABLE runs ADD COLUMN more TEXT AS (hex(zeroblob(1000000)))")), InputError);
  EXPECT_THROW(load_results(changed("DROP TABLE timing")), InputError);
  EXPECT_THROW(load_results(changed("UPDATE runs SET code = CAST(zeroblob(17000000) AS TEXT)")), InputError);
  EXPECT_THROW(load_results(changed("UPDATE runs SET score = '[[[['")), InputError);
  EXPECT_EQ(load_results(changed("CREATE INDEX mine ON runs(status); CREATE VIEW also_mine AS SELECT 1")).runs.size(),
            2u);
  for (const std::size_t left :
       {std::size_t{1}, std::size_t{100}, std::size_t{4096}, good.size() / 2, good.size() - 20})
    EXPECT_THROW(load_results(write("cut.sqlite", good.substr(0, good.size() - left))), InputError) << left;
  EXPECT_EQ(load_results(path("good.sqlite")).runs.size(), 2u);
}

/// Pages that lead to themselves, and whatever else bytes can be changed to, end.
TEST_F(Merge, ADamagedDatabaseEnds) {
  std::vector<RunRecord> all;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) all.push_back(record("a", "c", seed, 0.5));
  batch("one", "", all);
  merge({path("one")}, path("good.sqlite"));
  const std::string good = read(path("good.sqlite"));
  Rng rng(3, "damage");
  int refused = 0;
  for (int k = 0; k < 300; ++k) {
    std::string bytes = good;
    for (int n = 0; n < 3; ++n) {
      // Heads of pages and their lists of cells are where the links are.
      const auto page = static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(good.size() / 4096)));
      const auto at = static_cast<std::size_t>(rng.uniform(page == 0 ? 100.0 : 0.0, page == 0 ? 160.0 : 60.0));
      bytes[page * 4096 + at] = static_cast<char>(static_cast<int>(rng.uniform(0.0, 256.0)));
    }
    try {
      EXPECT_LE(load_results(write("damaged.sqlite", bytes)).runs.size(), 60u * 60u);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace rubble::scenarios
