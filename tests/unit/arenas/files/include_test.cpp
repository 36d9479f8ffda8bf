#include "arenas/files/include.h"
#include "tests/support/source_dir.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "arenas/files/arena_file.h"
#include "arenas/files/piece.h"
#include "base/error.h"

namespace rubble::arenas {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kShipped = std::string(RUBBLE_SOURCE_DIR) + "/arenas/shipped/";

class Include : public ::testing::Test {
 protected:
  Include()
      : folder_((fs::temp_directory_path() /
                 (std::string("rubble-include-") + ::testing::UnitTest::GetInstance()->current_test_info()->name()))
                    .string()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Include() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  Arena load(const std::string& text) const { return load_arena(write("arena.yaml", text)); }
  std::string error_of(const std::string& text) const {
    try {
      load(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::string folder_;
};

void expect_same_outline(const Outline& a, const Outline& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].x, b[i].x, tolerance);
    EXPECT_NEAR(a[i].y, b[i].y, tolerance);
  }
}

/// tolerance 0: bit by bit.
void expect_same(const Arena& a, const Arena& b, double tolerance) {
  EXPECT_NEAR(a.start.x, b.start.x, tolerance);
  EXPECT_NEAR(a.start.y, b.start.y, tolerance);
  EXPECT_NEAR(a.start.phi, b.start.phi, tolerance);
  EXPECT_EQ(a.floor_friction, b.floor_friction);
  ASSERT_EQ(a.floor.size(), b.floor.size());
  for (std::size_t i = 0; i < a.floor.size(); ++i) {
    expect_same_outline(a.floor[i].outline, b.floor[i].outline, tolerance);
    EXPECT_EQ(a.floor[i].z, b.floor[i].z);
    EXPECT_EQ(a.floor[i].gx, b.floor[i].gx);
    EXPECT_EQ(a.floor[i].gy, b.floor[i].gy);
    EXPECT_EQ(a.floor[i].friction, b.floor[i].friction);
  }
  ASSERT_EQ(a.solids.size(), b.solids.size());
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    expect_same_outline(a.solids[i].outline, b.solids[i].outline, tolerance);
    EXPECT_EQ(a.solids[i].z_top, b.solids[i].z_top);
    EXPECT_EQ(a.solids[i].element, b.solids[i].element);
  }
  ASSERT_EQ(a.sheets.size(), b.sheets.size());
  for (std::size_t i = 0; i < a.sheets.size(); ++i)
    expect_same_outline(a.sheets[i].outline, b.sheets[i].outline, tolerance);
  ASSERT_EQ(a.balls.size(), b.balls.size());
  for (std::size_t i = 0; i < a.balls.size(); ++i) EXPECT_NEAR(a.balls[i].position.x, b.balls[i].position.x, tolerance);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  ASSERT_EQ(a.victims.size(), b.victims.size());
  for (std::size_t i = 0; i < a.victims.size(); ++i) {
    EXPECT_EQ(a.victims[i].name, b.victims[i].name);
    EXPECT_NEAR(a.victims[i].position.x, b.victims[i].position.x, tolerance);
    EXPECT_NEAR(a.victims[i].position.y, b.victims[i].position.y, tolerance);
    EXPECT_NEAR(a.victims[i].facing, b.victims[i].facing, tolerance);
  }
}

/// Pallets and walls of [x0, x0 + columns) x [y0, y0 + rows).
Drawing cut(const Drawing& from, int x0, int y0, int columns, int rows) {
  Drawing part{Grid<DrawnCell>({columns, rows, 1.0, 0.0, 0.0}), {}, {}};
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x < columns; ++x) part.lying.push_back(from.wall_south(x0 + x, y0 + y) ? '-' : ' ');
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x <= columns; ++x) part.upright.push_back(from.wall_west(x0 + x, y0 + y) ? '|' : ' ');
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) part.cells[{x, y}] = from.cells[{x0 + x, y0 + y}];
  return part;
}

std::string maze_of(const Drawing& drawing) {
  std::string text = "maze: |\n";
  for (const std::string& line : draw(drawing)) text += "  " + line + "\n";
  return text;
}

/// The yellow arena cut into four, each quarter saved turned the other way: put together it is the same arena.
TEST_F(Include, APieceTurnedBackIsWhatWasCutOut) {
  const YamlMap yellow = YamlMap::load(kShipped + "yellow_8x8.yaml");
  const Drawing drawing = read_drawing(yellow, "maze");
  for (int quarters = 0; quarters < 4; ++quarters) {
    std::string text = "ramp_deg: 10\nstart: {heading_deg: 0}\ninclude:\n";
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(5, 0), std::pair(0, 3), std::pair(5, 3)}) {
      const Drawing part = cut(drawing, x, y, x == 0 ? 5 : 3, y == 0 ? 3 : 5);
      const std::string name = "part" + std::to_string(x) + std::to_string(y) + ".yaml";
      write(name, maze_of(turned(part, (4 - quarters) % 4)));
      text += "  - {file: " + name + ", at: [" + std::to_string(x) + ", " + std::to_string(y) +
              "], turn: " + std::to_string(90 * quarters) + "}\n";
    }
    const Arena whole = parse_arena("ramp_deg: 10\n" + maze_of(drawing), "whole");
    expect_same(load(text), whole, 1e-12);
  }
}

/// By hand: what stood in the north stands in the west, what lay along the east lies along the north.
TEST_F(Include, AQuarterTurnIsCounterClockwise) {
  write("piece.yaml",
        "maze: |\n"
        "  +---+---+\n"
        "  |A> | .\n"
        "  +   +---+\n"
        "victims:\n  - {name: anna, cell: A, dx_m: 0.1, wall: north}\n"
        "walls:\n  - {from_m: [0.2, 0.1], to_m: [1.4, 0.1]}\n"
        "boxes:\n  - {x_m: 2.0, y_m: 0.3, length_m: 0.3, width_m: 0.1}\n"
        "elements:\n  - {type: small_wall, x_m: 0.6, y_m: 0.6}\n"
        "paper:\n  - {outline_m: [1.3, 0.2, 1.6, 0.2, 1.6, 0.4]}\n");
  const Arena arena = load(
      "maze: |\n"
      "  +   +   +\n"
      "\n"
      "  +   +   +\n"
      "\n"
      "  +---+---+\n"
      "   S.   .\n"
      "  +---+---+\n"
      "include:\n  - {file: piece.yaml, at: [1, 1], turn: 90}\n");
  const Arena wanted = parse_arena(
      "maze: |\n"
      "  +   +   +\n"
      "      | . |\n"
      "  +   +---+\n"
      "      | ^\n"
      "  +---+---+\n"
      "   S.   .\n"
      "  +---+---+\n"
      "victims:\n  - {name: anna, x_m: 1.8, y_m: 1.9, wall: west}\n"
      "walls:\n  - {from_m: [2.3, 1.4], to_m: [2.3, 2.6]}\n"
      "boxes:\n  - {x_m: 2.1, y_m: 3.2, length_m: 0.3, width_m: 0.1, angle_deg: 90}\n"
      "elements:\n  - {type: small_wall, x_m: 1.8, y_m: 1.8, rotation_deg: -90}\n"
      "paper:\n  - {outline_m: [2.2, 2.5, 2.2, 2.8, 2.0, 2.8]}\n",
      "wanted");
  expect_same(arena, wanted, 1e-12);
}

/// What a run folder keeps: no file beside it is needed, and it reads back to the same bits.
TEST_F(Include, TheComposedTextStandsOnItsOwn) {
  const std::string text = self_contained_arena(kShipped + "four_corners.yaml");
  EXPECT_EQ(text.find("include:"), std::string::npos);
  const Arena arena = load_arena(kShipped + "four_corners.yaml");
  expect_same(arena, parse_arena(text, "elsewhere"), 0.0);
  EXPECT_EQ(arena.victims.size(), 4u);
  EXPECT_EQ(arena.sheets.size(), 8u) << "the litter that each corner includes";
  EXPECT_EQ(self_contained_arena(write("again.yaml", text)), text);
}

TEST_F(Include, AFileWithoutIncludesIsKeptAsItIs) {
  std::ifstream file(kShipped + "demo_ramps.yaml");
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(self_contained_arena(kShipped + "demo_ramps.yaml"), bytes);
}

/// A piece without a drawing speaks of the letters of the file that includes it.
TEST_F(Include, ALegendIsShared) {
  write("legend.yaml", "floor_friction: 0.6\npaper:\n  - {cell: P}\nballs:\n  - {cell: P, dx_m: 0.3}\n");
  const Arena arena = load(
      "maze: |\n  +---+---+---+\n  |S.  P.  P. |\n  +---+---+---+\n"
      "include:\n  - {file: legend.yaml}\n");
  EXPECT_EQ(arena.sheets.size(), 2u);
  EXPECT_EQ(arena.floor_friction, 0.6);
  EXPECT_NEAR(arena.balls[1].position.x, 3.3, 1e-12);
}

TEST_F(Include, ALeagueFileCanBeAPiece) {
  write("piece.raf",
        "<elements><element type=\"small_wall\" x=\"0\" y=\"0\"/><element type=\"small_wall\" x=\"1\" y=\"0\"/>\n"
        "<element type=\"half_ramp\" x=\"0\" y=\"0\"/><element type=\"small_wall\" rotation=\"180\" x=\"1\" y=\"0\"/>\n"
        "</elements>\n");
  const Arena arena = load(
      "maze: |\n  +---+---+---+---+\n  |S.   .         |\n  +---+---+---+---+\n"
      "include:\n  - {file: piece.raf, at: [2, 0]}\n");
  EXPECT_EQ(arena.solids.size(), 4u + 3u);
  EXPECT_EQ(arena.floor.size(), 2u + 3u);
}

TEST_F(Include, TheIncludingFilesStartCounts) {
  write("piece.yaml", "maze: |\n  +---+\n  |S.\n  +---+\nstart: {heading_deg: 10}\n");
  const std::string two = "include:\n  - {file: piece.yaml}\n  - {file: piece.yaml, at: [1, 0], turn: 180}\n";
  EXPECT_THAT(error_of(two), HasSubstr("arena.yaml:3:6: two pieces say where the robot starts; write S"));
  EXPECT_NEAR(load(two + "start: {x_m: 1.8, y_m: 0.6}\n").start.x, 1.8, 1e-12);
  const Arena one = load("include:\n  - {file: piece.yaml, at: [1, 1], turn: 90}\n");
  EXPECT_NEAR(one.start.x, 1.8, 1e-12);
  EXPECT_NEAR(one.start.phi, 100.0 / 180.0 * 3.14159265358979, 1e-9);
}

TEST_F(Include, AnEmptyListIncludesNothing) {
  write("piece.yaml", "include:\nmaze: |\n  +---+\n  |S.\n  +---+\n");
  EXPECT_EQ(load("include: [{file: piece.yaml}]\n").floor.size(), 1u);
  EXPECT_EQ(load("include:\nmaze: |\n  +---+\n  |S.\n  +---+\n").floor.size(), 1u);
  EXPECT_THAT(error_of("inclde: [{file: piece.yaml}]\n"), HasSubstr("where does the robot start"));
  EXPECT_THAT(error_of("maze: |\n  +---+\n  |S.\n  +---+\ninclde: [{file: a}]\n"), HasSubstr("did you mean 'include'"));
  EXPECT_THAT(error_of("include: [{file: piece.yaml, at: [1e300, 0]}]\n"), HasSubstr("in whole pallets"));
}

/// From a piece, turned, through the composed text and back.
TEST_F(Include, FrictionOfAFloorStaysWithIt) {
  write("ice.yaml",
        "maze: |\n  +---+---+\n  |S.   . |\n  +---+---+\n"
        "floors:\n  - {x_m: 1.8, y_m: 0.6, length_m: 0.5, friction: 0.1}\n"
        "elements:\n  - {type: half_ramp, x_m: 1.8, y_m: 0.6, friction: 0.2}\n");
  const Arena arena = load("include:\n  - {file: ice.yaml, turn: 180}\n");
  ASSERT_EQ(arena.floor.size(), 4u);
  EXPECT_EQ(arena.floor[0].friction, std::nullopt);
  EXPECT_EQ(arena.floor[2].friction, 0.1);
  EXPECT_EQ(arena.floor[3].friction, 0.2);
  expect_same(arena, parse_arena(self_contained_arena(folder_ + "/arena.yaml"), "again"), 0.0);
}

/// The outermost file says how large a pallet is; the ones between need not.
TEST_F(Include, SettingsHoldForPiecesOfPieces) {
  write("leaf.yaml",
        "maze: |\n  +---+---+\n  |S.  A. |\n  +---+---+\n"
        "boxes:\n  - {cell: A, height_m: 0.3}\nwalls:\n  - {from_m: [0.1, 0.2], to_m: [0.5, 0.2]}\n");
  write("middle.yaml", "include:\n  - {file: leaf.yaml, at: [1, 0], turn: 90}\n");
  const std::string settings = "cell_m: 2.0\nwall_height_m: 0.9\n";
  const Arena nested = load(settings + "include:\n  - {file: middle.yaml, at: [0, 1]}\n");
  const Arena direct = load(settings + "include:\n  - {file: leaf.yaml, at: [1, 1], turn: 90}\n");
  expect_same(nested, direct, 1e-12);
  EXPECT_NEAR(nested.start.x, 3.0, 1e-12);
  write("sizes.yaml", settings);
  expect_same(load("include:\n  - {file: middle.yaml, at: [0, 1]}\n  - {file: sizes.yaml}\n"), direct, 1e-12);
}

/// Doubling at each level would make 2^30 pieces.
TEST_F(Include, PiecesOfPiecesOfPiecesAreLimited) {
  for (int i = 0; i < 30; ++i) {
    const std::string next = "p" + std::to_string(i + 1) + ".yaml";
    write("p" + std::to_string(i) + ".yaml", "include: [{file: " + next + "}, {file: " + next + "}]\n");
  }
  write("p30.yaml", "floor_friction: 0.5\n");
  EXPECT_THAT(error_of("start: {x_m: 0, y_m: 0}\ninclude: [{file: p0.yaml}]\n"), HasSubstr("more than 1000 pieces"));
}

}  // namespace
}  // namespace rubble::arenas
