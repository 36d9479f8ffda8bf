#include "arenas/files/arena_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "arenas/model/geometry.h"
#include "base/angle.h"
#include "base/error.h"
#include "tests/support/arenas_draw.h"

namespace rubble::arenas {
namespace {

using testing::arena;
using testing::arena_text;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string error_of(const std::string& text) {
  try {
    parse_arena(text, "f.yaml");
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

/// The room the error tests spoil one line of.
std::string room(const std::string& pallets, const std::string& more = "") {
  return arena_text({"+---+---+", pallets.c_str(), "+---+---+"}, more);
}

TEST(ArenaFile, OriginIsTheSouthWestCornerAndTheTopRowIsNorth) {
  const Arena a = arena({"+---+---+",  //
                         "| .     |",  //
                         "+   +---+",  //
                         "| .   S |",  //
                         "+---+---+"});
  EXPECT_DOUBLE_EQ(a.start.x, 1.8);
  EXPECT_DOUBLE_EQ(a.start.y, 0.6);
  ASSERT_EQ(a.floor.size(), 3u);
  EXPECT_EQ(floor_height(a, {0.6, 1.8}), 0.0);
  EXPECT_EQ(floor_height(a, {1.8, 1.8}), -INFINITY) << "a blank pallet has no floor";
  EXPECT_NEAR(a.min_corner.x, -0.01, 1e-12);
  EXPECT_NEAR(a.max_corner.y, 2.41, 1e-12);
}

TEST(ArenaFile, RampsRiseToTheSideTheirGlyphPointsTo) {
  const double rise = 1.2 * std::tan(deg_to_rad(10.0));
  const struct {
    char glyph;
    double gx, gy;
  } cases[] = {{'^', 0, 1}, {'v', 0, -1}, {'>', 1, 0}, {'<', -1, 0}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.glyph);
    const Arena a = parse_arena(room(std::string("| ") + c.glyph + "   S |"), "f.yaml");
    const double low = floor_height(a, {0.6 - 0.59 * c.gx, 0.6 - 0.59 * c.gy});
    const double high = floor_height(a, {0.6 + 0.59 * c.gx, 0.6 + 0.59 * c.gy});
    EXPECT_NEAR(high - low, rise * 1.18 / 1.2, 1e-12);
    EXPECT_NEAR(floor_height(a, {0.6, 0.6}), 0.5 * rise, 1e-12);
  }
}

TEST(ArenaFile, DigitRaisesThePalletByThatManyRises) {
  const Arena a = parse_arena(room("| >2  S |", "ramp_deg: 15\n"), "f.yaml");
  EXPECT_NEAR(floor_height(a, {0.6, 0.6}), 2.5 * 1.2 * std::tan(deg_to_rad(15.0)), 1e-12);
}

TEST(ArenaFile, WallsInLineAreOneSolid) {
  const Arena a = arena({"+---+---+",  //
                         "| .   S |",  //
                         "+---+---+"});
  ASSERT_EQ(a.solids.size(), 4u);
  for (const Solid& wall : a.solids) {
    const double length = signed_area(wall.outline) / 0.02;
    EXPECT_TRUE(std::abs(length - 1.2) < 1e-9 || std::abs(length - 2.4) < 1e-9);
    EXPECT_EQ(wall.z_bottom, 0.0);
    EXPECT_EQ(wall.z_top, 1.2);
  }
}

TEST(ArenaFile, MarksNamePlaces) {
  const Arena a = arena({"+---+---+---+",  //
                         "|P. |P^  S. |",  //
                         "+---+---+---+"},
                        "paper: [{cell: P, dy_m: 0.1}]\n");
  ASSERT_EQ(a.sheets.size(), 2u);
  EXPECT_TRUE(contains(a.sheets[0].outline, {0.6, 0.7}));
  EXPECT_TRUE(contains(a.sheets[1].outline, {1.8, 0.7}));
}

TEST(ArenaFile, VictimBoxStandsAtItsWallAndIsOpenToTheRoom) {
  const Arena a =
      parse_arena(room("|A.   S |", "victims: [{name: anna, cell: A, wall: west, cues: [sound]}]\n"), "f.yaml");
  ASSERT_EQ(a.victims.size(), 1u);
  const Victim& anna = a.victims[0];
  EXPECT_NEAR(anna.position.x, 0.01 + 0.2, 1e-12);
  EXPECT_NEAR(anna.position.y, 0.6, 1e-12);
  EXPECT_NEAR(anna.position.z, 0.2, 1e-12);
  EXPECT_NEAR(anna.facing, 0.0, 1e-12);
  EXPECT_TRUE(anna.sound);
  EXPECT_FALSE(anna.appearance || anna.heat || anna.co2);
  const auto blocked = [&](double x, double y, double z = 0.35) {
    for (const Solid& s : a.solids) {
      if (s.element == "victim_box" && contains(s.outline, {x, y}) && s.z_bottom <= z && z <= s.z_top) return true;
    }
    return false;
  };
  EXPECT_TRUE(blocked(0.21, 0.6, 0.39)) << "lid";
  EXPECT_FALSE(blocked(0.21, 0.6, 0.41)) << "above the lid";
  EXPECT_TRUE(blocked(0.015, 0.6)) << "back";
  EXPECT_TRUE(blocked(0.3, 0.405)) << "side";
  EXPECT_TRUE(blocked(0.3, 0.795)) << "side";
  EXPECT_FALSE(blocked(0.405, 0.6)) << "front";
  EXPECT_FALSE(blocked(0.21, 0.6)) << "inside";
}

TEST(ArenaFile, VictimOnARampStandsAboveItsFloor) {
  const Arena a =
      parse_arena(room("|A>  S. |", "victims: [{name: anna, cell: A, wall: east, height_m: 0.3}]\n"), "f.yaml");
  const Victim& anna = a.victims[0];
  EXPECT_NEAR(anna.position.z, 0.3 + floor_height(a, {anna.position.x, anna.position.y}), 1e-12);
}

TEST(ArenaFile, FreePartsLieWhereTheyAreGiven) {
  const Arena a = parse_arena(room("| .   S |",
                                   "walls: [{from_m: [0.2, 0.2], to_m: [0.8, 1.0], height_m: 0.3, bottom_m: 0.1}]\n"
                                   "boxes: [{x_m: 0.3, y_m: 0.9, length_m: 0.2, height_m: 0.5}]\n"
                                   "floors: [{x_m: 5, y_m: 5, length_m: 2, width_m: 1, angle_deg: 90, slope_deg: 45}]\n"
                                   "paper: [{outline_m: [0,0, 0,1, 1,0], friction: 0.1}]\n"
                                   "balls: [{x_m: 0.6, y_m: 0.2, radius_m: 0.12}]\n"),
                              "f.yaml");
  ASSERT_EQ(a.solids.size(), 6u);
  EXPECT_NEAR(signed_area(a.solids[4].outline), 0.02, 1e-12);
  EXPECT_NEAR(a.solids[4].z_top, 0.4, 1e-12);
  EXPECT_NEAR(signed_area(a.solids[5].outline), 0.04, 1e-12);
  EXPECT_NEAR(floor_height(a, {5.4, 4.0}), 0.0, 1e-9);
  EXPECT_NEAR(floor_height(a, {4.6, 6.0}), 2.0, 1e-9);
  EXPECT_EQ(floor_height(a, {5.6, 5.0}), -INFINITY);
  EXPECT_NEAR(signed_area(a.sheets[0].outline), 0.5, 1e-12) << "either sense of rotation is good";
  EXPECT_NEAR(a.balls[0].mass, 0.03, 1e-12);
}

TEST(ArenaFile, LeaguePartsStandWhereTheyArePut) {
  const Arena a = arena({"+---+---+---+",  //
                         "|A.  B.   S |",  //
                         "+---+---+---+"},
                        "elements:\n"
                        "  - {type: stepfield_red_diagonal, cell: A}\n"
                        "  - {type: wall_holes1, cell: B, rotation_deg: 180}\n"
                        "  - {type: victim_with_box1, cell: B, rotation_deg: 180, mount_point: 1}\n");
  EXPECT_NEAR(floor_height(a, {0.15, 0.15}), 0.45, 1e-12);
  ASSERT_EQ(a.victims.size(), 1u);
  EXPECT_NEAR(a.victims[0].position.z, 0.6, 1e-12) << "at the middle hole";
  EXPECT_NEAR(a.victims[0].facing, -kPi / 2, 1e-12);
  EXPECT_THAT(error_of(room("|A.   S |", "elements: [{type: stairs, cell: A}]\n")), HasSubstr("stairs_120"));
  EXPECT_THAT(error_of(room("|A.   S |", "elements: [{type: flat, cell: A, throw: 2}]\n")), HasSubstr("no columns"));
}

TEST(ArenaFile, AStepFieldIsThrownAsItsEntrySays) {
  const auto heights = [](const std::string& entry) {
    const Arena a = arena({"+---+---+", "|A.  S. |", "+---+---+"},
                          "elements: [{type: stepfield_orange_diagonal, cell: A" + entry + "}]\n");
    std::vector<double> z;
    for (const FloorPatch& patch : a.floor) z.push_back(patch.z);
    return z;
  };
  EXPECT_EQ(heights(""), heights(", throw: 1"));
  EXPECT_NE(heights(""), heights(", throw: 2"));
}

TEST(ArenaFile, ErrorsPointIntoTheDrawing) {
  EXPECT_THAT(error_of(room("| .   ? |")), StartsWith("f.yaml:3:9: '?' is no glyph"));
  EXPECT_THAT(error_of(room("| .^  S |")), StartsWith("f.yaml:3:6: a second floor glyph"));
  EXPECT_THAT(error_of(room("|.12  S |")), StartsWith("f.yaml:3:6: a second digit"));
  EXPECT_THAT(error_of(room("|AB   S |")), StartsWith("f.yaml:3:5: a second letter"));
  EXPECT_THAT(error_of(room("| . - S |")), StartsWith("f.yaml:3:7: '-' between two pallets"));
  EXPECT_THAT(error_of(room("| S   S |")), StartsWith("f.yaml:3:9: a second S"));
  EXPECT_THAT(error_of(room("|A.   S |")), StartsWith("f.yaml:3:5: nothing below refers to the letter 'A'"));
  EXPECT_THAT(error_of(arena_text({"+--", "| S |", "+---+"})), StartsWith("f.yaml:2:6: half a wall"));
  EXPECT_THAT(error_of(arena_text({"+---+", "| S |", "+-=-+"})), StartsWith("f.yaml:4:5: '=' in a row of walls"));
  EXPECT_THAT(error_of(arena_text({"+---+", "| S |", "+----"})), StartsWith("f.yaml:4:7: '-' where a post"));
  EXPECT_THAT(error_of(arena_text({"+---+", "| S |"})), HasSubstr("at least three lines"));
  EXPECT_THAT(error_of(arena_text({"+---+", "| S |", "+---+", "| . |"})), HasSubstr("row of posts and walls below"));
}

TEST(ArenaFile, ErrorsNameKeyAndRemedy) {
  EXPECT_THAT(error_of(room("| .   . |")), HasSubstr("where does the robot start?"));
  EXPECT_THAT(error_of(room("| .   . |", "start: {x_m: 0.1, y_m: 0.6}\n")),
              StartsWith("f.yaml:5:1: start (0.10, 0.60)"));
  EXPECT_THAT(error_of(room("| .   S |", "start: {x_m: 0.6, y_m: 0.6}\n")), HasSubstr("remove x_m and y_m, or the S"));
  EXPECT_THAT(error_of(room("| .   S |", "balls: [{x_m: 1.8, y_m: 0.6}]\n")), StartsWith("f.yaml:3:9: start"));
  EXPECT_THAT(error_of(room("| .   S |", "ramp_degg: 10\n")), HasSubstr("f.yaml:5:1"));
  EXPECT_THAT(error_of(room("| .   S |", "ramp_deg: 80\n")), StartsWith("f.yaml:5:"));
  EXPECT_THAT(error_of(room("| .   S |", "paper: [{cell: Q}]\n")), HasSubstr("no pallet of the drawing is marked 'Q'"));
  EXPECT_THAT(error_of(room("| .   S |", "paper: [{friction: 0.2}]\n")), HasSubstr("where is it?"));
  EXPECT_THAT(error_of(room("| .   S |", "paper: [{outline_m: [0, 0, 1, 0]}]\n")), HasSubstr("three or more corners"));
  EXPECT_THAT(error_of(room("| .   S |", "paper: [{outline_m: [0,0,2,1,2,0,0,1]}]\n")), HasSubstr("crosses itself"));
  EXPECT_THAT(error_of(room("| .   S |", "walls: [{from_m: [1, 1], to_m: [1, 1]}]\n")), HasSubstr("no length"));
  EXPECT_THAT(error_of(room("|A. |A. |", "victims: [{name: a, cell: A, wall: east}]\n")),
              HasSubstr("letter of its own"));
  EXPECT_THAT(error_of(room("|A.   S |", "victims: [{name: a, cell: A, wall: up}]\n")), StartsWith("f.yaml:5:"));
  EXPECT_THAT(error_of(room("|A.   S |", "victims: [{name: a, cell: A, wall: east, cues: [smell]}]\n")),
              HasSubstr("unknown cue 'smell'"));
}

TEST(ArenaFile, MissingFileIsAnInputErrorThatNamesIt) {
  try {
    load_arena("/nowhere/x.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/x.yaml"));
  }
}

}  // namespace
}  // namespace rubble::arenas
