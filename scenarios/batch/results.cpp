#include "scenarios/batch/results.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/json_size.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kLargestResults = std::size_t{8} << 30;

/// The text of a file with a line for each run: a hundred thousand runs take 300 MB.
std::string read_lines(const std::string& path) {
  InputRules rules;
  rules.most = kLargestResults;
  return read_input(path, rules);
}

struct Line {
  int number = 0;
  std::string text;
  bool whole = false;  ///< ended by a newline
  bool last = false;
};

/// The line that begins at `begin`, which becomes the beginning of the next one.
Line next_line(const std::string& text, std::size_t& begin, int number) {
  const std::size_t end = text.find('\n', begin);
  const bool whole = end != std::string::npos;
  Line line{number, text.substr(begin, whole ? end - begin : std::string::npos), whole, false};
  begin = whole ? end + 1 : text.size();
  line.last = begin == text.size();
  return line;
}

/// The records of a file's text, and how many bytes of it they take: less than all when the last line is torn.
struct Parsed {
  std::vector<RunRecord> records;
  std::size_t bytes = 0;
};

Parsed parse_lines(const std::string& text, const std::string& path) {
  Parsed parsed;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const Line line = next_line(text, at, ++number);
    if (!line.whole) break;
    try {
      parsed.records.push_back(from_line(line.text, path + ":" + std::to_string(line.number)));
    } catch (const InputError&) {
      if (line.last) break;  // blocks that never reached the disk read as zeros
      throw;
    }
    parsed.bytes += line.text.size() + 1;
  }
  return parsed;
}

int open_to_append(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (file < 0)
    throw InputError(path + ": cannot be written (" + std::strerror(errno) + "); give a writable folder with --out");
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) return file;
  close(file);
  throw InputError(path + ": is no file, results would be lost; remove it or give another --out");
}

void lock_file(int file, const std::string& path) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (fcntl(file, F_SETLK, &whole) == 0 || (errno != EACCES && errno != EAGAIN)) return;  // not all systems can lock
  throw InputError(path + ": another rubble is writing it; wait for it, or give another folder with --out");
}

/// Appends all or nothing, and waits for the disk.
void append_synced(int file, const std::string& path, const std::string& line) {
  struct stat status {};
  if (fstat(file, &status) == 0 && status.st_nlink == 0)
    throw RunError(path + ": the folder was deleted under way; give the same command again");
  const off_t before = lseek(file, 0, SEEK_END);
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t written = write(file, line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    done += static_cast<std::size_t>(written);
  }
  if (done == line.size() && fsync(file) == 0) return;
  const std::string why = std::strerror(errno);
  const bool restored = ftruncate(file, before) == 0 && fsync(file) == 0;
  throw RunError(path + ": cannot be written (" + why + "); " +
                 (restored ? "finished runs are kept" : "its last line may be torn and will be dropped") +
                 ", free some space and give the same command again");
}

template <class Use>
void each_file(const std::string& path, const std::string& prefix, const Use& use) {
  std::vector<std::string> files;
  if (fs::is_directory(path)) {
    for (const auto& entry : fs::directory_iterator(path)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind(prefix, 0) == 0 && entry.path().extension() == ".jsonl") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
  } else {
    files.push_back(path);
  }
  for (const auto& file : files) use(file);
}

auto order_of(const RunRecord& r) { return std::tie(r.scenario, r.configuration, r.seed, r.run_id); }

}  // namespace

std::string name_of(RunStatus status) {
  switch (status) {
    case RunStatus::Ok:
      return "ok";
    case RunStatus::Failed:
      return "failed";
    case RunStatus::TimedOut:
      return "timeout";
  }
  return "";
}

RunStatus status_named(const std::string& name) {
  for (const RunStatus status : {RunStatus::Ok, RunStatus::Failed, RunStatus::TimedOut})
    if (name == name_of(status)) return status;
  throw InputError("'" + name + "' is no status of a run; known are ok, failed, timeout");
}

double RunRecord::metric(const std::string& key) const {
  if (key == "completed") return ok() ? 1.0 : 0.0;
  const auto found = score->find(key);
  if (found == score->end()) return std::nan("");
  if (found->is_boolean()) return found->get<bool>() ? 1.0 : 0.0;
  return found->is_number() ? found->get<double>() : std::nan("");
}

std::vector<double> numbers(const std::vector<const RunRecord*>& runs, const std::string& key) {
  std::vector<double> values;
  for (const RunRecord* run : runs)
    if (const double value = run->metric(key); !std::isnan(value)) values.push_back(value);
  return values;
}

std::string to_line(const RunRecord& r) {
  ordered_json json;
  json["run_id"] = r.run_id;
  json["scenario"] = r.scenario;
  json["config"] = r.configuration;
  json["seed"] = r.seed;
  json["status"] = name_of(r.status);
  json["error"] = r.error;
  json["end"] = r.end;
  json["broken"] = r.broken;
  json["score"] = r.score->is_null() ? ordered_json::object() : *r.score;
  json["hash"] = r.hash;
  json["folder"] = r.folder;
  json["code"] = r.code;
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

RunRecord from_line(const std::string& line, const std::string& place) {
  try {
    if (!is_modest_json(line)) throw InputError("too much");
    const ordered_json json = ordered_json::parse(line);
    RunRecord r;
    r.run_id = json.at("run_id");
    r.scenario = json.at("scenario");
    r.configuration = json.at("config");
    if (!json.at("seed").is_number_unsigned()) throw InputError("no seed");
    r.seed = json.at("seed");
    r.status = status_named(json.at("status"));
    r.error = json.at("error");
    r.end = json.at("end");
    r.broken = json.at("broken").get<std::vector<std::string>>();
    *r.score = json.at("score");
    r.hash = json.at("hash");
    r.folder = json.at("folder");
    r.code = json.at("code");
    return r;
  } catch (const std::exception&) {
    throw InputError(place + ": is no line that 'rubble batch' wrote; remove it, its run will be made again");
  }
}

ResultsFile::ResultsFile(const std::string& folder, const std::string& suffix)
    : path_(folder + "/results" + suffix + ".jsonl"), timing_path_(folder + "/timing" + suffix + ".jsonl") {
  file_ = open_to_append(path_);
  try {
    lock_file(file_, path_);
    timing_file_ = open_to_append(timing_path_);
    struct stat status {};
    if (fstat(file_, &status) != 0 || static_cast<std::uintmax_t>(status.st_size) > kLargestResults)
      throw InputError(path_ + ": is over 8 GB, no batch wrote that; remove it or give another --out");
    std::string text;
    char buffer[65536];
    for (ssize_t got = 0; (got = read(file_, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(got));
    Parsed parsed = parse_lines(text, path_);
    records_ = std::move(parsed.records);
    if (parsed.bytes < text.size() && ftruncate(file_, static_cast<off_t>(parsed.bytes)) != 0)
      throw RunError(path_ + ": its torn last line cannot be dropped (" + std::strerror(errno) + ")");
  } catch (...) {
    close(file_);
    if (timing_file_ >= 0) close(timing_file_);
    throw;
  }
}

ResultsFile::~ResultsFile() {
  close(file_);
  close(timing_file_);
}

void ResultsFile::append(const RunRecord& record, const ordered_json& timing) {
  ordered_json times{{"run_id", record.run_id}};
  times.update(timing);
  // Times first: a kill in between leaves times without a result, which the repeated run overrides.
  append_synced(timing_file_, timing_path_, times.dump() + "\n");
  append_synced(file_, path_, to_line(record) + "\n");
}

std::vector<RunRecord> unique_runs(std::vector<RunRecord> records, const std::string& source) {
  std::map<std::string, RunRecord*> by_id;
  for (RunRecord& record : records) {
    RunRecord*& kept = by_id[record.run_id];
    if (kept != nullptr && kept->ok() && record.ok() && to_line(*kept) != to_line(record))
      throw InputError(source + ": run " + record.run_id + " (" + record.scenario + ", " + record.configuration +
                       ", seed " + std::to_string(record.seed) +
                       ") is there twice with different results; remove the one you do not trust");
    if (kept == nullptr || record.ok() || !kept->ok()) kept = &record;
  }
  std::vector<RunRecord> unique;
  for (const auto& entry : by_id) unique.push_back(std::move(*entry.second));
  std::sort(unique.begin(), unique.end(),
            [](const RunRecord& a, const RunRecord& b) { return order_of(a) < order_of(b); });
  return unique;
}

std::vector<RunRecord> load_lines(const std::string& path) {
  std::vector<RunRecord> records;
  std::size_t files = 0;
  each_file(path, "results", [&](const std::string& file) {
    ++files;
    Parsed parsed = parse_lines(read_lines(file), file);
    std::move(parsed.records.begin(), parsed.records.end(), std::back_inserter(records));
  });
  if (files == 0) throw InputError(path + ": holds no results*.jsonl; give the --out folder of a 'rubble batch'");
  return unique_runs(std::move(records), path);
}

Timing load_timing(const std::string& path) {
  Timing timing;
  const std::string folder = fs::is_directory(path) ? path : fs::path(path).parent_path().string();
  if (!fs::is_directory(folder.empty() ? "." : folder)) return timing;
  each_file(folder.empty() ? "." : folder, "timing", [&](const std::string& file) {
    const std::string text = read_lines(file);
    for (std::size_t at = 0; at < text.size();) {
      const Line line = next_line(text, at, 0);
      if (!is_modest_json(line.text)) continue;
      ordered_json json = ordered_json::parse(line.text, nullptr, false);
      if (!json.is_object() || !json.contains("run_id") || !json["run_id"].is_string()) continue;
      const std::string id = json["run_id"];
      json.erase("run_id");
      timing[id] = KeptJson(json);
    }
  });
  return timing;
}

}  // namespace rubble::scenarios
