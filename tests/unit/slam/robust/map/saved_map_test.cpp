#include "slam/robust/map/saved_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "slam/robust/continued_mapper.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_floor.h"

/// What a map's file holds, and what becomes of files that are damaged.
namespace rubble::slam {
namespace {

using robot::RobotModel;
using testing::HasSubstr;
using testing::StartsWith;

/// Of a drive with loops, tilted scans that take their time, and scans that say nothing.
const RobustMapper& mapper() {
  static const auto made = [] {
    const RobotModel model;
    const slam_test::Floor floor(1, 2, 2);
    const auto drive = slam_test::drive_through(
        floor.way({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}), 0.0);
    auto ticks = slam_test::record_sweeping(floor.world(), drive, model, 1.0, 0.01, 0.0665, 1);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      for (int k = 4; k >= 0; --k) ticks[i].accelerations.push_back({ticks[i].now - 0.02 * k, 0.1, -0.05});
      if (i % 50 == 20) ticks[i].scans.front().ranges[i] = std::numeric_limits<float>::infinity();
    }
    RobustConfig config;
    config.thin_walls = false;
    auto mapper = std::make_unique<RobustMapper>(model, config, 1);
    for (const robot::Inputs& tick : ticks) mapper->update(tick);
    mapper->finish();
    return mapper;
  }();
  return *made;
}

std::string error_of(const std::string& bytes) {
  try {
    decode_map(bytes, "lab/map.rmap");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SavedMap, SaveLoadSaveGivesTheSameBytes) {
  const std::string bytes = mapper().saved_map();
  const SavedMap map = decode_map(bytes, "map");
  EXPECT_GT(map.frames.size(), 40);
  int loops = 0;
  for (const GraphEdge& edge : map.frames.graph().edges) loops += edge.loop ? 1 : 0;
  EXPECT_GT(loops, 5);
  EXPECT_EQ(encode_map(map), bytes);
  // And by way of a mapper that has seen nothing.
  for (const bool grows : {true, false})
    EXPECT_EQ(ContinuedMapper({}, {}, std::make_shared<MapBase>(MapBase{bytes, "map", grows, {}})).saved_map(), bytes);
}

TEST(SavedMap, HoldsPosesGraphAndScansAsTheyWere) {
  const SavedMap map = decode_map(mapper().saved_map(), "map");
  const KeyFrames& frames = mapper().key_frames();
  ASSERT_EQ(map.frames.size(), frames.size());
  for (int i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(map.frames.pose(i), frames.pose(i));
    EXPECT_EQ(map.frames.before(i), frames.before(i));
    EXPECT_EQ(map.frames[i].cloud.points.size(), frames[i].cloud.points.size());
    EXPECT_EQ(map.frames[i].cloud.sight.bins(), frames[i].cloud.sight.bins());
  }
  ASSERT_EQ(map.frames.graph().edges.size(), frames.graph().edges.size());
  std::vector<int> all(static_cast<std::size_t>(frames.size()));
  for (int i = 0; i < frames.size(); ++i) all[static_cast<std::size_t>(i)] = i;
  for (const int i : {0, frames.size() / 2, frames.last()})
    EXPECT_EQ(map.frames.paths_from(i, all, 1e9), frames.paths_from(i, all, 1e9))
        << "paths through the graph from " << i;
  EXPECT_EQ(map.scans.size(), mapper().counts().mapped);
}

/// The counts are made anew from the scans; those lay wrong by a fifth of a cell at most.
TEST(SavedMap, TheMapMadeAnewIsTheMap) {
  RobustConfig config;
  config.thin_walls = false;
  const ContinuedMapper again({}, config, std::make_shared<MapBase>(MapBase{mapper().saved_map(), "map", true, {}}));
  const OccupancyGrid before = mapper().map().classify();
  const OccupancyGrid after = again.map().classify();
  int same = 0, known = 0;
  for (int y = 0; y < before.height(); ++y)
    for (int x = 0; x < before.width(); ++x) {
      const Cell there = after.cell(before.centre({x, y}));
      if (!after.inside(there)) continue;
      if (before[{x, y}] == Occupancy::Unknown && after[there] == Occupancy::Unknown) continue;
      ++known;
      same += before[{x, y}] == after[there] ? 1 : 0;
    }
  EXPECT_GT(known, 5000);
  EXPECT_GT(same, 0.99 * known);
}

TEST(SavedMap, ADamagedFileIsToldInOneLine) {
  const std::string bytes = mapper().saved_map();
  ASSERT_EQ(error_of(bytes), "");
  Rng rng(7, "damage");
  for (int k = 0; k < 60; ++k) {
    std::string damaged = bytes;
    const auto at = k < 37 ? static_cast<std::size_t>(k)
                           : static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(bytes.size())));
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (k % 8)));
    const std::string error = error_of(damaged);
    EXPECT_THAT(error, StartsWith("lab/map.rmap: ")) << "byte " << at;
    EXPECT_EQ(error.find('\n'), std::string::npos) << "byte " << at;
  }
  for (const double share : {0.0, 0.0001, 0.001, 0.3, 0.999})
    EXPECT_THAT(error_of(bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())))),
                StartsWith("lab/map.rmap: "));
  EXPECT_THAT(error_of(bytes + "x"), HasSubstr("instead of"));
  EXPECT_THAT(error_of("RUBBLE MAP 9\n" + bytes.substr(13)), HasSubstr("version '9'"));
  EXPECT_THAT(error_of("II*"), HasSubstr("is no map with a graph"));
}

/// What a sum cannot tell: a file that was written so. Numbers out of place are refused before they are used.
TEST(SavedMap, NumbersOutOfPlaceAreRefused) {
  const SavedMap good = decode_map(mapper().saved_map(), "map");
  const auto refused = [&](const std::function<void(SavedMap&)>& spoil) {
    SavedMap map = good;
    spoil(map);
    return error_of(encode_map(map));
  };
  EXPECT_THAT(refused([](SavedMap& m) { m.here = m.frames.size(); }), HasSubstr("key frame that is not there"));
  EXPECT_THAT(refused([](SavedMap& m) { m.scans.back().frame = 100000; }), HasSubstr("key frame that is not there"));
  EXPECT_THAT(refused([](SavedMap& m) { m.path = std::nan(""); }), HasSubstr("number that is none"));
  EXPECT_THAT(refused([](SavedMap& m) { m.T_frame_base.x = 1e9; }), HasSubstr("pose far off"));
  EXPECT_THAT(refused([](SavedMap& m) { m.scans.front().scan.angle_step = 0.0; }),
              HasSubstr("angle between its beams"));
}

TEST(SavedMap, AnotherMountOfTheLaserIsRefused) {
  RobotModel other;
  other.T_base_laser.x += 0.05;
  try {
    ContinuedMapper(other, {}, std::make_shared<MapBase>(MapBase{mapper().saved_map(), "lab/map.rmap", true, {}}));
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("lab/map.rmap: was made with the laser mounted at"));
  }
}

}  // namespace
}  // namespace rubble::slam
