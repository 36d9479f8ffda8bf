#include "scenarios/run/recorded_log.h"

#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/words.h"
#include "robot/logs/foreign/file_bytes.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog = "log.rlog";
constexpr std::string_view kMappedBy = "# rubble map ";  ///< how map_log() begins scenario.yaml

/// Whether `rubble map` made this folder.
bool is_mapped(const fs::path& folder) {
  const fs::path file = folder / "scenario.yaml";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  std::ifstream in(file);
  std::string head(kMappedBy.size(), '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return in && head == kMappedBy;
}

/// The youngest folder beside this one that holds such a file; empty: none.
std::string newest_beside(const std::string& folder, const std::string& name) {
  std::error_code error;
  const fs::path parent = fs::canonical(folder, error).parent_path();  // a link's neighbours are its target's
  fs::path newest;
  fs::file_time_type youngest = fs::file_time_type::min();
  // Not a loop over the range, whose increment throws.
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path log = entry->path() / name;
    std::error_code unreadable;
    if (entry->is_symlink(unreadable) || !fs::is_regular_file(log, unreadable)) continue;
    const fs::file_time_type written = fs::last_write_time(log, unreadable);
    if (unreadable || written < youngest) continue;
    const bool first_of_equals = written == youngest && !newest.empty() && newest < entry->path();
    if (first_of_equals) continue;
    youngest = written;
    newest = entry->path();
  }
  if (newest.empty()) return "";
  // As the user would type it, where that is shorter.
  const fs::path near = newest.lexically_proximate(fs::current_path(error));
  return near.string().size() < newest.string().size() ? near.string() : newest.string();
}

}  // namespace

std::string log_in(const std::string& folder) {
  std::error_code error;
  if (!fs::exists(folder, error))
    throw InputError(one_line(folder) + ": does not exist; give a folder that 'rubble run' or 'rubble drive' wrote");
  const std::string log = folder + "/" + kLog;
  if (!fs::exists(log, error)) {
    const std::string newest = newest_beside(folder, kLog);
    throw InputError(one_line(folder) + ": is not a recorded run (no " + kLog + " in it" +
                     (is_mapped(folder) ? "; 'rubble map' wrote it, and its log is the one that was mapped" : "") +
                     "); give a folder that 'rubble run' or 'rubble drive' wrote" +
                     (newest.empty() ? "" : ", the newest beside it is " + one_line(newest)));
  }
  require_input(log, robot::log_rules());  // a pipe in a foreign folder is not waited for
  return log;
}

void require_truth(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const std::string name = fs::path(path).filename().string();
  std::error_code error;
  if ((name != "truth.tif" && name != "truth.tum") || fs::exists(path, error) ||
      !fs::is_regular_file(folder / "estimate.tum", error))
    return;
  const std::string newest = newest_beside(folder.string(), name);
  throw InputError(one_line(path) + ": is not there" +
                   (is_mapped(folder) ? "; 'rubble map' wrote the folder, and of a log the truth is not known" : "") +
                   "; give that of a folder that 'rubble run' wrote" +
                   (newest.empty() ? "" : ", the newest beside it is " + one_line(newest)));
}

}  // namespace rubble::scenarios
