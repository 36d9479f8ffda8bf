#include "app/league_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>

#include "base/error.h"

namespace rubble::app {
namespace {

namespace fs = std::filesystem;

/// Best first.
constexpr std::array<const char*, 10> kFormats = {".tif", ".tiff", ".yaml", ".yml", ".png",
                                                  ".jpg", ".jpeg", ".bmp",  ".pgm", ".ppm"};

std::size_t format_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return static_cast<std::size_t>(std::find(kFormats.begin(), kFormats.end(), extension) - kFormats.begin());
}

std::string first_that_exists(const std::vector<fs::path>& candidates) {
  for (const fs::path& path : candidates)
    if (fs::is_regular_file(path)) return path.string();
  return "";
}

/// The best format of each stem among the files of a folder.
std::map<std::string, fs::path> maps_in(const fs::path& folder) {
  std::map<std::string, fs::path> maps;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (!entry.is_regular_file() || format_of(path) == kFormats.size()) continue;
    fs::path& known = maps[path.stem().string()];
    if (known.empty() || std::make_pair(format_of(path), path) < std::make_pair(format_of(known), known)) known = path;
  }
  return maps;
}

LeagueFiles team_in(const fs::path& folder) {
  LeagueFiles out;
  out.team = folder.filename().string();
  const std::map<std::string, fs::path> maps = maps_in(folder);
  const auto named = maps.find("map");
  if (named != maps.end()) {
    out.map = named->second.string();
  } else if (maps.size() == 1) {
    out.map = maps.begin()->second.string();
  } else {
    out.error = folder.string() + ": holds " + (maps.empty() ? "no map" : "several images") + "; name one map.tif";
  }
  if (!out.map.empty())
    out.pois = first_that_exists({folder / "pois.csv", fs::path(out.map).replace_extension(".csv")});
  return out;
}

}  // namespace

std::vector<LeagueFiles> find_league(const std::string& folder) {
  if (!fs::is_directory(folder))
    throw InputError(folder + ": is no folder; give the folder with the teams' maps to --league");
  std::vector<LeagueFiles> out;
  for (const auto& [stem, path] : maps_in(folder)) {
    const fs::path beside = path.parent_path() / stem;
    out.push_back(
        {stem, path.string(), first_that_exists({beside.string() + ".csv", beside.string() + "_pois.csv"}), ""});
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_directory() && !entry.is_symlink()) out.push_back(team_in(entry.path()));
  if (out.empty()) throw InputError(folder + ": holds no maps (tif, yaml, png, jpg, pgm) and no folders with maps");
  std::sort(out.begin(), out.end(), [](const LeagueFiles& a, const LeagueFiles& b) {
    return std::tie(a.team, a.map) < std::tie(b.team, b.map);
  });
  return out;
}

}  // namespace rubble::app
