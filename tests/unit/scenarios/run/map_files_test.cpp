#include "scenarios/run/map_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DPDF.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "base/angle.h"
#include "base/error.h"
#include "base/round_step.h"
#include "base/text/text_file.h"
#include "slam/mappers.h"
#include "slam/robust/map/saved_map.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/slam_floor.h"

/// What a run folder keeps of a map, and what other programs read of it.
namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using mrpt::math::TPose2D;
using testing::HasSubstr;

class MapFiles : public testing::Test {
 protected:
  void SetUp() override {
    path_ = (fs::temp_directory_path() /
             ("rubble-map-files-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name())))
                .string();
    fs::remove_all(path_);
    folder_ = std::make_unique<RunFolder>(path_, false);
    const slam_test::Floor floor(3, 2, 2);
    const auto drive = slam_test::drive_through(floor.way({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}}), 0.0);
    mapper_ = std::make_unique<slam::RobustMapper>(robot::RobotModel(), slam::RobustConfig(), 1);
    for (const auto& tick : slam_test::record(floor.world(), drive, robot::RobotModel(), 1.0, 0.01, 3))
      mapper_->update(tick);
    mapper_->finish();
    save_map_files(*folder_, *mapper_);
  }
  void TearDown() override { fs::remove_all(path_); }

  std::string path_;
  std::unique_ptr<RunFolder> folder_;
  std::unique_ptr<slam::RobustMapper> mapper_;
};

TEST_F(MapFiles, TheMapIsReadBackFromFolderAndFile) {
  for (const std::string& path : {path_, path_ + "/map.rmap"}) {
    const auto base = load_map_base(path, true, std::nullopt);
    EXPECT_EQ(base->bytes, mapper_->saved_map());
    EXPECT_EQ(base->name, path_ + "/map.rmap");
  }
  fs::remove(path_ + "/map.rmap");
  try {
    load_map_base(path_, true, std::nullopt);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("holds no map.rmap"));
  }
}

/// A drive on another floor than its map closes loops, but nobody knows where they lie on that.
TEST_F(MapFiles, LoopsOfADriveWhosePlaceIsNotKnownAreTabledButNotDrawn) {
  const slam_test::Floor other(8, 4, 3);
  std::vector<Cell> rooms{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  rooms.insert(rooms.end(), rooms.begin(), rooms.begin() + 4);
  slam::MapperConfig config;
  config.choose("robust");
  for (const bool grows : {true, false}) {
    const std::shared_ptr<slam::Mapper> drive = config.make({}, {1, "", load_map_base(path_, grows, std::nullopt)});
    for (const auto& tick : slam_test::record(other.world(), slam_test::drive_through(other.way(rooms), 0.0),
                                              robot::RobotModel(), 1.0, 0.01, 3))
      drive->update(tick);
    drive->finish();
    ASSERT_TRUE(drive->trajectory().empty());
    const RunFolder folder(path_ + "/other" + (grows ? "-grows" : ""), false);
    save_map_files(folder, *drive);
    const std::string loops = read_text_file(folder.file("loops.csv"));
    EXPECT_GE(std::count(loops.begin(), loops.end(), '\n'), 2);
    EXPECT_FALSE(fs::exists(folder.file("loops.png")));
  }
  EXPECT_TRUE(fs::exists(path_ + "/loops.png")) << "of the drive whose map it is";
}

TEST_F(MapFiles, ScansHaveALineEach) {
  std::istringstream csv(read_text_file(path_ + "/scans.csv"));
  std::string head, line;
  ASSERT_TRUE(std::getline(csv, head));
  EXPECT_THAT(head, testing::StartsWith("stamp_s,inliers,"));
  const auto columns = std::count(head.begin(), head.end(), ',');
  const Trajectory& live = mapper_->live_trajectory();
  for (const StampedPose& scan : live) {
    ASSERT_TRUE(std::getline(csv, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
    EXPECT_NEAR(std::stod(line), scan.stamp.seconds(), 1e-6);
    const double inliers = std::stod(line.substr(line.find(',') + 1));
    EXPECT_GE(inliers, 0.5);
    EXPECT_LE(inliers, 1.0);
  }
  EXPECT_FALSE(std::getline(csv, line));
  EXPECT_GT(fs::file_size(path_ + "/scans.png"), 3000u);
}

/// The picture has an axis of seconds: ticks below the panels, one step apart, the first at the first scan.
TEST_F(MapFiles, ScansAreDrawnOverAnAxisOfSeconds) {
  const cv::Mat picture = cv::imread(path_ + "/scans.png");
  ASSERT_FALSE(picture.empty());
  const auto dark = [&](int y, int x) { return picture.at<cv::Vec3b>(y, x)[1] < 60; };
  std::vector<int> ticks;
  for (int y = picture.rows - 60; y < picture.rows && ticks.size() < 2; ++y) {
    ticks.clear();
    for (int x = 0; x < picture.cols; ++x)
      if (dark(y, x) && dark(y + 1, x) && dark(y + 2, x)) ticks.push_back(x);
  }
  ASSERT_GE(ticks.size(), 2u);
  for (std::size_t i = 2; i < ticks.size(); ++i) EXPECT_NEAR(ticks[i] - ticks[i - 1], ticks[1] - ticks[0], 1);
  const auto& live = mapper_->live_trajectory();
  const double seconds = live.back().stamp - live.front().stamp;
  const double step = (ticks[1] - ticks[0]) * seconds / 999.0;
  EXPECT_NEAR(round_step(0.99 * step), step, 0.01 * step) << "seconds between two ticks";
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < ticks[0] && x < 8; ++x) ASSERT_FALSE(dark(y, x)) << "a name is cut off at " << y;
}

/// As g2o defines it: the error of an edge is the pose by which its end misses where the edge would have it, seen from
/// there.
double chi2_of_g2o(const std::string& text, std::size_t& vertices, std::size_t& edges) {
  std::istringstream in(text);
  std::vector<TPose2D> nodes;
  double chi2 = 0.0;
  std::string line;
  vertices = edges = 0;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    if (tag == "VERTEX_SE2") {
      std::size_t id = 0;
      TPose2D pose;
      words >> id >> pose.x >> pose.y >> pose.phi;
      EXPECT_EQ(id, nodes.size());
      nodes.push_back(pose);
      ++vertices;
    } else if (tag == "EDGE_SE2") {
      std::size_t from = 0, to = 0;
      TPose2D z;
      double i11, i12, i13, i22, i23, i33;
      words >> from >> to >> z.x >> z.y >> z.phi >> i11 >> i12 >> i13 >> i22 >> i23 >> i33;
      EXPECT_TRUE(words) << line;
      const double c = std::cos(nodes[from].phi), s = std::sin(nodes[from].phi);
      const double dx = nodes[to].x - nodes[from].x, dy = nodes[to].y - nodes[from].y;
      const double ax = c * dx + s * dy - z.x, ay = -s * dx + c * dy - z.y;
      const double ex = std::cos(z.phi) * ax + std::sin(z.phi) * ay;
      const double ey = -std::sin(z.phi) * ax + std::cos(z.phi) * ay;
      const double et = wrap_angle(nodes[to].phi - nodes[from].phi - z.phi);
      chi2 += i11 * ex * ex + i22 * ey * ey + i33 * et * et + 2.0 * (i12 * ex * ey + i13 * ex * et + i23 * ey * et);
      ++edges;
    } else {
      EXPECT_EQ(tag, "FIX");
    }
  }
  return chi2;
}

TEST_F(MapFiles, AG2oReaderFindsTheSameChi2) {
  const std::string out = path_ + "/graph.g2o";
  export_map(path_, out);
  std::size_t vertices = 0, edges = 0;
  const double chi2 = chi2_of_g2o(read_text_file(out), vertices, edges);
  const slam::PoseGraph& graph = mapper_->key_frames().graph();
  double ours = 0.0;
  std::size_t on = 0;
  for (const slam::GraphEdge& edge : graph.edges) {
    if (!edge.on) continue;
    ours += slam::squared_sigmas(graph, edge);
    ++on;
  }
  EXPECT_EQ(vertices, graph.nodes.size());
  EXPECT_EQ(edges, on);
  EXPECT_GT(ours, 0.1);
  EXPECT_NEAR(chi2, ours, 1e-6 * ours);
}

/// MRPT's own map of the exported scans shows the same walls.
TEST_F(MapFiles, MrptReadsTheSimplemap) {
  const std::string out = path_ + "/map.simplemap";
  export_map(path_, out);
  mrpt::maps::CSimpleMap simple;
  ASSERT_TRUE(simple.loadFromFile(out));
  const slam::SavedMap saved = slam::decode_map(mapper_->saved_map(), "map");
  ASSERT_EQ(simple.size(), saved.scans.size());
  for (std::size_t i = 0; i < simple.size(); ++i) {
    mrpt::poses::CPose3DPDF::ConstPtr pose;
    mrpt::obs::CSensoryFrame::ConstPtr frame;
    simple.get(i, pose, frame);
    mrpt::poses::CPose3D mean;
    pose->getMean(mean);
    const TPose2D expected = saved.frames.pose(saved.scans[i].frame) + saved.scans[i].T_frame_base;
    EXPECT_NEAR(mean.x(), expected.x, 1e-9);
    EXPECT_NEAR(mean.y(), expected.y, 1e-9);
    EXPECT_NEAR(wrap_angle(mean.yaw() - expected.phi), 0.0, 1e-9);
  }
  mrpt::maps::COccupancyGridMap2D grid(-5.0f, 8.0f, -5.0f, 8.0f, 0.05f);
  grid.loadFromSimpleMap(simple);
  const OccupancyGrid ours = mapper_->map().classify();
  int occupied = 0, agree = 0;
  for (int y = 0; y < ours.height(); ++y)
    for (int x = 0; x < ours.width(); ++x) {
      if (ours[{x, y}] != Occupancy::Occupied) continue;
      ++occupied;
      const auto p = ours.centre({x, y});
      bool near = false;
      for (const double dx : {-0.05, 0.0, 0.05})
        for (const double dy : {-0.05, 0.0, 0.05})
          near = near || grid.getPos(static_cast<float>(p.x + dx), static_cast<float>(p.y + dy)) < 0.4f;
      agree += near ? 1 : 0;
    }
  EXPECT_GT(occupied, 300);
  EXPECT_GT(agree, 0.95 * occupied);
}

slam::MapScan scan_at(double seconds, double x) {
  slam::MapScan scan;
  scan.scan.stamp = Stamp::from_seconds(seconds);
  scan.T_map_base = {x, 0.0, 0.0};
  return scan;
}

/// In the order of time, whichever of the two was driven first; of the scans of a key frame the first.
TEST(MergedWay, IsOfBothDrivesWhereTheOneEndedBeforeTheOther) {
  for (const bool second_is_older : {false, true}) {
    const double second = second_is_older ? -100.0 : 100.0;
    const auto way =
        merged_way({scan_at(1, 1), scan_at(1, 9), scan_at(2, 2), scan_at(second, 3), scan_at(second + 1, 4)}, 3);
    ASSERT_TRUE(way);
    std::vector<double> x;
    for (const StampedPose& stamped : *way) x.push_back(stamped.pose.x);
    EXPECT_EQ(x, second_is_older ? (std::vector<double>{3, 4, 1, 2}) : (std::vector<double>{1, 2, 3, 4}));
  }
}

TEST(MergedWay, IsNoneOfDrivesAtOneTime) {
  EXPECT_FALSE(merged_way({scan_at(1, 1), scan_at(3, 2), scan_at(2, 3), scan_at(4, 4)}, 2));
  EXPECT_FALSE(merged_way({scan_at(1, 1), scan_at(2, 2), scan_at(2, 3), scan_at(4, 4)}, 2));
  EXPECT_FALSE(merged_way({scan_at(2, 1), scan_at(1, 2), scan_at(5, 3)}, 2));
}

TEST_F(MapFiles, AnotherEndingIsRefused) {
  EXPECT_FALSE(is_map_export("a.rawlog"));
  EXPECT_THROW(export_map(path_, path_ + "/map.xyz"), InputError);
}

}  // namespace
}  // namespace rubble::scenarios
