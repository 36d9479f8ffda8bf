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

/// Rooms that a room may include, besides itself. What uses the rooms from outside (benchmarks, fuzz targets, examples,
/// tests) has a row as well; a test's is that of the room that it lies in, see rooms_of().
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
      {"app", {"base", "scenarios"}},  // what else it reads stands in doors(), header by header
      {"bench", {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios", "tests"}},
      {"fuzz", {"base", "robot", "arenas", "slam", "scoring", "scenarios"}},
      {"examples", {"robot", "slam", "explore"}},
      {"tests", {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios", "tests"}},
  };
  return table;
}

/// Single headers that a folder and those below it may include beyond what the other tables allow. None of them leads
/// back to the folder.
const std::map<std::string, Folders>& doors() {
  static const std::map<std::string, Folders> table = {
      // A command that is no run of a scenario shows what one room can do by itself.
      {"app", {"slam/process/mapper_server.h", "slam/process/process_mapper.h"}},
      {"app/runs", {"robot/logs/foreign/mrpt_bridge.h"}},
      {"app/robots",
       {"robot/commands.h", "robot/drivers/base_driver.h", "robot/drivers/port.h", "robot/drivers/probe/probe.h"}},
      {"app/maps",
       {"arenas/elements/elements.h",
        "arenas/files/arena_file.h",
        "arenas/generate/generate.h",
        "arenas/raf/raf.h",
        "arenas/truth/render.h",
        "arenas/truth/start_region.h",
        "arenas/truth/truth_map.h",
        "arenas/truth/unseen.h",
        "arenas/truth/visible.h",
        "arenas/truth/wall_lines.h",
        "explore/plan_picture.h",
        "scoring/figures/figures.h",
        "scoring/league/league_judge.h",
        "scoring/league/league_victims.h",
        "scoring/maps/league_map.h",
        "scoring/maps/normalise.h",
        "scoring/maps/raster_image.h",
        "scoring/marks.h",
        "scoring/pictures/evaluation_page.h",
        "scoring/pictures/picture.h",
        "scoring/pictures/sight_picture.h",
        "scoring/pose_score.h",
        "scoring/room_report.h",
        "scoring/scorecard.h",
        "scoring/trajectory/relative_error.h",
        "scoring/trajectory/trajectory_error.h"}},
      // RealRobot puts base and watches together: a watch sees the base by the interface that all bases have, and the
      // words in which both speak of it; never RealRobot or a driver.
      {"robot/drivers/watch",
       {"robot/drivers/answer_timer.h", "robot/drivers/base_driver.h", "robot/drivers/hindrance.h"}},
      // Readers and writers of logs give the plain Log that the face of robot/logs hands out.
      {"robot/logs/own", {"robot/logs/log.h"}},
      {"robot/logs/foreign", {"robot/logs/log.h"}},
      {"slam/mrpt/module", {"robot/logs/foreign/module/to_mrpt.h"}},  // MRPT's observations, as its logs hold them
      {"explore", {"slam/grid/count_map.h"}},                         // the map that a mapper gives is one
      {"scenarios/hardware", {"slam/calibration/calibration.h"}},
      {"examples/own_base", {"robot/drivers/base_driver.h"}},
      {"tests/unit/robot", {"examples/own_base/line_base.h"}},
      {"tests/unit/explore/paper", {"slam/paper/paper_mapper.h"}},
      {"tests/unit/scenarios", {"slam/paper/paper_mapper.h"}},
      {"tests/unit/scenarios/run", {"slam/robust/map/saved_map.h", "slam/robust/robust_mapper.h"}},
      {"tests/unit/scenarios/hardware",
       {"robot/protocols/arcos_commands.h", "robot/protocols/arcos_packet.h", "robot/protocols/arcos_reports.h"}},
  };
  return table;
}

/// Wings that each wing may include of its own room, besides itself. The room's top (its face) may include them all
/// and be included by those that list the room's name. "slam/*" stands for every kind of mapper without a row: a wing
/// of slam that the table of kinds in slam/mappers.cpp includes. Kinds know nothing of each other, and are insides.
const std::map<std::string, Folders>& wings() {
  static const std::map<std::string, Folders> table = {
      {"base/text", {"base"}},
      {"base/yaml", {"base", "base/text"}},
      {"base/image", {"base", "base/text"}},
      {"robot/logs", {"robot", "robot/logs/own", "robot/logs/foreign"}},
      {"robot/logs/own", {"robot"}},
      {"robot/logs/foreign", {"robot", "robot/logs/own"}},
      {"robot/logs/foreign/module", {"robot", "robot/logs/foreign"}},
      {"robot/protocols", {}},
      {"robot/drivers", {"robot", "robot/protocols", "robot/drivers/watch"}},
      {"robot/drivers/watch", {"robot"}},
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
      {"slam/mrpt", {}},
      {"slam/mrpt/module", {"slam/mrpt"}},
      {"slam/scan", {"slam/grid", "slam/mrpt"}},
      {"slam/*", {"slam", "slam/grid", "slam/scan"}},
      {"slam/robust",
       {"slam", "slam/grid", "slam/scan", "slam/robust/matching", "slam/robust/graph", "slam/robust/map",
        "slam/robust/tracking"}},
      {"slam/robust/matching", {"slam/grid"}},
      {"slam/robust/graph", {"slam/robust/matching"}},
      {"slam/robust/map", {"slam/grid", "slam/scan", "slam/robust/matching", "slam/robust/graph"}},
      {"slam/robust/tracking", {"slam", "slam/scan", "slam/robust/matching", "slam/robust/graph"}},
      {"slam/calibration", {"slam/grid", "slam/scan", "slam/robust/matching"}},
      {"explore/plan", {}},
      {"explore/caution", {"explore"}},
      {"explore/search", {"explore", "explore/plan"}},
      {"explore/motion", {"explore", "explore/plan"}},
      {"explore/stuck", {"explore", "explore/plan", "explore/caution"}},
      {"explore/*",
       {"explore", "explore/plan", "explore/caution", "explore/search", "explore/motion", "explore/stuck"}},
      {"slam/process", {"slam", "slam/grid", "slam/scan"}},
      {"slam/peers", {"slam", "slam/grid", "slam/scan", "slam/process", "slam/mrpt"}},
      {"scoring/maps", {"scoring/maps/colours"}},
      {"scoring/maps/colours", {}},
      {"scoring/maps/codecs", {"scoring/maps"}},
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
      {"scoring/pictures", {"scoring", "scoring/maps", "scoring/measures", "scoring/walls"}},
      {"scenarios/config", {}},
      {"scenarios/run", {"scenarios/config"}},
      {"scenarios/batch", {"scenarios/config", "scenarios/run"}},
      {"scenarios/benchmark", {"scenarios/config", "scenarios/run"}},
      {"scenarios/evidence", {"scenarios/batch"}},
      {"scenarios/hardware", {"scenarios/config", "scenarios/run"}},
      {"app/runs", {"app"}},
      {"app/maps", {"app"}},
      {"app/batch", {"app"}},
      {"app/robots", {"app"}},
  };
  return table;
}

/// Wings that nobody outside their room may include, doors apart.
const Folders& insides() {
  static const Folders table = {"explore/caution",
                                "explore/motion",
                                "explore/plan",
                                "explore/search",
                                "explore/stuck",
                                "robot/logs/own",
                                "robot/protocols",
                                "scoring/alignment",
                                "scoring/maps/colours",
                                "scoring/measures",
                                "scoring/proposals",
                                "scoring/rooms",
                                "scoring/walls",
                                "sim/body",
                                "sim/laser",
                                "slam/calibration",
                                "slam/grid",
                                "slam/mrpt",
                                "slam/mrpt/module",
                                "slam/peers",
                                "slam/process",
                                "slam/robust",
                                "slam/robust/graph",
                                "slam/robust/map",
                                "slam/robust/matching",
                                "slam/robust/tracking",
                                "slam/scan"};
  return table;
}

/// Wings of devices and of others' files, with those below them: who outside their room may include them. The core and
/// the simulator know a robot by its face alone.
const std::map<std::string, Folders>& reserved() {
  static const std::map<std::string, Folders> table = {
      {"robot/drivers", {"scenarios/hardware"}},
      {"robot/emulators", {"scenarios/hardware"}},
      {"robot/logs/foreign", {"scenarios/run", "scenarios/hardware"}},
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

/// The room that a test lies in: tests/unit/slam/paper tests slam; empty for what several rooms' tests use.
std::string tested_by(const std::string& folder) {
  static const std::regex test(R"re(tests/(?:unit|property)/([a-z]+)(?:/.*)?)re");
  std::smatch match;
  return std::regex_match(folder, match, test) ? match[1].str() : "";
}

/// Rooms that a folder may include. A test knows what its room knows, and the room itself.
Folders rooms_of(const std::string& folder) {
  const std::string tested = tested_by(folder);
  if (tested.empty()) return rooms().at(room_of(folder));
  Folders may{"tests"};
  const auto found = rooms().find(tested);
  if (found == rooms().end()) return may;  // of the tree itself
  may.insert(found->second.begin(), found->second.end());
  may.insert(tested);
  return may;
}

/// Benchmarks, fuzz targets and what tests have in common measure and plant the insides; a test those of its room.
bool sees_insides(const std::string& folder, const std::string& other) {
  const std::string room = room_of(folder), tested = tested_by(folder);
  return room == "bench" || room == "fuzz" || lies_in(folder, "tests/support") || tested == other;
}

/// The wing's row, or that of its room's kinds, or null.
const Folders* row_of(const std::string& wing) {
  const bool may_be_a_kind = std::count(wing.begin(), wing.end(), '/') == 1;
  for (const std::string& name : {wing, may_be_a_kind ? room_of(wing) + "/*" : wing}) {
    const auto found = wings().find(name);
    if (found != wings().end() && wing != room_of(wing)) return &found->second;
  }
  return nullptr;
}

/// A wing without a row of its own is a kind, or not known at all.
bool is_inside(const std::string& folder) {
  return insides().count(folder) == 1 ||
         (rooms().count(folder) == 0 && wings().count(folder) == 0 && room_of(folder) != "tests");
}

bool is_file(const std::string& name) { return fs::path(name).has_extension(); }

/// The wing that a test is of, and whose rights it has: that of tests/unit/slam/paper is slam/paper.
std::string subject_of(const std::string& folder) {
  const std::string tested = tested_by(folder);
  return tested.empty() ? folder : folder.substr(folder.find("/" + tested) + 1);
}

/// Whether a row of doors holds for a folder.
bool holds_for(const std::string& row, const std::string& folder) {
  return lies_in(folder, row) || lies_in(subject_of(folder), row);
}

bool is_a_door(const std::string& folder, const std::string& file) {
  return std::any_of(doors().begin(), doors().end(),
                     [&](const auto& row) { return holds_for(row.first, folder) && row.second.count(file) == 1; });
}

/// What is wrong with a file of `folder` including a file, or any file of a folder; empty: nothing.
std::string offence(const std::string& folder, const std::string& name) {
  if (is_a_door(folder, name)) return "";
  const std::string included = is_file(name) ? fs::path(name).parent_path().generic_string() : name;
  const std::string room = room_of(folder), other = room_of(included);
  if (rooms().count(room) == 0) return folder + " is not in the table of rooms";
  if (room != other) {
    if (rooms_of(folder).count(other) == 0)
      return (tested_by(folder).empty() ? room : folder) + " must not know " + name;
    if (!sees_insides(folder, other) && (is_inside(included) || !is_let_in(subject_of(folder), included)))
      return included + " is an inside of " + other;
    return "";
  }
  if (folder == included || folder == room) return "";
  if (room == "tests") return lies_in(included, "tests/support") ? "" : folder + " must not know " + included;
  if (room == "bench" || room == "fuzz" || room == "examples") return folder + " must not know " + included;
  const Folders* may = row_of(folder);
  if (may == nullptr) return folder + " is not in the table of wings";
  return may->count(included) == 1 ? "" : folder + " must not know " + included;
}

/// Our own files that a text in `folder` includes, in whatever way: in quotes or angle brackets, from the top or from
/// where it lies itself, by any ending, installed or not.
Folders included_files(std::istream& in, const std::string& folder) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])(?:rubble/)?([^">]+)[">])re");
  Folders files;
  std::string line;
  std::smatch match;
  while (std::getline(in, line)) {
    if (line.find("include") == std::string::npos || !std::regex_search(line, match, include)) continue;
    const std::string name = match[2];
    const bool relative = name[0] == '.' || name.find('/') == std::string::npos;
    const fs::path path = relative ? (fs::path(folder) / name).lexically_normal() : fs::path(name).lexically_normal();
    // A library's header stands in angle brackets.
    const bool ours = rooms().count(room_of(path.generic_string())) == 1 && name.find('/') != std::string::npos;
    if (match[1] == "\"" || ours) files.insert(path.generic_string());
  }
  return files;
}

bool is_source(const fs::path& path) {
  static const Folders endings = {".h", ".hpp", ".hh", ".hxx", ".inl", ".ipp", ".c", ".cpp", ".cc", ".cxx"};
  return endings.count(path.extension().string()) == 1;
}

TEST(IncludeDirection, NoFileIncludesWhatItMayNotKnow) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  std::size_t files = 0;
  std::set<std::pair<std::string, std::string>> unused;
  for (const auto& [folder, headers] : doors())
    for (const std::string& header : headers) unused.emplace(folder, header);
  for (const auto& [room, may] : rooms()) {
    ASSERT_TRUE(fs::is_directory(top / room)) << room;
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      if (!is_source(entry.path())) continue;
      ++files;
      const std::string folder = fs::relative(entry.path().parent_path(), top).generic_string();
      std::ifstream in(entry.path());
      for (const auto& included : included_files(in, folder)) {
        EXPECT_EQ(offence(folder, included), "") << entry.path() << " includes " << included;
        for (const auto& [guest, headers] : doors())
          if (holds_for(guest, folder)) unused.erase({guest, included});
      }
    }
  }
  EXPECT_GT(files, 900u);
  for (const auto& [folder, header] : unused) ADD_FAILURE() << folder << " has a door to " << header << " in vain";
}

/// Wings that the rows lead to from one, themselves apart.
Folders reached_from(const std::string& start) {
  Folders seen;
  std::vector<std::string> left{start};
  while (!left.empty()) {
    const auto row = wings().find(left.back());
    left.pop_back();
    if (row == wings().end()) continue;
    for (const std::string& wing : row->second)
      if (seen.insert(wing).second) left.push_back(wing);
  }
  return seen;
}

TEST(IncludeDirection, NoTwoWingsKnowEachOtherThroughOthers) {
  // The faces of a room apart, wings form layers: following the table never leads back, not to one below either.
  for (const auto& [start, may] : wings()) EXPECT_EQ(reached_from(start).count(start), 0u) << start;
  EXPECT_EQ(reached_from("scenarios/evidence").count("scenarios/config"), 1u);
}

/// Folders whose files the table of a room's kinds includes.
Folders kinds_of(const std::string& table) {
  std::ifstream in(fs::path(RUBBLE_SOURCE_DIR) / table);
  Folders folders;
  for (const std::string& file : included_files(in, room_of(table)))
    folders.insert(fs::path(file).parent_path().generic_string());
  return folders;
}

/// A row of its own, or one of a kind that can be chosen.
bool is_known(const std::string& wing) {
  static const Folders kinds = [] {
    Folders all = kinds_of("slam/mappers.cpp");
    all.merge(kinds_of("explore/explorers.cpp"));
    return all;
  }();
  return wings().count(wing) == 1 || (row_of(wing) != nullptr && kinds.count(wing) == 1);
}

TEST(IncludeDirection, EveryWingIsInTheTable) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  for (const auto& [room, may] : rooms()) {
    if (room == "bench" || room == "fuzz" || room == "examples" || room == "tests") continue;
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      if (!is_source(entry.path())) continue;
      const std::string folder = fs::relative(entry.path().parent_path(), top).generic_string();
      EXPECT_TRUE(folder == room || is_known(folder)) << folder;
    }
  }
  EXPECT_TRUE(is_known("slam/paper") && is_known("explore/paper"));
  for (const char* wing :
       {"slam/yours", "slam/robust/yours", "explore/paper/yours", "app/yours", "robot/drivers/yours"})
    EXPECT_FALSE(is_known(wing)) << wing;
}

/// What a file includes, of our own files and of libraries; read once.
const std::vector<std::string>& includes_of(const fs::path& path) {
  static std::map<fs::path, std::vector<std::string>> known;
  const auto [entry, is_new] = known.try_emplace(path);
  if (is_new) {
    static const std::regex include(R"re(^\s*#\s*include\s*[<"]([^">]+)[">])re");
    std::ifstream in(path);
    std::string line;
    std::smatch match;
    while (std::getline(in, line))
      if (line.find("include") != std::string::npos && std::regex_search(line, match, include))
        entry->second.push_back(match[1]);
  }
  return entry->second;
}

/// Everything that a header brings in, of our own files and of libraries.
void gather(const fs::path& top, const std::string& name, Folders& seen) {
  for (const std::string& included : includes_of(top / name))
    if (seen.insert(included).second) gather(top, included, seen);
}

/// Whether a header brings in, through others, a file of the folder or of one below it.
bool leads_to(const fs::path& top, const std::string& header, const std::string& folder) {
  Folders seen;
  gather(top, header, seen);
  return std::any_of(seen.begin(), seen.end(), [&](const std::string& file) { return lies_in(file, folder); });
}

TEST(IncludeDirection, NoDoorLeadsBack) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  for (const auto& [folder, headers] : doors())
    for (const std::string& header : headers) {
      EXPECT_TRUE(fs::exists(top / header)) << header;
      EXPECT_FALSE(leads_to(top, header, folder)) << header << " leads back to " << folder;
    }
  EXPECT_TRUE(leads_to(top, "slam/paper/paper_mapper.h", "slam/grid"));
}

TEST(IncludeDirection, NobodyOutsideTheBodySeesBox2D) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(top / "sim")) {
    const std::string file = fs::relative(entry.path(), top).generic_string();
    if (!is_source(entry.path()) || lies_in(file, "sim/body")) continue;
    Folders seen;
    gather(top, file, seen);
    EXPECT_EQ(seen.count("box2d/box2d.h"), 0u) << file;
  }
  Folders of_the_body;
  gather(top, "sim/body/chassis.h", of_the_body);
  EXPECT_EQ(of_the_body.count("box2d/box2d.h"), 1u);
}

TEST(IncludeDirection, FacesBringNoLibraryOfTheInsides) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  static const std::regex heavy(R"re(^(opencv2/|Eigen/|box2d/|nlohmann/json\.hpp|mrpt/(obs|slam|maps)/))re");
  std::vector<fs::path> faces = {top / "sim/sim_robot.h", top / "sim/sim_team.h"};
  for (const char* room : {"robot", "slam", "explore", "scoring"})
    for (const auto& entry : fs::directory_iterator(top / room)) faces.push_back(entry.path());
  for (const char* room : {"base", "arenas", "scenarios", "app"})  // with all their wings
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) faces.push_back(entry.path());
  std::size_t headers = 0;
  for (const fs::path& face : faces) {
    if (face.extension() != ".h") continue;
    ++headers;
    Folders seen;
    gather(top, fs::relative(face, top).generic_string(), seen);
    for (const std::string& included : seen)
      EXPECT_FALSE(std::regex_search(included, heavy)) << face << " " << included;
  }
  EXPECT_GT(headers, 100u);
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
      if (!is_source(entry.path()) || room == "bench" || room == "tests") continue;
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
      "#include \"../../scoring/scorecard.cpp\"\n#include <rubble/explore/explorer.h>\n");
  EXPECT_EQ(included_files(planted, "slam/paper"),
            (Folders{"arenas/truth/truth_map.h", "slam/mapper.h", "slam/paper/particle.h", "sim/laser/rays.hpp",
                     "scoring/scorecard.cpp", "explore/explorer.h"}));
  EXPECT_EQ(offence("slam/paper", "arenas/truth/truth_map.h"), "slam must not know arenas/truth/truth_map.h");
  EXPECT_EQ(offence("slam/grid", "slam/paper"), "slam/grid must not know slam/paper");
  EXPECT_EQ(offence("slam/robust/matching", "slam/robust/graph"),
            "slam/robust/matching must not know slam/robust/graph");
  EXPECT_EQ(offence("slam/robust/graph", "slam/robust/map"), "slam/robust/graph must not know slam/robust/map");
  EXPECT_EQ(offence("slam/robust/map", "slam/robust"), "slam/robust/map must not know slam/robust");
  EXPECT_EQ(offence("scenarios/run", "slam/robust/map"), "slam/robust/map is an inside of slam");
  for (const char* wing : {"scoring/alignment", "scoring/measures", "scoring/walls"})
    EXPECT_EQ(offence("scenarios/run", wing), std::string(wing) + " is an inside of scoring");
  for (const char* wing : {"slam/calibration", "slam/process", "slam/grid", "slam/scan", "slam/paper"})
    EXPECT_EQ(offence("scenarios/run", wing), std::string(wing) + " is an inside of slam");
  EXPECT_EQ(offence("explore", "slam"), "");
  EXPECT_EQ(offence("slam", "slam/paper"), "");
  EXPECT_EQ(offence("scoring/alignment", "scoring/league"), "scoring/alignment must not know scoring/league");
  EXPECT_EQ(offence("scoring/yours", "scoring"), "scoring/yours is not in the table of wings");
}

TEST(IncludeDirection, TheAppSeesTheHeadersThatAreNamedAndNoOther) {
  EXPECT_EQ(offence("app/maps", "scoring/scorecard.h"), "");
  EXPECT_EQ(offence("app/maps", "scoring/maps/pois.h"), "app must not know scoring/maps/pois.h");
  EXPECT_EQ(offence("app/maps", "scoring/alignment/pose_search.h"),
            "app must not know scoring/alignment/pose_search.h");
  EXPECT_EQ(offence("app/runs", "scoring/scorecard.h"), "app must not know scoring/scorecard.h");
  EXPECT_EQ(offence("app", "sim/sim_robot.h"), "app must not know sim/sim_robot.h");
  EXPECT_EQ(offence("app/robots", "robot/drivers/port.h"), "");
  EXPECT_EQ(offence("app/robots", "robot/drivers/pioneer.h"), "app must not know robot/drivers/pioneer.h");
  EXPECT_EQ(offence("app/batch", "scenarios/batch/batch.h"), "");
  EXPECT_EQ(offence("app/batch", "app/maps/score_tools.h"), "app/batch must not know app/maps");
  EXPECT_EQ(offence("scenarios/run", "app/terminal.h"), "scenarios must not know app/terminal.h");
}

TEST(IncludeDirection, WhatUsesTheRoomsHasItsBordersToo) {
  EXPECT_EQ(offence("fuzz", "slam/process/message.h"), "");
  EXPECT_EQ(offence("fuzz", "app/command.h"), "fuzz must not know app/command.h");
  EXPECT_EQ(offence("bench", "sim/laser/rays.h"), "");
  EXPECT_EQ(offence("bench", "fuzz/harness.h"), "bench must not know fuzz/harness.h");
  EXPECT_EQ(offence("examples/library", "slam/mapper.h"), "");
  EXPECT_EQ(offence("examples/library", "slam/grid/count_map.h"), "slam/grid is an inside of slam");
  EXPECT_EQ(offence("examples/library", "sim/sim_robot.h"), "examples must not know sim/sim_robot.h");
  EXPECT_EQ(offence("examples/own_base", "robot/drivers/base_driver.h"), "");
  EXPECT_EQ(offence("examples/own_base", "robot/drivers/pioneer.h"), "robot/drivers is an inside of robot");
  EXPECT_EQ(offence("tests/unit/slam/paper", "slam/scan/tilt_track.h"), "");
  EXPECT_EQ(offence("tests/unit/slam/paper", "sim/sim_robot.h"), "tests/unit/slam/paper must not know sim/sim_robot.h");
  EXPECT_EQ(offence("tests/unit/explore/plan", "slam/scan/tilt_track.h"), "slam/scan is an inside of slam");
  EXPECT_EQ(offence("tests/unit/scenarios/hardware", "robot/emulators/line_faults.h"), "");
  EXPECT_EQ(offence("tests/unit/scenarios/batch", "robot/emulators/line_faults.h"),
            "robot/emulators is an inside of robot");
  EXPECT_EQ(offence("tests/unit/base", "robot/model.h"), "tests/unit/base must not know robot/model.h");
  EXPECT_EQ(offence("tests/property/sim", "tests/support/sim_arena.h"), "");
  EXPECT_EQ(offence("tests/property/sim", "tests/unit/sim/parts.h"), "tests/property/sim must not know tests/unit/sim");
  EXPECT_EQ(offence("station", "robot/robot.h"), "station is not in the table of rooms");
}

TEST(IncludeDirection, AWatchSeesABaseByItsInterfaceAlone) {
  EXPECT_EQ(offence("robot/drivers/watch", "robot/drivers/base_driver.h"), "");
  for (const char* header : {"robot/drivers/real_robot.h", "robot/drivers/pioneer.h", "robot/drivers/scan_queue.h"})
    EXPECT_EQ(offence("robot/drivers/watch", header), "robot/drivers/watch must not know robot/drivers") << header;
  EXPECT_EQ(offence("robot/logs/own", "robot/logs/log.h"), "");
  EXPECT_EQ(offence("robot/logs/own", "robot/logs/yours.h"), "robot/logs/own must not know robot/logs");
}

TEST(IncludeDirection, OnlyWhoRunsRobotsSeesTheirDevices) {
  for (const char* wing : {"robot/drivers", "robot/drivers/scip", "robot/emulators", "robot/emulators/scip",
                           "robot/protocols", "robot/logs/foreign"}) {
    const std::string inside = std::string(wing) + " is an inside of robot";
    for (const char* core : {"slam", "slam/robust", "explore", "explore/search", "sim", "sim/body", "scenarios/batch"})
      EXPECT_EQ(offence(core, wing), inside) << core;
    EXPECT_EQ(offence("app", wing), std::string("app must not know ") + wing);
    for (const char* runs : {"bench", "fuzz"}) EXPECT_EQ(offence(runs, wing), "") << runs << " and " << wing;
  }
  EXPECT_EQ(offence("scenarios/hardware", "robot/drivers/scip"), "");
  EXPECT_EQ(offence("scenarios/hardware", "robot/emulators"), "");
  EXPECT_EQ(offence("scenarios/hardware", "robot/protocols"), "robot/protocols is an inside of robot");
  EXPECT_EQ(offence("scenarios/run", "robot/drivers"), "robot/drivers is an inside of robot");
  EXPECT_EQ(offence("scenarios/run", "robot/logs/foreign"), "");
  EXPECT_EQ(offence("slam/mrpt/module", "robot/logs/foreign/module/to_mrpt.h"), "");
  EXPECT_EQ(offence("slam/peers", "robot/logs/foreign/carmen.h"), "robot/logs/foreign is an inside of robot");
  for (const char* face : {"robot", "robot/logs"}) EXPECT_EQ(offence("slam/robust", face), "");
}

TEST(IncludeDirection, ANewKindNeedsNoRowAndSeesOnlyWhatAllKindsSee) {
  EXPECT_EQ(offence("slam/yours", "slam/scan"), "");
  EXPECT_EQ(offence("slam/yours", "slam"), "");
  EXPECT_EQ(offence("slam/yours", "slam/robust"), "slam/yours must not know slam/robust");
  EXPECT_EQ(offence("slam/yours", "sim"), "slam must not know sim");
  EXPECT_EQ(offence("slam/robust/yours", "slam/scan"), "slam/robust/yours is not in the table of wings");
  EXPECT_EQ(offence("slam/grid", "slam/yours"), "slam/grid must not know slam/yours");
  EXPECT_EQ(offence("scenarios/run", "slam/yours"), "slam/yours is an inside of slam");
  EXPECT_EQ(offence("explore/yours", "explore/search"), "");
  EXPECT_EQ(offence("explore/yours", "slam/grid/count_map.h"), "");
  EXPECT_EQ(offence("explore/yours", "slam/grid/scan_polygon.h"), "slam/grid is an inside of slam");
  EXPECT_EQ(offence("explore/yours", "slam/robust"), "slam/robust is an inside of slam");
}

}  // namespace
}  // namespace rubble
