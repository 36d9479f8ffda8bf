#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "base/text/text_file.h"
#include "scenarios/run/map_files.h"
#include "scenarios/run/run.h"
#include "slam/robust/robust_mapper.h"
#include "tests/support/robot_carmen.h"
#include "tests/support/slam_floor.h"

/// By which stamps the files of a run call the scans.
namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

/// Twice round a floor, seen by a scanner as FLASER has it.
std::vector<robot::Inputs> twice_round() {
  robot::RobotModel model;
  model.T_base_laser = {};
  model.laser.beams = 181;
  model.laser.angle_min = deg_to_rad(-90.0);
  model.laser.angle_step = deg_to_rad(1.0);
  model.laser.range_max = 20.0;
  const slam_test::Floor floor(3, 2, 2);
  const auto drive = slam_test::drive_through(
      floor.way({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}), 0.0);
  return slam_test::record(floor.world(), drive, model, 1.0, 0.01, 3);
}

/// The same as a CARMEN log whose clock is early by a tenth of a second each seventh time.
std::string with_a_jittering_clock(const std::vector<robot::Inputs>& ticks) {
  robot::testing::CarmenWriter log;
  int i = 0;
  for (const robot::Inputs& tick : ticks)
    for (const robot::LaserScan& scan : tick.scans) {
      const mrpt::math::TPose2D pose = tick.odometry.back().pose;
      const double time = 1000.0 + scan.stamp.seconds() - (++i % 7 == 0 ? 0.1 + 0.003 : 0.0);
      log.odom(pose, time);
      log.flaser({scan.ranges.begin(), scan.ranges.end()}, pose, pose, time);
    }
  return log.text;
}

/// Of the first `columns`.
std::vector<std::string> stamps_of(const std::string& file, char between, int columns = 1) {
  std::istringstream text(read_text_file(file));
  std::vector<std::string> stamps;
  std::string line;
  while (std::getline(text, line)) {
    if (line.find("stamp_s") == 0) continue;
    std::istringstream fields(line);
    std::string stamp;
    for (int k = 0; k < columns && std::getline(fields, stamp, between); ++k) stamps.push_back(stamp);
  }
  return stamps;
}

TEST(LogStamps, AllFilesCallAScanByTheStampOfItsLog) {
  const std::string folder = (fs::temp_directory_path() / "rubble-log-stamps").string();
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_text_file(folder + "/a.log", with_a_jittering_clock(twice_round()));
  RunOptions options;
  options.out = folder + "/run";
  options.link_latest = false;
  map_log(folder + "/a.log", default_scenario({}), options);

  const auto poses = stamps_of(options.out + "/estimate.tum", ' ');
  const std::set<std::string> known(poses.begin(), poses.end());
  // Line by line as in the log: the clock runs back where it jitters.
  const auto scans = stamps_of(options.out + "/scans.csv", ',');
  EXPECT_GT(scans.size(), 100u);
  EXPECT_EQ(std::set<std::string>(scans.begin(), scans.end()), known);
  for (std::size_t i = 7; i < scans.size(); i += 7) EXPECT_LT(std::stod(scans[i - 1]), std::stod(scans[i - 2])) << i;
  const auto loops = stamps_of(options.out + "/loops.csv", ',', 2);
  EXPECT_FALSE(loops.empty());
  for (const std::string& stamp : loops) EXPECT_EQ(known.count(stamp), 1u) << stamp;
  fs::remove_all(folder);
}

/// Other names leave the picture as it is.
TEST(LogStamps, ThePictureIsDrawnOverTheTimeThatTheMapperSaw) {
  slam::RobustMapper mapper(robot::RobotModel(), {}, 1);
  for (const robot::Inputs& tick : twice_round()) mapper.update(tick);
  const std::string path = (fs::temp_directory_path() / "rubble-log-stamps-picture").string();
  std::vector<std::string> pictures;
  std::vector<std::string> tables;
  std::vector<std::string> loops;
  for (const double later : {0.0, 500.0}) {
    const std::string run = path + std::to_string(pictures.size());
    fs::remove_all(run);
    const RunFolder folder(run, false);
    save_map_files(folder, mapper, [&](Stamp stamp) { return stamp.ns % 200000000 == 0 ? stamp + later : stamp; });
    pictures.push_back(read_text_file(run + "/scans.png"));
    tables.push_back(read_text_file(run + "/scans.csv"));
    loops.push_back(read_text_file(run + "/loops.csv"));
    fs::remove_all(run);
  }
  EXPECT_NE(tables[0], tables[1]);
  EXPECT_NE(loops[0], loops[1]);
  EXPECT_EQ(pictures[0], pictures[1]);
}

}  // namespace
}  // namespace rubble::scenarios
