#include "scenarios/batch/merge.h"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/json_size.h"
#include "base/text/new_file.h"
#include "base/text/text_file.h"
#include "scenarios/batch/score_version.h"
#include "scenarios/run/folder_lock.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kMagic = "SQLite format 3";
constexpr int kVersion = 1;
constexpr std::size_t kLargestDatabase = std::size_t{8} << 30;

constexpr std::size_t kLargestValue = std::size_t{16} << 20;  // of a row
// Of reading a database, in instructions of SQLite: a row takes some thirty and holds at least as many bytes.
constexpr int kLookEvery = 1000;
constexpr std::size_t kFreeSteps = 100000;
constexpr std::size_t kStepsPerByte = 4;

constexpr const char* kRunsTable =
    R"sql(CREATE TABLE runs(run_id TEXT PRIMARY KEY, scenario TEXT NOT NULL, config TEXT NOT NULL, seed INTEGER NOT NULL,
  status TEXT NOT NULL, error TEXT NOT NULL, "end" TEXT NOT NULL, broken TEXT NOT NULL, score TEXT NOT NULL,
  hash TEXT NOT NULL, folder TEXT NOT NULL, code TEXT NOT NULL) WITHOUT ROWID)sql";
constexpr const char* kTimingTable =
    R"sql(CREATE TABLE timing(run_id TEXT NOT NULL, key TEXT NOT NULL, value REAL NOT NULL, PRIMARY KEY(run_id, key))
  WITHOUT ROWID)sql";
constexpr const char* kMetricsView = R"sql(
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

/// Its path as SQLite's own words for a file that nobody changes: neither a journal nor a log beside it is opened,
/// which may be anything in a foreign folder. What `batch merge` wrote has none.
std::string unchanging(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' || c == '-' || c == '_';
    char text[4];
    std::snprintf(text, sizeof text, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    uri += plain ? std::string(1, c) : std::string(text);
  }
  return uri + "?immutable=1";
}

class Database {
 public:
  Database(const std::string& path, int flags) : path_(path) {
    sqlite3* opened = nullptr;
    const bool reads = (flags & SQLITE_OPEN_READONLY) != 0;
    const std::string name = reads ? unchanging(fs::absolute(path).string()) : path;
    const int code = sqlite3_open_v2(name.c_str(), &opened, reads ? flags | SQLITE_OPEN_URI : flags, nullptr);
    db_.reset(opened);
    if (code != SQLITE_OK) fail();
  }
  void execute(const std::string& sql) const {
    if (sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
  /// Of a file by somebody else: nothing in it computes, no value is longer than the file, and work ends in
  /// proportion to `size` [bytes].
  void distrust(std::size_t size) {
    for (const int off : {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_VIEW, SQLITE_DBCONFIG_ENABLE_TRIGGER})
      sqlite3_db_config(db_.get(), off, 0, nullptr);
    sqlite3_db_config(db_.get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_limit(db_.get(), SQLITE_LIMIT_LENGTH, static_cast<int>(std::min(size, kLargestValue)));
    looks_left_ = std::make_unique<std::size_t>((kFreeSteps + kStepsPerByte * size) / kLookEvery);
    const auto look = [](void* left) { return (*static_cast<std::size_t*>(left))-- == 0 ? 1 : 0; };
    sqlite3_progress_handler(db_.get(), kLookEvery, look, looks_left_.get());
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
  std::unique_ptr<std::size_t> looks_left_;  ///< of the progress handler
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
  /// Of what text() read, which ends at a zero byte.
  std::size_t bytes(int i) const { return static_cast<std::size_t>(sqlite3_column_bytes(statement_, i)); }
  std::int64_t integer(int i) const { return sqlite3_column_int64(statement_, i); }
  double number(int i) const { return sqlite3_column_double(statement_, i); }

 private:
  const Database& db_;
  sqlite3_stmt* statement_ = nullptr;
};

/// What the file's head says that it holds: SQLite itself passes over the end of the last page.
bool is_whole(const std::string& path, std::size_t size) {
  std::array<unsigned char, 32> head{};
  InputRules rules;
  rules.most = kLargestDatabase;
  InputFile(path, rules).read(reinterpret_cast<char*>(head.data()), head.size());
  const auto number = [&](std::size_t from, std::size_t to) {
    std::size_t value = 0;
    for (std::size_t i = from; i < to; ++i) value = value << 8U | head[i];
    return value;
  };
  const std::size_t page = number(16, 18) == 1 ? 65536 : number(16, 18);
  return page > 0 && size % page == 0 && size / page >= number(28, 32);
}

/// Tables just as write_database() makes them: a view or a column that computes has no bound of its own.
bool is_table(const Database& db, const std::string& name, const char* sql) {
  Statement schema(db, "SELECT type, sql FROM sqlite_master WHERE name = ?");
  schema.bind(0, name);
  return schema.step() && schema.text(0) == "table" && schema.text(1) == sql;
}

/// Takes the texts of rows until they are more than the file can hold: pages that are linked to more than once.
class Texts {
 public:
  explicit Texts(std::size_t most) : left_(most) {}
  std::string operator()(const Statement& row, int i) {
    std::string text = row.text(i);
    const std::size_t bytes = row.bytes(i);
    if (bytes > left_) throw InputError("more text than bytes");
    left_ -= bytes;
    return text;
  }

 private:
  std::size_t left_;
};

ordered_json parsed(const std::string& text) {
  if (!is_modest_json(text)) throw InputError("too much JSON");
  return ordered_json::parse(text);
}

ResultSet read_database(const std::string& path) {
  try {
    const auto size = static_cast<std::size_t>(fs::file_size(path));
    if (!is_whole(path, size)) throw InputError("cut");
    Database db(path, SQLITE_OPEN_READONLY);
    db.distrust(size);
    Statement version(db, "PRAGMA user_version");
    if (!version.step() || version.integer(0) != kVersion) throw InputError("not ours");
    if (!is_table(db, "runs", kRunsTable) || !is_table(db, "timing", kTimingTable)) throw InputError("not ours");
    ResultSet set;
    Texts text(size);
    Statement runs(db,
                   "SELECT run_id, scenario, config, seed, status, error, \"end\", broken, score, hash, folder, code "
                   "FROM runs");
    while (runs.step()) {
      RunRecord r;
      r.run_id = text(runs, 0), r.scenario = text(runs, 1), r.configuration = text(runs, 2);
      r.seed = static_cast<std::uint64_t>(runs.integer(3));
      r.status = status_named(text(runs, 4)), r.error = text(runs, 5), r.end = text(runs, 6);
      r.broken = parsed(text(runs, 7)).get<std::vector<std::string>>();
      *r.score = parsed(text(runs, 8));
      r.hash = text(runs, 9), r.folder = text(runs, 10), r.code = text(runs, 11);
      set.runs.push_back(std::move(r));
    }
    set.runs = unique_runs(std::move(set.runs),
                           path);  // sorted here, not by SQLite, whose sorting would come before any check
    Statement times(db, "SELECT run_id, key, value FROM timing");  // in the order of their primary key
    while (times.step()) {
      const std::string run = text(times, 0);
      set.timing[run][text(times, 1)] = times.number(2);
    }
    return set;
  } catch (const std::exception&) {
    throw InputError(path + ": is no whole file that 'rubble batch merge' wrote; give another one");
  }
}

void write_database(const std::string& path, const ResultSet& set) {
  const Database db(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  db.execute("PRAGMA journal_mode = OFF; PRAGMA user_version = " + std::to_string(kVersion) + "; BEGIN;");
  for (const char* part : {kRunsTable, kTimingTable, kMetricsView}) db.execute(part);
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

/// A new file beside `out`, removed in the end where it did not become that.
class Partial {
 public:
  explicit Partial(const std::string& out) : path_(new_file_beside(out)) {}
  ~Partial() {
    std::error_code ignored;
    fs::remove(path_, ignored);
    let_be(path_);
  }
  Partial(const Partial&) = delete;
  Partial& operator=(const Partial&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

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

MergeReport merge(const std::vector<std::string>& sources, const std::string& named) {
  std::error_code error;
  const bool is_link = fs::is_symlink(fs::symlink_status(named, error));
  const std::string out = is_link ? fs::weakly_canonical(named, error).string() : named;  // a symbolic link stays one
  if (is_link && error)
    throw InputError(named + ": is a link that leads nowhere (" + error.message() + "); give another --out");
  // Two at once would begin with the same content, and the later one would take away what the other has added.
  const fs::path folder = fs::path(out).parent_path();
  const FolderLock alone(folder.empty() ? "." : folder.string(), FolderLock::Busy::Wait);
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
  all.runs = unique_runs(std::move(all.runs), out);
  report.runs = all.runs.size();
  report.added = report.runs - before;
  const Partial partial(out);
  write_database(partial.path(), all);
  fs::rename(partial.path(), out, error);
  if (error) throw RunError(out + ": cannot be written (" + error.message() + "); give another --out");
  return report;
}

}  // namespace rubble::scenarios
