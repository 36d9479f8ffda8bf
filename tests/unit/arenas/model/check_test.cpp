#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <cmath>

#include "arenas/model/arena.h"
#include "arenas/model/geometry.h"
#include "base/error.h"

namespace rubble::arenas {
namespace {

using ::testing::HasSubstr;

Arena good() {
  Arena arena;
  arena.floor = {{rectangle({0.0, 0.0}, 4.0, 4.0), 0.0, 0.0, 0.0, "flat"}};
  arena.solids = {{rectangle({0.0, 1.0}, 4.0, 0.02), 0.0, 1.2, "wall"}};
  arena.victims.push_back({"anna", {1.0, 0.5, 0.2}, 0.0, true, true, false, false});
  arena.balls.push_back({{-1.0, -1.0}, 0.1, 0.02});
  return arena;
}

std::string complaint(const Arena& arena) {
  try {
    check(arena, "file.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Check, LetsAGoodArenaPass) { EXPECT_EQ(complaint(good()), ""); }

TEST(Check, ABallLiesUnderWhatIsOpenBelow) {
  Arena arena = good();
  arena.solids.push_back({rectangle({-1.0, -1.0}, 1.0, 1.0), 1.18, 1.2, "elevated_floor"});
  EXPECT_EQ(complaint(arena), "");
  arena.solids.back().z_bottom = 0.1;
  EXPECT_THAT(complaint(arena), HasSubstr("lies in a solid"));
}

TEST(Check, NamesTheSourceAndTheRemedyInOneLine) {
  Arena arena = good();
  arena.start.y = 0.8;
  EXPECT_THAT(complaint(arena), HasSubstr("file.yaml: start (0.00, 0.80) is 0.19 m from a 'wall'"));
  EXPECT_THAT(complaint(arena), HasSubstr("move the start"));
  EXPECT_EQ(complaint(arena).find('\n'), std::string::npos);
}

TEST(Check, FindsAStartTheRobotCannotStandAt) {
  Arena arena = good();
  arena.start.y = 1.0;
  EXPECT_THAT(complaint(arena), HasSubstr("is in a solid 'wall'"));
  arena.start.y = -1.9;
  EXPECT_THAT(complaint(arena), HasSubstr("where the floor ends"));
  arena.start.y = -5.0;
  EXPECT_THAT(complaint(arena), HasSubstr("off the floor"));
  arena.start = {-1.0, -1.2, 0.0};
  EXPECT_THAT(complaint(arena), HasSubstr("paper ball"));
  arena.start = {0.0, 0.0, 0.0};
  arena.floor.push_back({rectangle({0.4, 0.0}, 0.2, 0.2), 0.2, 0.0, 0.0, "step"});
  EXPECT_THAT(complaint(arena), HasSubstr("step"));
}

TEST(Check, WallThatHangsAboveTheRobotIsNoObstacle) {
  Arena arena = good();
  arena.start.y = 1.0;
  arena.solids[0].z_bottom = 0.6;
  EXPECT_EQ(complaint(arena), "");
}

TEST(Check, FindsEveryBrokenPart) {
  const auto with = [](const auto& change) {
    Arena arena = good();
    change(arena);
    return complaint(arena);
  };
  EXPECT_THAT(with([](Arena& a) { a.floor.clear(); }), HasSubstr("no floor"));
  EXPECT_THAT(with([](Arena& a) { a.floor[0].gx = 9.0; }), HasSubstr("steeper"));
  EXPECT_THAT(with([](Arena& a) { a.floor[0].outline[0].x = NAN; }), HasSubstr("not a number"));
  EXPECT_THAT(with([](Arena& a) { a.solids[0].z_top = 0.0; }), HasSubstr("no height"));
  EXPECT_THAT(with([](Arena& a) { std::swap(a.solids[0].outline[0], a.solids[0].outline[1]); }), HasSubstr("convex"));
  EXPECT_THAT(with([](Arena& a) { a.solids[0].outline[0].x = 4000.0; }), HasSubstr("metres"));
  EXPECT_THAT(with([](Arena& a) { a.balls[0].radius = 0.0; }), HasSubstr("radius"));
  EXPECT_THAT(with([](Arena& a) { a.balls[0].position.x = 9.0; }), HasSubstr("off the floor"));
  EXPECT_THAT(with([](Arena& a) { a.balls[0].position = {1.0, 1.0}; }), HasSubstr("in a solid"));
  EXPECT_THAT(with([](Arena& a) { a.victims.push_back(a.victims[0]); }), HasSubstr("named 'anna'"));
  EXPECT_THAT(with([](Arena& a) { a.victims[0].heat = a.victims[0].appearance = false; }), HasSubstr("no cue"));
  EXPECT_THAT(with([](Arena& a) { a.victims[0].position.x = 400.0; }), HasSubstr("more than 10 m from any floor"));
  EXPECT_THAT(with([](Arena& a) { a.floor_friction = 0.0; }), HasSubstr("friction"));
  EXPECT_THAT(with([](Arena& a) { a.sheets.push_back({{{0, 0}, {0, 1}, {1, 0}}, 0.2}); }), HasSubstr("paper sheet"));
}

TEST(Bounds, HoldAllParts) {
  Arena arena = good();
  arena.balls.push_back({{-3.0, 0.0}, 0.1, 0.02});
  arena.victims[0].position.y = 7.0;
  set_bounds(arena);
  EXPECT_DOUBLE_EQ(arena.min_corner.x, -3.1);
  EXPECT_DOUBLE_EQ(arena.min_corner.y, -2.0);
  EXPECT_DOUBLE_EQ(arena.max_corner.x, 2.0);
  EXPECT_DOUBLE_EQ(arena.max_corner.y, 7.0);
}

}  // namespace
}  // namespace rubble::arenas
