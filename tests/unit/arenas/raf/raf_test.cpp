#include "arenas/raf/raf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "arenas/files/arena_file.h"
#include "arenas/truth/truth_map.h"
#include "base/angle.h"
#include "base/error.h"

namespace rubble::arenas {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string raf(const std::string& elements) {
  return "<?xml version=\"1.0\"?>\n<elements>\n" + elements + "</elements>\n";
}

/// A room of two pallets, x = 0 and 1.
const std::string kRoom =
    "<element type=\"small_wall\" rotation=\"0\" x=\"0\" y=\"0\"/>\n"
    "<element type=\"small_wall\" rotation=\"0\" x=\"1\" y=\"0\"/>\n"
    "<element type=\"small_wall\" rotation=\"180\" x=\"0\" y=\"0\"/>\n"
    "<element type=\"small_wall\" rotation=\"180\" x=\"1\" y=\"0\"/>\n"
    "<element type=\"tall_wall\" rotation=\"270\" x=\"0\" y=\"0\"/>\n"
    "<element type=\"small_wall\" rotation=\"270\" x=\"2\" y=\"0\"/>\n";

std::string error_of(const std::string& text) {
  try {
    parse_raf(text, "f.raf");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Raf, GroundIsLaidInsideTheWalls) {
  const RafImport import = parse_raf(raf(kRoom), "f.raf");
  EXPECT_EQ(import.arena.name, "f");
  EXPECT_EQ(import.arena.floor.size(), 2u);
  EXPECT_EQ(import.arena.solids.size(), 6u);
  EXPECT_EQ(import.summary(), "6 parts built");
  EXPECT_EQ(import.arena.start.x, 0.0);
  EXPECT_EQ(import.arena.start.phi, 0.0) << "looks along the open side";
}

TEST(Raf, OpenArenaStandsInAHallWithFloorEverywhere) {
  const RafImport import = parse_raf(raf("<element type=\"small_wall\" x=\"0\" y=\"0\"/>\n"
                                         "<element type=\"small_wall\" x=\"2\" y=\"1\"/>\n"),
                                     "f.raf");
  EXPECT_EQ(import.arena.floor.size(), 6u);
}

TEST(Raf, NothingIsDroppedSilently) {
  const RafImport import = parse_raf(raf(kRoom + "<element type=\"hazmat\" x=\"0\" y=\"0\"/>\n"
                                                 "<element type=\"mystery\" x=\"0\" y=\"0\"/>\n"
                                                 "<element type=\"mystery\" x=\"1\" y=\"0\"/>\n"),
                                     "f.raf");
  EXPECT_EQ(import.summary(), "6 parts built; without a shape: hazmat 1; UNKNOWN, left out: mystery 2");
}

/// Rooms of one and of three pallets side by side: the larger one, although (0, 0) lies in the other.
TEST(Raf, TheRobotStartsWhereItCanDriveFarthest) {
  std::string rooms;
  for (int x = 0; x < 4; ++x)
    for (const char* side : {"0", "180"})
      rooms +=
          "<element type='small_wall' rotation='" + std::string(side) + "' x='" + std::to_string(x) + "' y='0'/>\n";
  for (const char* x : {"0", "1", "4"})
    rooms += "<element type='small_wall' rotation='270' x='" + std::string(x) + "' y='0'/>\n";
  const RafImport import = parse_raf(raf(rooms), "f.raf");
  EXPECT_NEAR(import.arena.start.x, 1.2, 1e-9);
  ASSERT_EQ(import.notes().size(), 1u);
  EXPECT_EQ(
      import.notes()[0],
      "the file names no start: the robot starts on pallet x=\"1\" y=\"0\", in the largest of 2 parts that can be "
      "driven on");
}

/// A hall of eight pallets, two of them ramps: two flat ones stay between them and the start.
TEST(Raf, TheRobotStartsAwayFromRamps) {
  std::string hall;
  for (int x = 0; x < 8; ++x)
    for (const char* side : {"0", "180"})
      hall += "<element type='small_wall' rotation='" + std::string(side) + "' x='" + std::to_string(x) + "' y='0'/>\n";
  for (const char* x : {"0", "8"})
    hall += "<element type='small_wall' rotation='270' x='" + std::string(x) + "' y='0'/>\n";
  for (const char* x : {"0", "1"}) hall += "<element type='half_ramp' x='" + std::string(x) + "' y='0'/>\n";
  EXPECT_NEAR(parse_raf(raf(hall), "f.raf").arena.start.x, 4 * 1.2, 1e-9);
}

TEST(Raf, AStartCheckIsTheStart) {
  const RafImport import = parse_raf(raf(kRoom + "<element type=\"start_check\" x=\"1\" y=\"0\"/>\n"), "f.raf");
  EXPECT_NEAR(import.arena.start.x, 1.2, 1e-9);
  EXPECT_EQ(import.notes().back(), "the robot starts on pallet x=\"1\" y=\"0\", at the 'start_check'");
}

/// Rooms of one and of three pallets side by side, the part in the smaller one, which has no door.
TEST(Raf, AStartPartInASealedRoomIsPassedOver) {
  std::string rooms = "<element type='start_check' x='0' y='0'/>\n";
  for (int x = 0; x < 4; ++x)
    for (const char* side : {"0", "180"})
      rooms +=
          "<element type='small_wall' rotation='" + std::string(side) + "' x='" + std::to_string(x) + "' y='0'/>\n";
  for (const char* x : {"0", "1", "4"})
    rooms += "<element type='small_wall' rotation='270' x='" + std::string(x) + "' y='0'/>\n";
  const RafImport import = parse_raf(raf(rooms), "f.raf");
  EXPECT_NEAR(import.arena.start.x, 1.2, 1e-9);
  EXPECT_EQ(import.start_note,
            "the 'start_check' stands where the robot gets to little of the floor: the robot starts on pallet x=\"1\" "
            "y=\"0\", in the largest of 2 parts that can be driven on");
}

/// A wall that stands alone far away must not lure the robot out of an arena with a gap.
TEST(Raf, AnOpenArenaIsEnteredNotCircled) {
  std::string walls = "<element type='small_wall' x='9' y='-3'/>\n";
  for (int i = 0; i < 3; ++i) {
    const std::string at = std::to_string(i + 1);
    walls += "<element type='small_wall' rotation='0' x='" + at + "' y='3'/>\n";
    walls += "<element type='small_wall' rotation='270' x='1' y='" + at + "'/>\n";
    walls += "<element type='small_wall' rotation='90' x='3' y='" + at + "'/>\n";
    if (i != 1) walls += "<element type='small_wall' rotation='180' x='" + at + "' y='1'/>\n";
  }
  const RafImport import = parse_raf(raf(walls), "f.raf");
  EXPECT_GT(import.arena.start.x, 0.6);
  EXPECT_LT(import.arena.start.x, 4.2);
  EXPECT_GT(import.arena.start.y, 0.6);
  EXPECT_LT(import.arena.start.y, 4.2);
}

TEST(Raf, OddTurnsAreTakenAndTold) {
  const auto wall = [](const std::string& rotation) {
    return parse_raf(raf(kRoom + "<element type=\"small_wall\" rotation=\"" + rotation + "\" x=\"0\" y=\"0\"/>\n"),
                     "f.raf");
  };
  for (const char* same : {"-90", "450", "90.0", "-270"}) {
    const RafImport import = wall(same);
    EXPECT_TRUE(import.askew.empty()) << same;
    const double sine = std::sin(import.elements.back().rotation);
    EXPECT_NEAR(sine, std::string(same) == "-90" ? -1.0 : 1.0, 1e-9) << same;
    EXPECT_NO_THROW(parse_arena(to_yaml(import), "f.yaml"));
  }
  EXPECT_THAT(wall("45").notes()[0], StartsWith("at other than quarter turns: small_wall 1"));
  EXPECT_THAT(error_of(raf("<element type=\"small_wall\" rotation=\"north\" x=\"0\" y=\"0\"/>\n")),
              StartsWith("f.raf:3:1: rotation=\"north\" is not a number"));
}

TEST(Raf, XmlIsReadAsPeopleWriteIt) {
  const RafImport import = parse_raf(
      "\xef\xbb\xbf<elements>\r\n<!-- a room --><element type = 'small_wall' x='0.0' y=\"0\"></element>\r\n"
      "<element y='1' x='0' type='small_wall'/>\r\n</elements>\r\n",
      "f.raf");
  EXPECT_EQ(import.built.at("small_wall"), 2);
  EXPECT_THAT(error_of(""), HasSubstr("f.raf:1:1: no <element"));
  EXPECT_THAT(error_of("<?xml version='1.0'?><!DOCTYPE elements><elements></elements>"), HasSubstr("no <element"));
  EXPECT_THAT(error_of(raf("<element type='zorp' x='0' y='0'/>")), HasSubstr("UNKNOWN, left out: zorp 1"));
}

/// The same shapes, moved by the shift between the two starts.
void expect_same_shapes(const Arena& a, const Arena& b) {
  const mrpt::math::TPoint2D shift{b.start.x - a.start.x, b.start.y - a.start.y};
  const auto expect_moved = [&](const Outline& p, const Outline& q) {
    ASSERT_EQ(p.size(), q.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
      EXPECT_NEAR(p[i].x + shift.x, q[i].x, 1e-9);
      EXPECT_NEAR(p[i].y + shift.y, q[i].y, 1e-9);
    }
  };
  ASSERT_EQ(a.floor.size(), b.floor.size());
  for (std::size_t i = 0; i < a.floor.size(); ++i) {
    expect_moved(a.floor[i].outline, b.floor[i].outline);
    EXPECT_EQ(a.floor[i].z, b.floor[i].z);
  }
  ASSERT_EQ(a.solids.size(), b.solids.size());
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    expect_moved(a.solids[i].outline, b.solids[i].outline);
    EXPECT_EQ(a.solids[i].z_top, b.solids[i].z_top);
  }
  EXPECT_EQ(a.victims.size(), b.victims.size());
  EXPECT_NEAR(a.start.phi, b.start.phi, 1e-9);
}

TEST(Raf, AsAnArenaFileItIsTheSameArena) {
  const RafImport import = parse_raf(raf(kRoom + "<element type=\"half_ramp\" rotation=\"90\" x=\"1\" y=\"0\"/>\n"
                                                 "<element type=\"mystery\" x=\"0\" y=\"0\"/>\n"),
                                     "f.raf");
  EXPECT_THAT(to_yaml(import), HasSubstr("mystery 1"));
  expect_same_shapes(import.arena, parse_arena(to_yaml(import), "f.yaml"));
}

TEST(Raf, ErrorsNameLineAndColumn) {
  EXPECT_THAT(error_of("hello"), StartsWith("f.raf:1:1: text between"));
  EXPECT_THAT(error_of("<elements></elements>"), HasSubstr("no <element"));
  EXPECT_THAT(error_of(raf("<element x=\"0\" y=\"0\"/>\n")), StartsWith("f.raf:3:1: the element has no 'type'"));
  EXPECT_THAT(error_of(raf("<element type=\"a\" x=\"q\" y=\"0\"/>\n")),
              StartsWith("f.raf:3:1: x=\"q\" is not a number"));
  EXPECT_THAT(error_of(raf("<element type=\"a\" x=\"1e9\" y=\"0\"/>\n")), HasSubstr("is not a number from"));
  EXPECT_THAT(error_of(raf("<element type=\"a\" x=\"0\" y=\"0\" z=\"1\"/>\n")), HasSubstr("unknown attribute 'z'"));
  EXPECT_THAT(error_of(raf("<element type=\"a\" x=\"0\" x=\"0\"/>\n")),
              StartsWith("f.raf:3:25: attribute 'x' is given"));
  EXPECT_THAT(error_of(raf("<wall/>\n")), StartsWith("f.raf:3:1: <wall> does not belong here"));
  EXPECT_THAT(error_of("<elements><element type=\"a"), HasSubstr("no closing quote"));
  EXPECT_THAT(error_of("<elements><element type=\"small_wall\" x=\"0\" y=\"0\"/>"), HasSubstr("without </elements>"));
  EXPECT_THAT(error_of(raf("<element type=\"stepfield_red_diagonal\" x=\"0\" y=\"0\"/>\n")), HasSubstr("no pallet"));
}

TEST(Raf, ElementsFarApartAreRefusedByTheFloorBetweenThem) {
  const auto apart = [](int x, int y) {
    return raf(kRoom + "<element type=\"start_check\" x=\"1\" y=\"0\"/>\n<element type=\"small_wall\" x=\"" +
               std::to_string(x) + "\" y=\"" + std::to_string(y) + "\"/>\n");
  };
  EXPECT_NO_THROW(parse_raf(apart(99, 59), "f.raf"));
  EXPECT_THAT(error_of(apart(100, 59)), HasSubstr("101 by 60 pallets"));
  EXPECT_EQ(
      error_of(apart(99, 69)),
      "f.raf: its elements lie 100 by 70 pallets apart, and a .raf may cover 6000: take out what lies far off, as "
      "'small_wall' at x=\"99\" y=\"69\" does");
}

TEST(Raf, FileWithFarTooManyElementsIsRefusedAtOnce) {
  std::string many;
  for (int i = 0; i < 60000; ++i)
    many += "<element type=\"small_wall\" x=\"" + std::to_string(i % 250) + "\" y=\"0\"/>\n";
  try {
    parse_raf(raf(many), "f.raf");
    FAIL() << "was read";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("more than 5,000 elements"), std::string::npos) << e.what();
  }
}

/// Any damage to a file ends in an arena or in one line of complaint, never in a crash.
TEST(Raf, DamagedFilesAreRefusedCleanly) {
  const std::string good = raf(kRoom);
  for (std::size_t cut = 0; cut < good.size(); ++cut) {
    EXPECT_THAT(error_of(good.substr(0, cut)), ::testing::Not(HasSubstr("\n")));
    std::string changed = good;
    changed[cut] = '"';
    EXPECT_THAT(error_of(changed), ::testing::Not(HasSubstr("\n")));
  }
}

class RafFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("RUBBLE_DATA");
    if (data == nullptr) GTEST_SKIP() << "RUBBLE_DATA is not set: no competition arenas to import";
    for (const auto& entry : std::filesystem::directory_iterator(std::string(data) + "/arenas_raf")) {
      files_.push_back(entry.path().string());
    }
    std::sort(files_.begin(), files_.end());
    ASSERT_FALSE(files_.empty());
  }
  std::vector<std::string> files_;
};

TEST_F(RafFiles, EveryPartOfEveryCompetitionArenaIsAccountedFor) {
  for (const std::string& file : files_) {
    SCOPED_TRACE(file);
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    int parts = 0;
    for (std::size_t i = 0; (i = text.str().find("<element ", i)) != std::string::npos; ++i) ++parts;
    const RafImport import = import_raf(file);
    int found = 0;
    for (const auto* counts : {&import.built, &import.labels, &import.unknown}) {
      for (const auto& [type, n] : *counts) found += n;
    }
    EXPECT_EQ(found, parts);
    EXPECT_TRUE(import.unknown.empty()) << import.summary();
    EXPECT_NO_THROW(check(import.arena, file));
  }
}

TEST_F(RafFiles, CompetitionArenasCanBeTurnedIntoArenaFiles) {
  for (const std::string& file : files_) {
    SCOPED_TRACE(file);
    const RafImport import = import_raf(file);
    expect_same_shapes(import.arena, parse_arena(to_yaml(import), file));
    expect_same_shapes(import.arena, load_arena(file));
  }
}

TEST_F(RafFiles, CompetitionArenasHaveAGroundTruth) {
  for (const std::string& file : files_) {
    SCOPED_TRACE(file);
    const Arena arena = import_raf(file).arena;
    const OccupancyGrid map = truth_map(arena);
    const auto free = std::count(map.cells().begin(), map.cells().end(), Occupancy::Free);
    EXPECT_GT(static_cast<double>(free) * 0.05 * 0.05, 1.2 * 1.2) << "more than one pallet can be reached";
  }
}

}  // namespace
}  // namespace rubble::arenas
