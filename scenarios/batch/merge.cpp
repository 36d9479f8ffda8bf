#include "scenarios/batch/merge.h"

#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/text_file.h"
#include "scenarios/batch/score_version.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kMagic = "SQLite format 3";
constexpr int kVersion = 1;
constexpr std::size_t kLargestDatabase = std::size_t{8} << 30;

constexpr const char* kSchema = R"sql(
PRAGMA journal_mode = OFF;
PRAGMA user_version = 1;
BEGIN;
CREATE TABLE runs(run_id TEXT PRIMARY KEY, scenario TEXT NOT NULL, config TEXT NOT NULL, seed INTEGER NOT NULL,
  status TEXT NOT NULL, error TEXT NOT NULL, "end" TEXT NOT NULL, broken TEXT NOT NULL, score TEXT NOT NULL,
  hash TEXT NOT NULL, folder TEXT NOT NULL, code TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE timing(run_id TEXT NOT NULL, key TEXT NOT NULL, value REAL NOT NULL, PRIMARY KEY(run_id, key))
  WITHOUT ROWID;
CREATE VIEW metrics AS SELECT run_id, j.key AS key, CAST(j.value AS REAL) AS value FROM runs, json_each(runs.score) AS j
  WHERE j.type IN ('integer', 'real', 'true', 'false');
)sql";

bool is_database(const std::string& path) {
  char head[16] = {};
  InputRules rules;
  rules.most = kLargestDatabase;
  rules.pipes = Pipes::None;
  InputFile(path, rules).read(head, sizeof head);
  return std::string(head, sizeof head) == std::string(kMagic, sizeof head);  // the end mark included
}

class Database {
 public:
  Database(const std::string& path, int flags) : path_(path) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &opened, flags, nullptr);
    db_.reset(opened);
    if (code != SQLITE_OK) fail();
  }
  void execute(const char* sql) const {
    if (sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
  [[noreturn]] void fail() const {
    throw RunError(path_ + ": " + (db_ ? sqlite3_errmsg(db_.get()) : "cannot be opened") +
                   "; check the file, the folder and the free space");
  }
  sqlite3* get() const { return db_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close(db); }
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> db_;
};

/// A prepared statement; columns and parameters count from 0.
class Statement {
 public:
  Statement(const Database& db, const char* sql) : db_(db) {
    if (sqlite3_prepare_v2(db.get(), sql, -1, &statement_, nullptr) != SQLITE_OK) db.fail();
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int i, const std::string& text) {
    sqlite3_bind_text(statement_, i + 1, text.c_str(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }
  void bind(int i, std::int64_t value) { sqlite3_bind_int64(statement_, i + 1, value); }
  void bind(int i, double value) { sqlite3_bind_double(statement_, i + 1, value); }
  /// True: a row is there.
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) db_.fail();
    return code == SQLITE_ROW;
  }
  void reset() { sqlite3_reset(statement_); }
  std::string text(int i) const {
    const auto* bytes = sqlite3_column_text(statement_, i);
    return bytes ? reinterpret_cast<const char*>(bytes) : "";
  }
  std::int64_t integer(int i) const { return sqlite3_column_int64(statement_, i); }
  double number(int i) const { return sqlite3_column_double(statement_, i); }

 private:
  const Database& db_;
  sqlite3_stmt* statement_ = nullptr;
};

ResultSet read_database(const std::string& path) {
  try {
    const Database db(path, SQLITE_OPEN_READONLY);
    Statement version(db, "PRAGMA user_version");
    if (!version.step() || version.integer(0) != kVersion) throw InputError("not ours");
    ResultSet set;
    Statement runs(db,
                   "SELECT run_id, scenario, config, seed, status, error, \"end\", broken, score, hash, folder, code "
                   "FROM runs ORDER BY scenario, config, seed, run_id");
    while (runs.step()) {
      RunRecord r;
      r.run_id = runs.text(0), r.scenario = runs.text(1), r.configuration = runs.text(2);
      r.seed = static_cast<std::uint64_t>(runs.integer(3));
      r.status = status_named(runs.text(4)), r.error = runs.text(5), r.end = runs.text(6);
      r.broken = ordered_json::parse(runs.text(7)).get<std::vector<std::string>>();
      *r.score = ordered_json::parse(runs.text(8));
      r.hash = runs.text(9), r.folder = runs.text(10), r.code = runs.text(11);
      set.runs.push_back(r);
    }
    Statement times(db, "SELECT run_id, key, value FROM timing ORDER BY run_id, key");
    while (times.step()) set.timing[times.text(0)][times.text(1)] = times.number(2);
    return set;
  } catch (const std::exception&) {
    throw InputError(path + ": is no file that 'rubble batch merge' wrote; give another one");
  }
}

void write_database(const std::string& path, const ResultSet& set) {
  const Database db(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  db.execute(kSchema);
  Statement run(db, "INSERT INTO runs VALUES(?,?,?,?,?,?,?,?,?,?,?,?)");
  for (const RunRecord& r : set.runs) {
    run.bind(0, r.run_id), run.bind(1, r.scenario), run.bind(2, r.configuration);
    run.bind(3, static_cast<std::int64_t>(r.seed));
    run.bind(4, name_of(r.status)), run.bind(5, r.error), run.bind(6, r.end);
    run.bind(7, ordered_json(r.broken).dump()), run.bind(8, r.score->dump());
    run.bind(9, r.hash), run.bind(10, r.folder), run.bind(11, r.code);
    run.step();
    run.reset();
  }
  Statement time(db, "INSERT INTO timing VALUES(?,?,?)");
  for (const RunRecord& r : set.runs) {
    const auto times = set.timing.find(r.run_id);
    if (times == set.timing.end()) continue;
    for (const auto& [key, value] : times->second->items()) {
      if (!value.is_number()) continue;
      time.bind(0, r.run_id), time.bind(1, key), time.bind(2, value.get<double>());
      time.step();
      time.reset();
    }
  }
  db.execute("COMMIT");
}

}  // namespace

ResultSet load_results(const std::string& path) {
  if (!fs::exists(path))
    throw InputError(path + ": does not exist; give the folder of a 'rubble batch' or a file of 'rubble batch merge'");
  ResultSet set;
  if (!fs::is_directory(path) && is_database(path)) {
    set = read_database(path);
  } else if (!fs::is_directory(path) && fs::path(path).extension() != ".jsonl") {
    throw InputError(path + ": holds no results; give a folder, a results.jsonl or a file of 'rubble batch merge'");
  } else {
    set.runs = load_lines(path);
    set.timing = load_timing(path);
  }
  set.folder = fs::is_directory(path) ? path : fs::path(path).parent_path().string();
  if (set.folder.empty()) set.folder = ".";
  return set;
}

MergeReport merge(const std::vector<std::string>& sources, const std::string& out) {
  ResultSet all;
  MergeReport report;
  if (fs::exists(out)) {
    if (!is_database(out)) throw InputError(out + ": exists and is no SQLite file; give another --out");
    all = load_results(out);
  }
  const std::size_t before = all.runs.size();
  std::optional<int> version = score_version_of(all.runs, out);
  std::string first = out;
  for (const auto& source : sources) {
    ResultSet set = load_results(source);
    const std::optional<int> of_source = score_version_of(set.runs, source);
    require_same_score(version, first, of_source, source);
    if (!version && of_source) {
      version = of_source;
      first = source;
    }
    all.runs.insert(all.runs.end(), set.runs.begin(), set.runs.end());
    for (auto& entry : set.timing) all.timing[entry.first] = std::move(entry.second);
  }
  all.runs = unique_runs(all.runs, out);
  report.runs = all.runs.size();
  report.added = report.runs - before;
  const std::string partial = new_file_beside(out);
  std::error_code error;
  try {
    write_database(partial, all);
  } catch (const RunError&) {
    fs::remove(partial, error);
    throw;
  }
  fs::rename(partial, out, error);
  if (error) throw RunError(out + ": cannot be written (" + error.message() + "); give another --out");
  return report;
}

}  // namespace rubble::scenarios
