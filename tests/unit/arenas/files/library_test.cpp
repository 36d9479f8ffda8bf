#include <gtest/gtest.h>

#include <string>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"
#include "tests/support/source_dir.h"

namespace rubble::arenas {
namespace {

const std::string kFolder = std::string(RUBBLE_SOURCE_DIR) + "/arenas/shipped/";

std::vector<std::string> arena_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Library, EveryArenaFileCanBeUsed) {
  ASSERT_GE(arena_files().size(), 3u);
  for (const std::string& file : arena_files()) {
    SCOPED_TRACE(file);
    const Arena arena = load_arena(file);
    EXPECT_NO_THROW(check(arena, file));
    EXPECT_FALSE(arena.victims.empty());
    EXPECT_EQ(std::filesystem::path(file).stem().string().substr(0, 4), arena.name.substr(0, 4));
  }
}

TEST(Library, EveryPalletOfAnArenaFileIsInItsTruthMap) {
  for (const std::string& file : arena_files()) {
    SCOPED_TRACE(file);
    const Arena arena = load_arena(file);
    const OccupancyGrid map = truth_map(arena);
    for (const FloorPatch& patch : arena.floor) {
      const mrpt::math::TPoint2D p{patch.outline[0].x + 0.55, patch.outline[0].y + 0.55};
      EXPECT_EQ(map[map.cell(p)], Occupancy::Free) << p.x << " " << p.y;
    }
  }
}

TEST(Library, TheYellowArenaIsThatOfSeedOne) {
  std::ifstream file(kFolder + "yellow_8x8.yaml");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), generate_arena({}));
}

TEST(Library, TheExampleOfTheManualCanBeUsed) {
  std::ifstream file(std::string(RUBBLE_SOURCE_DIR) + "/docs/arenas.md");
  std::ostringstream text;
  text << file.rdbuf();
  const std::size_t begin = text.str().find("```yaml\n") + 8;
  const std::size_t end = text.str().find("```", begin);
  const Arena arena = parse_arena(text.str().substr(begin, end - begin), "docs/arenas.md");
  EXPECT_EQ(arena.victims.size(), 1u);
}

}  // namespace
}  // namespace rubble::arenas
