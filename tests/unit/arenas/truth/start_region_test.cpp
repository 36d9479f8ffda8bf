#include "arenas/truth/start_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"

namespace rubble::arenas {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

std::optional<std::string> note_of(const std::string& maze) {
  return small_start(parse_arena("maze: |\n" + maze, "drawn"));
}

TEST(StartRegion, ASealedRoomIsToldWithABetterPlace) {
  const auto note = note_of("  +---+---+---+\n  |S. |.   .  |\n  +---+---+---+\n");
  ASSERT_TRUE(note);
  EXPECT_THAT(*note, HasSubstr("from the start (0.60, 0.60) the robot gets to 0.5 m2"));
  EXPECT_THAT(*note, HasSubstr("move the start"));
}

TEST(StartRegion, TheShareOfTheFloorAndTheKeyAreNamed) {
  const auto note = note_of("  +---+---+---+\n  |S. |.   .  |\n  +---+---+---+\n");
  ASSERT_TRUE(note);
  EXPECT_THAT(*note, ContainsRegex("gets to 0\\.5 m2 of floor, 2[0-9] % of 1\\.[0-9] m2"));
  EXPECT_THAT(*note, ContainsRegex("with start: \\{x_m: [12]\\.[0-9]+, y_m: 0\\.[0-9]+\\}"));
}

TEST(StartRegion, OneOfManyRoomsAlikeIsToldThoughNoneIsBetter) {
  const auto note = note_of("  +---+---+---+\n  |S. | . | . |\n  +---+---+---+\n");
  ASSERT_TRUE(note);
  EXPECT_THAT(*note, HasSubstr("no larger part has room for a start"));
}

TEST(StartRegion, ARoomOfLessThanHalfOfTheFloorIsToldAlsoBesideNoneTwiceAsLarge) {
  const auto note = note_of(
      "  +---+---+---+---+---+---+---+---+\n"
      "  |S.   .   . | .   .   .   . | . |\n"
      "  +---+---+---+---+---+---+---+---+\n");
  ASSERT_TRUE(note);
  EXPECT_THAT(*note, HasSubstr("move the start"));
}

TEST(StartRegion, SoIsAPlatformWithoutAWayDown) {
  EXPECT_TRUE(note_of("  +---+---+---+\n  |S3  .   .  |\n  +---+---+---+\n"));
  EXPECT_FALSE(note_of("  +---+---+---+---+\n  |S1  <   .   .  |\n  +---+---+---+---+\n")) << "a ramp leads down";
}

TEST(StartRegion, NothingIsToldWhereNoOtherFloorIsLarger) {
  EXPECT_FALSE(note_of("  +---+---+---+\n  |S.   .   . |\n  +---+---+---+\n"));
  EXPECT_FALSE(note_of("  +---+---+\n  |S. | . |\n  +---+---+\n")) << "two rooms alike";
  EXPECT_FALSE(note_of("  +---+---+---+\n  |S.   .   1 |\n  +---+---+---+\n")) << "the platform is the smaller part";
}

/// Their towers stand apart, and are small.
TEST(StartRegion, GeneratedArenasHaveGoodStarts) {
  GenerateConfig config;
  for (const ArenaKind kind : {ArenaKind::Yellow, ArenaKind::Orange, ArenaKind::Red}) {
    config.kind = kind;
    for (config.seed = 1; config.seed <= 10; ++config.seed)
      EXPECT_FALSE(small_start(parse_arena(generate_arena(config), "generated")))
          << name_of(kind) << ", seed " << config.seed;
  }
}

}  // namespace
}  // namespace rubble::arenas
