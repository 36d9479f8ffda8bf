#include "slam/robust/map/saved_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/bytes.h"
#include "base/error.h"
#include "slam/robust/continued_mapper.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_floor.h"

/// What a map's file holds, and what becomes of files that are damaged.
namespace rubble::slam {
namespace {

using mrpt::math::TPose3D;
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
      std::vector<float>& ranges = ticks[i].scans.front().ranges;
      if (i % 50 == 20) ranges[i % ranges.size()] = std::numeric_limits<float>::infinity();
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
  const float inf = std::numeric_limits<float>::infinity();
  for (const float range : {std::nanf(""), inf, -inf, -1.0F, 1e4F, 3e38F}) {
    SCOPED_TRACE(range);
    EXPECT_THAT(refused([&](SavedMap& m) { m.scans.front().scan.range_min = range; }), HasSubstr("is damaged"));
    EXPECT_THAT(refused([&](SavedMap& m) { m.scans.front().scan.range_max = range; }), HasSubstr("is damaged"));
    EXPECT_THAT(refused([&](SavedMap& m) { m.scans.front().scan.quantum = range; }), HasSubstr("is damaged"));
  }
  EXPECT_THAT(refused([](SavedMap& m) { m.scans.front().scan.quantum = 0.0F; }), HasSubstr("without a step"));
  const auto refused_frame = [&](const std::function<void(KeyFrame&)>& spoil) {
    return refused([&](SavedMap& m) {
      std::vector<KeyFrame> kept;
      std::vector<int> before;
      for (int i = 0; i < m.frames.size(); ++i) kept.push_back(m.frames[i]), before.push_back(m.frames.before(i));
      spoil(kept[1]);
      m.frames = KeyFrames(kept, before, m.frames.graph());
    });
  };
  EXPECT_EQ(refused_frame([](KeyFrame&) {}), "");
  EXPECT_THAT(refused_frame([](KeyFrame& f) { f.cloud.points.at(0).x = 3e38F; }), HasSubstr("point far off"));
  EXPECT_THAT(refused_frame([](KeyFrame& f) { f.cloud.points.at(0).ny = 3e38F; }), HasSubstr("point far off"));
  EXPECT_THAT(refused_frame([](KeyFrame& f) { f.cloud.laser.y = 1e308; }), HasSubstr("laser far off"));
  EXPECT_THAT(refused_frame([](KeyFrame& f) { f.path = -1.0; }), HasSubstr("path"));
  for (double TPose3D::*angle : {&TPose3D::yaw, &TPose3D::pitch, &TPose3D::roll})
    EXPECT_THAT(refused([&](SavedMap& m) { m.T_base_laser.*angle = 1e308; }), HasSubstr("angle far off"));
  EXPECT_THAT(refused([](SavedMap& m) { m.T_base_laser.x = 1e308; }), HasSubstr("laser far off"));
  EXPECT_THAT(refused([](SavedMap& m) { m.T_frame_base.phi = 1e308; }), HasSubstr("angle far off"));
  for (Eigen::Matrix3d SavedMap::*matrix : {&SavedMap::frame_covariance, &SavedMap::scan_covariance}) {
    EXPECT_THAT(refused([&](SavedMap& m) { (m.*matrix)(0, 0) = 1e308; }), HasSubstr("matrix far off"));
    EXPECT_THAT(refused([&](SavedMap& m) { (m.*matrix)(0, 1) += 1.0; }), HasSubstr("not symmetric"));
    EXPECT_THAT(refused([&](SavedMap& m) { (m.*matrix)(2, 2) = -1.0; }), HasSubstr("below zero"));
  }
  EXPECT_THAT(refused([](SavedMap& m) {
                PoseGraph graph = m.frames.graph();
                graph.edges.front().information *= -1.0;
                std::vector<KeyFrame> kept;
                std::vector<int> before;
                for (int i = 0; i < m.frames.size(); ++i)
                  kept.push_back(m.frames[i]), before.push_back(m.frames.before(i));
                m.frames = KeyFrames(kept, before, graph);
              }),
              HasSubstr("below zero"));
}

/// What a scanner says of itself may be nonsense; the map that is made with it is read back.
TEST(SavedMap, AScannerWithoutALimitGivesAMapThatIsReadBack) {
  const float inf = std::numeric_limits<float>::infinity();
  for (const double limit : {0.0, -1.0, 1e308, std::nan(""), static_cast<double>(inf)}) {
    robot::LaserScan scan;
    scan.angle_step = 0.01;
    scan.range_min = scan.range_max = limit;
    scan.ranges = {1.0F, 2.0F, inf, 1e30F, -1.0F, std::nanf("")};
    SavedMap map = decode_map(mapper().saved_map(), "map");
    map.scans.front().scan = packed(scan, std::nullopt, std::nullopt);
    const SavedMap again = decode_map(encode_map(map), "map");
    EXPECT_EQ(again.scans.front().scan.ranges, map.scans.front().scan.ranges);
    EXPECT_LT(LevelScan({}, {}).points(unpacked(again.scans.front().scan)).hits.size(), 3u) << "a miss is no hit";
  }
}

/// Nothing of what a few bytes claim to unpack to is believed beyond 64 MB and 40 times the file.
TEST(SavedMap, AFileThatUnpacksToGigabytesIsRefusedByItsHead) {
  std::string zeros(std::size_t{100} << 20, '\0');
  uLongf size = compressBound(static_cast<uLong>(zeros.size()));
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()),
            static_cast<uLong>(zeros.size()), 1);
  packed.resize(size);
  const auto sum = [](const std::string& bytes) {
    return static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
  };
  std::string head;
  ByteWriter out(head);
  for (const std::size_t number : {zeros.size(), packed.size()})
    out.u32(static_cast<std::uint32_t>(number)), out.u32(static_cast<std::uint32_t>(number >> 32U));
  out.u32(sum(packed));
  out.u32(sum(head));
  EXPECT_THAT(error_of("RUBBLE MAP 2\n" + head + packed), HasSubstr("would unpack to 100 MB"));
}

/// A key frame that lies kilometres off would have the mapper draw the widest map there may be.
TEST(SavedMap, AMapWiderThanTheMapperDrawsIsRefused) {
  SavedMap map = decode_map(mapper().saved_map(), "map");
  map.scans.back().T_frame_base.x = 9.9e6;
  try {
    ContinuedMapper({}, {}, std::make_shared<MapBase>(MapBase{encode_map(map), "lab/map.rmap", true, {}}));
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("lab/map.rmap: its scans lie 98"));
    EXPECT_THAT(error.what(), HasSubstr("but the map may be 400 m wide; raise mapper.resolution_m"));
  }
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
