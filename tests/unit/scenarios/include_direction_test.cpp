// The borders between the rooms: which room may include which. The truth must not leak into the mapper.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace rubble {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>>& allowed() {
  static const std::map<std::string, std::set<std::string>> rooms = {
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
  return rooms;
}

/// Rooms that the file includes, found in lines `#include "room/..."`.
std::set<std::string> included_rooms(const fs::path& file) {
  static const std::regex include(R"re(^\s*#\s*include\s*"([a-z]+)/)re");
  std::set<std::string> rooms;
  std::ifstream in(file);
  std::string line;
  std::smatch match;
  while (std::getline(in, line))
    if (std::regex_search(line, match, include)) rooms.insert(match[1]);
  return rooms;
}

TEST(IncludeDirection, NoRoomIncludesARoomItMayNotKnow) {
  std::size_t files = 0;
  for (const auto& [room, may] : allowed()) {
    const fs::path folder = fs::path(RUBBLE_SOURCE_DIR) / room;
    ASSERT_TRUE(fs::is_directory(folder)) << folder;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      for (const auto& included : included_rooms(entry.path()))
        EXPECT_TRUE(included == room || may.count(included) == 1)
            << entry.path() << " includes " << included << "/, which " << room << " must not know";
    }
  }
  EXPECT_GT(files, 30u);
}

TEST(IncludeDirection, TheReaderSeesIncludes) {
  EXPECT_EQ(included_rooms(fs::path(RUBBLE_SOURCE_DIR) / "scenarios" / "core.h"),
            (std::set<std::string>{"explore", "robot", "scenarios", "slam"}));
}

}  // namespace
}  // namespace rubble
