#include "arenas/files/include_tree.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "arenas/model/arena.h"
#include "arenas/raf/raf.h"
#include "base/text/words.h"

namespace rubble::arenas {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPieces = 1000;  ///< files that include each other twice would grow without bound
constexpr int kMostColumns = 400;  ///< pallets a side of the arena
constexpr const char* kSettings[] = {"cell_m", "ramp_deg", "floor_friction", "wall_height_m", "wall_thickness_m"};

std::string canonical(const std::string& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(path, error);
  return error ? path : found.string();
}

/// The files being read, outermost first, and how many there were so far.
struct Chain {
  std::vector<std::string> names;      ///< as written in messages
  std::vector<std::string> canonical;  ///< the same file has one name here
  int pieces = 0;
};

std::vector<Inclusion> read_includes(const YamlMap& root, const std::string& path, Chain& chain);

/// The ground, walls and parts of a league's file; where the robot starts is up to who includes it. Its pallets have
/// their size, whatever `cell_m` the others have.
YamlMap raf_document(const YamlMap& entry, const std::string& path) {
  const RafImport import = import_raf(path);
  if (!import.unknown.empty())
    entry.fail("file", path + ": " + import.summary() + ": remove these parts from the file");
  const YamlMap root = YamlMap::parse(to_yaml(import), path);
  std::vector<YamlNode::Entry>& entries = root.tree()->entries;
  entries.erase(
      std::remove_if(entries.begin(), entries.end(), [](const YamlNode::Entry& e) { return e.key == "start"; }),
      entries.end());
  YamlPlace top = root.tree()->place;
  top.line = top.column = 0;
  entries.push_back({"cell_m", top, number_node(kPallet, top)});
  return root;
}

ArenaFile read_file(const YamlMap& entry, const std::string& path, Chain& chain) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    if (fs::exists(path, error)) entry.fail("file", "'" + path + "' is no regular file; name an arena file");
    entry.fail("file", "there is no arena file '" + path + "'; the path is relative to the file that includes it");
  }
  const std::string known = canonical(path);
  const auto same = std::find(chain.canonical.begin(), chain.canonical.end(), known);
  if (same != chain.canonical.end()) {
    std::string way;
    for (auto i = same - chain.canonical.begin(); i < static_cast<std::ptrdiff_t>(chain.names.size()); ++i)
      way += short_name(chain.names[static_cast<std::size_t>(i)]) + " -> ";
    entry.fail("file", "the file includes itself: " + way + short_name(path) + "; take one of these includes out");
  }
  if (++chain.pieces > kMostPieces)
    entry.fail("file", "more than " + std::to_string(kMostPieces) + " pieces are included; include fewer");
  if (is_raf(path)) return {raf_document(entry, path), path, {}};
  chain.names.push_back(path);
  chain.canonical.push_back(known);
  const YamlMap root = YamlMap::load(path);
  ArenaFile file{root, path, read_includes(root, path, chain)};
  chain.names.pop_back();
  chain.canonical.pop_back();
  return file;
}

PiecePlace read_place(const YamlMap& entry) {
  PiecePlace place;
  if (entry.has("at")) {
    const std::vector<double> at = entry.numbers("at", 2);
    for (const double number : at) {
      if (!(number >= 0 && number < kMostColumns) || number != std::floor(number))
        entry.fail("at", "give 'at: [columns, rows]' in whole pallets from the south-western one, 0 to " +
                             std::to_string(kMostColumns - 1));
    }
    place.column = static_cast<int>(at[0]);
    place.row = static_cast<int>(at[1]);
  }
  const std::string turn = entry.choice("turn", "0", {"0", "90", "180", "270"});
  place.quarters = static_cast<int>(turn.size() == 1 ? 0 : turn == "90" ? 1 : turn == "180" ? 2 : 3);
  place.name = entry.text("name", std::string());
  return place;
}

std::vector<Inclusion> read_includes(const YamlMap& root, const std::string& path, Chain& chain) {
  std::vector<Inclusion> pieces;
  for (const YamlMap& entry : root.maps("include")) {
    const fs::path file = entry.text("file", std::nullopt);
    const PiecePlace place = read_place(entry);
    entry.finish();
    const std::string full =
        (file.is_absolute() ? file : fs::path(path).parent_path() / file).lexically_normal().string();
    pieces.push_back({entry, place, read_file(entry, full, chain)});
  }
  return pieces;
}

void share_settings(const YamlMap& out, const ArenaFile& file) {
  const YamlMap& piece = file.root;
  for (const char* key : kSettings) {
    if (!piece.has(key)) continue;
    const double value = piece.number(key, std::nullopt, -1e9, 1e9);
    if (!out.has(key)) {
      out.tree()->entries.push_back(*piece.tree()->find(key));
    } else if (out.number(key, std::nullopt, -1e9, 1e9) != value) {
      piece.fail(key, in_quotes(key) + " is " + piece.text(key, std::nullopt) + " here but " +
                          out.text(key, std::nullopt) + " at " + out.place(key) +
                          "; an arena has one: give it in one file, or the same in both");
    }
  }
  for (const Inclusion& inclusion : file.includes) share_settings(out, inclusion.file);
}

}  // namespace

std::string short_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

ArenaFile read_arena_tree(const YamlMap& root, const std::string& path) {
  Chain chain{{path}, {canonical(path)}, 0};
  return {root, path, read_includes(root, path, chain)};
}

YamlMap shared_settings(const ArenaFile& file) {
  const YamlMap settings = YamlMap::of(std::make_shared<YamlNode>());
  settings.tree()->kind = YamlNode::Kind::Map;
  share_settings(settings, file);
  return settings;
}

}  // namespace rubble::arenas
