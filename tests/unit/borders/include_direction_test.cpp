// The borders between the rooms and between their wings: which folder may include which. The truth must not leak into
// the mapper, and what lies inside a room stays there.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/source_dir.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
using Folders = std::set<std::string>;

/// Rooms that a room may include, besides itself.
const std::map<std::string, Folders>& rooms() {
  static const std::map<std::string, Folders> table = {
      {"base", {}},
      {"robot", {"base"}},
      {"arenas", {"base"}},
      {"sim", {"base", "robot", "arenas"}},
      {"slam", {"base", "robot"}},
      {"explore", {"base", "robot", "slam"}},
      {"scoring", {"base", "arenas"}},
      {"scenarios", {"base", "robot", "arenas", "sim", "slam", "explore", "scoring"}},
      {"app", {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios"}},
      {"bench", {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios", "tests"}},
  };
  return table;
}

/// Wings that each wing may include of its own room, besides itself. The room's top (its face) may include them all
/// and be included by those that list the room's name. "slam/*" stands for every wing of slam that has no row: those
/// are what can be had in several kinds, know nothing of each other, and are insides.
const std::map<std::string, Folders>& wings() {
  static const std::map<std::string, Folders> table = {
      {"base/text", {"base"}},
      {"base/yaml", {"base", "base/text"}},
      {"base/image", {"base", "base/text"}},
      {"robot/logs", {"robot", "robot/logs/own", "robot/logs/foreign"}},
      {"robot/logs/own", {"robot", "robot/logs"}},
      {"robot/logs/foreign", {"robot", "robot/logs", "robot/logs/own"}},
      {"robot/protocols", {}},
      {"robot/drivers", {"robot", "robot/protocols", "robot/drivers/watch"}},
      {"robot/drivers/watch", {"robot", "robot/drivers"}},
      {"robot/drivers/scip", {"robot", "robot/drivers"}},
      {"robot/drivers/mrpt", {"robot", "robot/drivers"}},
      {"robot/drivers/probe", {"robot", "robot/drivers", "robot/drivers/scip", "robot/protocols"}},
      {"robot/emulators", {"robot", "robot/drivers", "robot/protocols"}},
      {"robot/emulators/scip", {"robot", "robot/drivers", "robot/drivers/scip", "robot/emulators"}},
      {"arenas/model", {}},
      {"arenas/elements", {"arenas/model"}},
      {"arenas/truth", {"arenas/model"}},
      {"arenas/generate", {"arenas/model"}},
      {"arenas/raf", {"arenas/model", "arenas/elements", "arenas/truth"}},
      {"arenas/files", {"arenas/model", "arenas/elements", "arenas/raf"}},
      {"sim/body", {}},
      {"sim/laser", {"sim/body"}},
      {"slam/grid", {}},
      {"slam/scan", {"slam/grid"}},
      {"slam/*", {"slam", "slam/grid", "slam/scan"}},
      {"slam/robust",
       {"slam", "slam/grid", "slam/scan", "slam/robust/matching", "slam/robust/graph", "slam/robust/map"}},
      {"slam/robust/matching", {"slam/grid"}},
      {"slam/robust/graph", {"slam/robust/matching"}},
      {"slam/robust/map", {"slam/grid", "slam/scan", "slam/robust/matching", "slam/robust/graph"}},
      {"slam/calibration", {"slam/grid", "slam/scan", "slam/robust/matching"}},
      {"explore/plan", {}},
      {"explore/caution", {"explore"}},
      {"explore/search", {"explore", "explore/plan"}},
      {"explore/motion", {"explore", "explore/plan"}},
      {"explore/stuck", {"explore", "explore/plan", "explore/caution"}},
      {"explore/*",
       {"explore", "explore/plan", "explore/caution", "explore/search", "explore/motion", "explore/stuck"}},
      {"slam/process", {"slam", "slam/grid", "slam/scan"}},
      {"slam/peers", {"slam", "slam/grid", "slam/scan", "slam/process"}},
      {"scoring/maps", {"scoring/maps/colours"}},
      {"scoring/maps/colours", {}},
      {"scoring/walls", {}},
      {"scoring/measures", {"scoring/walls"}},
      {"scoring/proposals", {"scoring/walls"}},
      {"scoring/rooms", {"scoring/walls", "scoring/proposals", "scoring/measures"}},
      {"scoring/alignment", {"scoring/walls", "scoring/proposals", "scoring/rooms", "scoring/measures"}},
      {"scoring/trajectory", {"scoring/walls"}},
      {"scoring/figures",
       {"scoring", "scoring/maps", "scoring/measures", "scoring/rooms", "scoring/trajectory", "scoring/walls"}},
      {"scoring/league",
       {"scoring", "scoring/figures", "scoring/maps", "scoring/walls", "scoring/measures", "scoring/pictures"}},
      {"scoring/pictures", {"scoring", "scoring/maps", "scoring/walls"}},
      {"scenarios/config", {}},
      {"scenarios/run", {"scenarios/config"}},
      {"scenarios/batch", {"scenarios/config", "scenarios/run"}},
      {"scenarios/benchmark", {"scenarios/config", "scenarios/run"}},
      {"scenarios/evidence", {"scenarios/batch"}},
      {"scenarios/hardware", {"scenarios/config", "scenarios/run"}},
  };
  return table;
}

/// Wings that nobody outside their room may include (tests and benchmarks apart).
const Folders& insides() {
  static const Folders table = {"explore/caution",   "explore/plan",
                                "explore/search",    "robot/logs/own",
                                "scoring/alignment", "scoring/maps/colours",
                                "scoring/proposals", "scoring/rooms",
                                "scoring/walls",     "sim/body",
                                "sim/laser",         "slam/peers",
                                "slam/robust",       "slam/robust/graph",
                                "slam/robust/map",   "slam/robust/matching",
                                "slam/scan",         "explore/motion",
                                "explore/stuck"};
  return table;
}

/// Wings of devices and of others' files, with those below them: who outside their room may include them (benchmarks
/// and tests apart). The core and the simulator know a robot by its face alone.
const std::map<std::string, Folders>& reserved() {
  static const std::map<std::string, Folders> table = {
      {"robot/drivers", {"scenarios", "app"}},
      {"robot/emulators", {"scenarios", "app"}},
      {"robot/protocols", {"scenarios", "app"}},
      {"robot/logs/foreign",
       {"scenarios", "app", "slam/peers"}},  // peers see MRPT's observations, as its logs hold them
  };
  return table;
}

bool lies_in(const std::string& folder, const std::string& above) {
  return folder == above || folder.rfind(above + "/", 0) == 0;
}

/// Whether `folder`, of another room, may include a file of `included` as far as that one is reserved.
bool is_let_in(const std::string& folder, const std::string& included) {
  for (const auto& [wing, guests] : reserved()) {
    if (!lies_in(included, wing)) continue;
    return std::any_of(guests.begin(), guests.end(), [&](const std::string& guest) { return lies_in(folder, guest); });
  }
  return true;
}

std::string room_of(const std::string& folder) { return folder.substr(0, folder.find('/')); }

/// The wing's row, or that of its room's kinds, or null.
const Folders* row_of(const std::string& wing) {
  for (const std::string& name : {wing, room_of(wing) + "/*"}) {
    const auto found = wings().find(name);
    if (found != wings().end() && wing != room_of(wing)) return &found->second;
  }
  return nullptr;
}

bool is_inside(const std::string& folder) {
  return insides().count(folder) == 1 || (wings().count(folder) == 0 && row_of(folder) != nullptr);
}

/// What is wrong with a file of `folder` including a file of `included`; empty: nothing.
std::string offence(const std::string& folder, const std::string& included) {
  const std::string room = room_of(folder), other = room_of(included);
  if (rooms().count(room) == 0) return folder + " is not in the table of rooms";
  if (room != other) {
    if (rooms().at(room).count(other) == 0) return room + " must not know " + other;
    if (room != "bench" && (is_inside(included) || !is_let_in(folder, included)))
      return included + " is an inside of " + other;
    return "";
  }
  if (folder == included || folder == room) return "";
  const Folders* may = row_of(folder);
  if (may == nullptr) return folder + " is not in the table of wings";
  return may->count(included) == 1 ? "" : folder + " must not know " + included;
}

/// Folders of our own files that a text in `folder` includes, in whatever way: in quotes or angle brackets, from the
/// top or from where it lies itself, by any ending.
Folders included_folders(std::istream& in, const std::string& folder) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  Folders folders;
  std::string line;
  std::smatch match;
  while (std::getline(in, line)) {
    if (!std::regex_search(line, match, include)) continue;
    const std::string name = match[2];
    const bool relative = name[0] == '.' || name.find('/') == std::string::npos;
    const fs::path path = relative ? (fs::path(folder) / name).lexically_normal() : fs::path(name).lexically_normal();
    const std::string included = path.parent_path().generic_string();
    // A library's header stands in angle brackets.
    if (match[1] == "\"" || (rooms().count(room_of(included)) == 1 && name.find('/') != std::string::npos) ||
        room_of(included) == "tests")
      folders.insert(included);
  }
  return folders;
}

bool is_source(const fs::path& path) {
  static const Folders endings = {".h", ".hpp", ".hh", ".hxx", ".inl", ".ipp", ".c", ".cpp", ".cc", ".cxx"};
  return endings.count(path.extension().string()) == 1;
}

TEST(IncludeDirection, NoFileIncludesWhatItMayNotKnow) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  std::size_t files = 0;
  for (const auto& [room, may] : rooms()) {
    ASSERT_TRUE(fs::is_directory(top / room)) << room;
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      if (!is_source(entry.path())) continue;
      ++files;
      const std::string folder = fs::relative(entry.path().parent_path(), top).generic_string();
      std::ifstream in(entry.path());
      for (const auto& included : included_folders(in, folder))
        EXPECT_EQ(offence(folder, included), "") << entry.path() << " includes a file of " << included;
    }
  }
  EXPECT_GT(files, 300u);
}

TEST(IncludeDirection, NoTwoWingsKnowEachOtherThroughOthers) {
  // The faces of a room apart, wings form layers: following the table never leads back.
  for (const auto& [start, may] : wings()) {
    Folders seen;
    std::vector<std::string> left(may.begin(), may.end());
    while (!left.empty()) {
      const std::string wing = left.back();
      left.pop_back();
      if (wings().count(wing) == 0 || !seen.insert(wing).second) continue;
      // A wing below another one may know the one above it, which is its face.
      if (start.rfind(wing + "/", 0) == 0 || wing.rfind(start + "/", 0) == 0) continue;
      EXPECT_NE(wing, start);
      left.insert(left.end(), wings().at(wing).begin(), wings().at(wing).end());
    }
  }
}

TEST(IncludeDirection, EveryWingIsInTheTable) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  for (const auto& [room, may] : rooms())
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      if (!is_source(entry.path())) continue;
      const std::string folder = fs::relative(entry.path().parent_path(), top).generic_string();
      if (folder == room) continue;
      EXPECT_NE(row_of(folder), nullptr) << folder;
    }
}

/// Everything that a header brings in, of our own files and of libraries.
void gather(const fs::path& top, const std::string& name, Folders& seen) {
  static const std::regex include(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::ifstream in(top / name);
  std::string line;
  std::smatch match;
  while (std::getline(in, line))
    if (std::regex_search(line, match, include) && seen.insert(match[1]).second) gather(top, match[1], seen);
}

TEST(IncludeDirection, CastersDoNotSeeBox2D) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  for (const auto& entry : fs::directory_iterator(top / "sim" / "laser")) {
    Folders seen;
    gather(top, fs::relative(entry.path(), top).generic_string(), seen);
    EXPECT_EQ(seen.count("box2d/box2d.h"), 0u) << entry.path();
  }
  Folders of_the_world;
  gather(top, "sim/body/world.h", of_the_world);
  EXPECT_EQ(of_the_world.count("box2d/box2d.h"), 1u);
}

TEST(IncludeDirection, FacesBringNoLibraryOfTheInsides) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  static const std::regex heavy(R"re(^(opencv2/|Eigen/|box2d/|nlohmann/json\.hpp|mrpt/(obs|slam|maps)/))re");
  std::vector<fs::path> faces = {top / "sim/sim_robot.h", top / "sim/sim_team.h"};
  for (const char* room : {"robot", "slam", "explore", "scoring"})
    for (const auto& entry : fs::directory_iterator(top / room)) faces.push_back(entry.path());
  for (const auto& entry : fs::recursive_directory_iterator(top / "scenarios")) faces.push_back(entry.path());
  std::size_t headers = 0;
  for (const fs::path& face : faces) {
    if (face.extension() != ".h") continue;
    ++headers;
    Folders seen;
    gather(top, fs::relative(face, top).generic_string(), seen);
    for (const std::string& included : seen)
      EXPECT_FALSE(std::regex_search(included, heavy)) << face << " " << included;
  }
  EXPECT_GT(headers, 40u);
  Folders of_an_inside;
  gather(top, "scoring/alignment/feature_score.h", of_an_inside);
  EXPECT_EQ(of_an_inside.count("opencv2/core.hpp"), 1u);
}

/// What takes the compiler seconds is read by those few files alone that cannot do without it.
TEST(IncludeDirection, HeavyLibrariesStayWhereTheyAreNeeded) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  static const std::regex heavy(R"re(^\s*#\s*include\s*[<"](CLI/|box2d/|nlohmann/json\.hpp))re");
  Folders libraries;
  for (const auto& [room, may] : rooms()) {
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      if (!is_source(entry.path()) || room == "bench") continue;
      const std::string file = fs::relative(entry.path(), top).generic_string();
      std::ifstream in(entry.path());
      std::string line;
      std::smatch match;
      while (std::getline(in, line)) {
        if (!std::regex_search(line, match, heavy)) continue;
        const std::string library = match[1];
        libraries.insert(library);
        const bool needed = library == "CLI/"     ? file == "app/main.cpp"
                            : library == "box2d/" ? fs::path(file).parent_path() == "sim/body"
                                                  : entry.path().extension() == ".cpp";
        EXPECT_TRUE(needed) << file << " reads " << library;
      }
    }
  }
  EXPECT_EQ(libraries.size(), 3u);
}

TEST(IncludeDirection, APlantedWrongIncludeIsSeen) {
  std::istringstream planted(
      "#pragma once\n#include <vector>\n#include <mrpt/math/TPose2D.h>\n  #  include \"arenas/truth/truth_map.h\"\n"
      "#include \"slam/mapper.h\"\n#include \"particle.h\"\n#include <sim/laser/rays.hpp>\n"
      "#include \"../../scoring/scorecard.cpp\"\n");
  const Folders folders = included_folders(planted, "slam/paper");
  EXPECT_EQ(folders, (Folders{"arenas/truth", "slam", "slam/paper", "sim/laser", "scoring"}));
  EXPECT_EQ(offence("slam/paper", "arenas/truth"), "slam must not know arenas");
  EXPECT_EQ(offence("slam/grid", "slam/paper"), "slam/grid must not know slam/paper");
  EXPECT_EQ(offence("slam/robust/matching", "slam/robust/graph"),
            "slam/robust/matching must not know slam/robust/graph");
  EXPECT_EQ(offence("slam/robust/graph", "slam/robust/map"), "slam/robust/graph must not know slam/robust/map");
  EXPECT_EQ(offence("slam/robust/map", "slam/robust"), "slam/robust/map must not know slam/robust");
  EXPECT_EQ(offence("scenarios/run", "slam/robust/map"), "slam/robust/map is an inside of slam");
  EXPECT_EQ(offence("scenarios/run", "scoring/alignment"), "scoring/alignment is an inside of scoring");
  EXPECT_EQ(offence("explore", "slam"), "");
  EXPECT_EQ(offence("slam", "slam/paper"), "");
  EXPECT_EQ(offence("scoring/alignment", "scoring/league"), "scoring/alignment must not know scoring/league");
  EXPECT_EQ(offence("scoring/yours", "scoring"), "scoring/yours is not in the table of wings");
}

TEST(IncludeDirection, OnlyWhoRunsRobotsSeesTheirDevices) {
  for (const char* wing : {"robot/drivers", "robot/drivers/scip", "robot/emulators", "robot/emulators/scip",
                           "robot/protocols", "robot/logs/foreign"}) {
    const std::string inside = std::string(wing) + " is an inside of robot";
    for (const char* core : {"slam", "slam/robust", "explore", "explore/search", "sim", "sim/body"})
      EXPECT_EQ(offence(core, wing), inside) << core;
    for (const char* runs : {"scenarios/hardware", "scenarios/run", "app", "bench"})
      EXPECT_EQ(offence(runs, wing), "") << runs << " and " << wing;
  }
  EXPECT_EQ(offence("slam/peers", "robot/logs/foreign"), "");
  EXPECT_EQ(offence("slam/peers", "robot/drivers"), "robot/drivers is an inside of robot");
  for (const char* face : {"robot", "robot/logs"}) EXPECT_EQ(offence("slam/robust", face), "");
}

TEST(IncludeDirection, ANewKindNeedsNoRowAndSeesOnlyWhatAllKindsSee) {
  EXPECT_EQ(offence("slam/yours", "slam/scan"), "");
  EXPECT_EQ(offence("slam/yours", "slam"), "");
  EXPECT_EQ(offence("slam/yours", "slam/robust"), "slam/yours must not know slam/robust");
  EXPECT_EQ(offence("slam/yours", "sim"), "slam must not know sim");
  EXPECT_EQ(offence("slam/grid", "slam/yours"), "slam/grid must not know slam/yours");
  EXPECT_EQ(offence("scenarios/run", "slam/yours"), "slam/yours is an inside of slam");
  EXPECT_EQ(offence("explore/yours", "explore/search"), "");
  EXPECT_EQ(offence("explore/yours", "slam/robust"), "slam/robust is an inside of slam");
  EXPECT_EQ(offence("scenarios/run", "slam/process"), "") << "has a row of its own, and is no inside";
}

}  // namespace
}  // namespace rubble
