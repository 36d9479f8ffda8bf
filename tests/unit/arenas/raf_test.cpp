#include "arenas/raf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "arenas/arena_file.h"
#include "arenas/truth_map.h"
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
