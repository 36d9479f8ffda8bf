#include "scoring/league/league_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/words.h"

namespace rubble::scoring {
namespace {

namespace fs = std::filesystem;

/// Best first; those from kReadable on are refused by name, so that no team is left out without a word.
constexpr std::array<const char*, 15> kFormats = {".tif", ".tiff", ".yaml", ".yml", ".png", ".jpg", ".jpeg", ".bmp",
                                                  ".pgm", ".ppm",  ".webp", ".gif", ".tga", ".jp2", ".svg"};
constexpr std::size_t kReadable = 10;

std::size_t format_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return static_cast<std::size_t>(std::find(kFormats.begin(), kFormats.end(), extension) - kFormats.begin());
}

// One team's name that is too long, or its link to itself, is no reason to judge nobody: what cannot be asked for is
// not there.
bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string first_that_exists(const std::vector<fs::path>& candidates) {
  for (const fs::path& path : candidates)
    if (is_file(path)) return path.string();
  return "";
}

bool is_image_beside(const fs::path& folder, const std::string& stem) {
  return std::any_of(kFormats.begin(), kFormats.end(),
                     [&](const char* format) { return is_file(folder / (stem + format)); });
}

/// A run, a scoring or a league has written into the folder.
bool has_results(const fs::path& folder) { return is_there(folder / "score.json") || is_there(folder / "league.csv"); }

/// The truth, or a picture that a run, a scoring or an arena file leaves.
bool is_no_map(const fs::path& path, const fs::path& truth) {
  const std::string stem = path.stem().string();
  const fs::path folder = path.parent_path();
  if (stem == "truth" || stem == "overlay") return true;
  if ((stem == "error" || stem == "sight" || stem == "arena") &&
      (has_results(folder) || is_image_beside(folder, "map")))
    return true;
  for (const std::string end : {"-truth", "_truth", "-visible", "-overlay", "-error", "-sight"})
    if (ends_with(stem, end) &&
        (has_results(folder) || is_image_beside(folder, stem.substr(0, stem.size() - end.size()))))
      return true;
  std::error_code error;
  if (stem == truth.stem() && fs::equivalent(folder, truth.parent_path() / ".", error)) return true;
  if (path.filename() == truth.filename() && same_content(path.string(), truth.string())) return true;
  return is_there(folder / (stem + "-truth.tif"));
}

struct MapsInFolder {
  std::map<std::string, fs::path> maps;  ///< the best format of each stem
  std::vector<fs::path> skipped;
};

MapsInFolder maps_in(const fs::path& folder, const fs::path& truth) {
  MapsInFolder out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (!is_file(path) || format_of(path) == kFormats.size()) continue;
    if (is_no_map(path, truth)) {
      out.skipped.push_back(path);
      continue;
    }
    fs::path& known = out.maps[path.stem().string()];
    if (known.empty() || std::make_pair(format_of(path), path) < std::make_pair(format_of(known), known)) known = path;
  }
  return out;
}

LeagueFiles team_in(const fs::path& folder, std::map<std::string, fs::path> maps) {
  LeagueFiles out;
  out.team = folder.filename().string();
  const auto is_readable = [](const auto& map) { return format_of(map.second) < kReadable; };
  // A logo beside the map is none.
  if (std::any_of(maps.begin(), maps.end(), is_readable))
    for (auto map = maps.begin(); map != maps.end();) map = is_readable(*map) ? std::next(map) : maps.erase(map);
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

bool same_content(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::file_size(a, error) != fs::file_size(b, error) || error) return false;
  try {
    InputFile first(a, image_rules()), second(b, image_rules());
    return first.rest() == second.rest();
  } catch (const InputError&) {
    return false;  // told by the reader of the map
  }
}

LeagueFolder find_league(const std::string& folder, const std::string& truth) {
  if (!fs::is_directory(folder))
    throw InputError(folder + ": is no folder; give the folder with the teams' maps to --league");
  LeagueFolder out;
  const auto skip = [&](const std::vector<fs::path>& paths) {
    for (const fs::path& path : paths) out.skipped.push_back(path.lexically_relative(folder).string());
  };
  const MapsInFolder here = maps_in(folder, truth);
  skip(here.skipped);
  for (const auto& [stem, path] : here.maps) {
    const fs::path beside = path.parent_path() / stem;
    out.teams.push_back(
        {stem, path.string(), first_that_exists({beside.string() + ".csv", beside.string() + "_pois.csv"}), ""});
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::error_code error;
    if (entry.is_symlink(error) && !fs::exists(entry.path(), error) && format_of(entry.path()) != kFormats.size())
      out.teams.push_back({entry.path().stem().string(), "", "",
                           entry.path().string() + ": a link that leads to no file; mend or remove it"});
    if (!entry.is_directory(error) || entry.is_symlink(error)) continue;
    MapsInFolder inside;
    try {
      inside = maps_in(entry.path(), truth);
    } catch (const fs::filesystem_error& unreadable) {
      out.teams.push_back(
          {entry.path().filename().string(), "", "",
           entry.path().string() + ": cannot be read (" + unreadable.code().message() + "); see its rights"});
      continue;
    }
    skip(inside.skipped);
    if (inside.maps.empty() && !inside.skipped.empty()) continue;  // results of a league, or an arena's pictures
    out.teams.push_back(team_in(entry.path(), inside.maps));
  }
  if (out.teams.empty())
    throw InputError(folder + ": holds no maps (tif, yaml, png, jpg, pgm) and no folders with maps" +
                     (out.skipped.empty() ? "" : ", only the truth or pictures of runs, as " + out.skipped.front()));
  std::sort(out.teams.begin(), out.teams.end(), [](const LeagueFiles& a, const LeagueFiles& b) {
    return std::tie(a.team, a.map) < std::tie(b.team, b.map);
  });
  std::sort(out.skipped.begin(), out.skipped.end());
  return out;
}

}  // namespace rubble::scoring
