// What starts threads is seen by ThreadSanitizer: `./rubble test --sanitize=thread` chooses by room.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/source_dir.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The room's tests, as the test programs are called.
std::string tests_of(const fs::path& file) {
  const std::string path = file.generic_string();
  for (const auto& [folder, tests] :
       {std::pair{"robot/drivers/", "drivers"}, std::pair{"robot/emulators/", "emulators"},
        std::pair{"scenarios/hardware/", "hardware"}})
    if (path.rfind(folder, 0) == 0) return tests;
  return path.substr(0, path.find('/'));
}

TEST(ThreadSanitizer, SeesEveryRoomThatStartsThreads) {
  const fs::path top = RUBBLE_SOURCE_DIR;
  const std::string script = content_of(top / "rubble");
  const std::size_t begin = script.find("sanitized_tests tsan -L '^(");
  ASSERT_NE(begin, std::string::npos);
  std::istringstream list(
      script.substr(script.find('(', begin) + 1, script.find(")$'", begin) - script.find('(', begin) - 1));
  std::set<std::string> seen;
  for (std::string room; std::getline(list, room, '|');) seen.insert(room);

  std::set<std::string> threaded;
  for (const char* room : {"base", "robot", "arenas", "sim", "slam", "explore", "scoring", "scenarios", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".cpp" && ending != ".h") continue;
      const std::string text = content_of(entry.path());
      for (const char* word : {"std::thread", "std::async", "pthread_create", "parallel_for"})
        if (text.find(word) != std::string::npos) threaded.insert(tests_of(fs::relative(entry.path(), top)));
    }
  EXPECT_GE(threaded.size(), 3u);
  for (const std::string& room : threaded) EXPECT_EQ(seen.count(room), 1u) << room << " starts threads";
}

}  // namespace
}  // namespace rubble
