#include "scenarios/run/run_folder.h"

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/text/csv.h"
#include "base/text/text_file.h"
#include "tests/support/scenarios_batch.h"

namespace rubble::scenarios {
namespace {

/// Knows what it is told to know.
class ToldMapper : public slam::Mapper {
 public:
  void update(const robot::Inputs&) override {}
  const slam::CountMap& map() const override { return map_; }
  mrpt::math::TPose2D pose() const override { return {}; }
  PoseCovariance covariance() const override { return {}; }
  std::uint64_t revision() const override { return moved; }
  std::optional<mrpt::math::TPose2D> pose_at(Stamp) const override { return std::nullopt; }
  const Trajectory& trajectory() const override { return now; }
  const Trajectory& live_trajectory() const override { return live; }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override { return hits_; }
  const slam::MapperCounts& counts() const override { return counts_; }

  void see(double seconds, double x) {
    const StampedPose pose{Stamp::from_seconds(seconds), {x, 0.0, 0.0}};
    now.push_back(pose);
    live.push_back(pose);
  }

  Trajectory now, live;
  std::uint64_t moved = 0;

 private:
  slam::CountMap map_{10, 10, 0.1};
  std::vector<mrpt::math::TPoint2D> hits_;
  slam::MapperCounts counts_;
};

class RunFolderFiles : public FolderTest {
 protected:
  std::string text_of(const Trajectory& trajectory) const {
    std::string text;
    for (const auto& pose : trajectory) text += tum_line(pose) + "\n";
    return text;
  }
};

TEST_F(RunFolderFiles, ClosedLoopsMoveTheEstimateButNotTheLiveOne) {
  RunFolder folder(path("run"), false);
  const auto estimate = [&] { return read(folder.file("estimate.tum")); };
  const auto live = [&] { return read(folder.file("estimate_live.tum")); };
  ToldMapper mapper;
  mapper.see(0.0, 1.0);
  mapper.see(0.1, 2.0);
  folder.append_estimate(mapper);
  EXPECT_EQ(estimate(), text_of(mapper.now));
  EXPECT_EQ(live(), text_of(mapper.live));

  const std::string before = estimate();
  mapper.now[0].pose.x = 1.5;
  ++mapper.moved;
  mapper.see(0.2, 3.0);
  folder.append_estimate(mapper);
  EXPECT_EQ(estimate(), before) << "never half the old trajectory and half the new one";
  EXPECT_EQ(live(), text_of(mapper.live));
  folder.save_estimate(mapper);
  EXPECT_EQ(estimate(), text_of(mapper.now));
  EXPECT_NE(estimate(), live());

  mapper.see(0.3, 4.0);
  folder.append_estimate(mapper);
  EXPECT_EQ(estimate(), text_of(mapper.now)) << "it grows again";
  EXPECT_EQ(live(), text_of(mapper.live));
}

TEST_F(RunFolderFiles, ARobotsNameStaysOneFieldOfTheListOfVictims) {
  RunFolder folder(path("run"), false);
  ToldMapper mapper;
  mapper.see(0.0, 1.0);
  Scenario scenario = default_scenario({});
  std::vector<explore::VictimReport> victims(1);
  for (const std::string& name : {std::string("=1+1"), std::string(500, 'x'), std::string("a,b\n\"c\"")}) {
    scenario.robot.name = name;
    folder.save_map(scenario, mapper, victims);
    const std::string list = read(folder.file("pois.csv"));
    ASSERT_EQ(list.substr(list.size() - 3), ",A\n") << name;
    const std::size_t begin = list.rfind('\n', list.size() - 2) + 1;
    const auto fields = csv_fields(list.substr(begin, list.size() - 1 - begin));
    ASSERT_EQ(fields.size(), 9u) << list;
    EXPECT_EQ(fields[0], std::to_string(victims[0].id));
    EXPECT_EQ(fields[7].size(), name.size() + (name[0] == '=' ? 1 : 0));
    EXPECT_NE(fields[7].substr(0, 1), "=");
  }
}

TEST_F(RunFolderFiles, VictimsAreListedWithTheirCovarianceAndSenses) {
  RunFolder folder(path("run"), false);
  ToldMapper mapper;
  mapper.see(0.0, 1.0);
  explore::VictimReport victim;
  victim.id = 3;
  victim.p_map = {1.5, -2.0};
  victim.stamp = Stamp::from_seconds(12.5);
  victim.confidence = 0.75;
  victim.cues = {robot::CueKind::Sound, robot::CueKind::Co2};
  victim.covariance = {0.04, -0.01, 0.09};
  folder.save_map(default_scenario({}), mapper, {victim});
  EXPECT_EQ(read(folder.file("victims.csv")),
            "id,time_s,x_m,y_m,xx_m2,xy_m2,yy_m2,confidence,senses\n"
            "3,12.50,1.500,-2.000,0.04000,-0.01000,0.09000,0.750,sound co2\n");
}

TEST_F(RunFolderFiles, LatestIsTheLastRunThatPlacedAScan) {
  namespace fs = std::filesystem;
  const fs::path link = path("runs/latest");
  ToldMapper mapper, blind;
  mapper.see(0.0, 1.0);
  const auto end_run = [&](const std::string& name, const slam::Mapper& of) {
    RunFolder folder(path(name), false);
    folder.close();
    folder.link_latest(of);
  };
  end_run("runs/first", mapper);
  EXPECT_EQ(fs::read_symlink(link), "first");
  end_run("runs/second", blind);
  EXPECT_EQ(fs::read_symlink(link), "first") << "nothing can be done with the second";
  end_run("runs/third/", mapper);
  EXPECT_EQ(fs::read_symlink(link), "third");
  end_run("elsewhere/fourth", mapper);
  EXPECT_EQ(fs::read_symlink(link), "third");
  EXPECT_FALSE(fs::exists(fs::symlink_status(path("elsewhere/latest"))));

  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(path("runs"))) left += entry.path().filename() != "latest" ? 1 : 0;
  EXPECT_EQ(left, 3u) << "the new link was made beside the old one";
  fs::remove(link);
  std::ofstream(link) << "mine";
  end_run("runs/fifth", mapper);
  EXPECT_EQ(read(link.string()), "mine");
}

/// A command that is refused is given once more when it is mended, into the same folder.
TEST_F(RunFolderFiles, ARunThatNeverBeganLeavesNothing) {
  namespace fs = std::filesystem;
  ToldMapper mapper;
  { RunFolder(path("new/run"), false).write("scenario.yaml", "name: x"); }
  EXPECT_FALSE(fs::exists(path("new/run")));
  fs::create_directory(path("mine"));
  { RunFolder(path("mine"), false).write("scenario.yaml", "name: x"); }
  EXPECT_TRUE(fs::is_directory(path("mine"))) << "it was there before";
  EXPECT_TRUE(fs::is_empty(path("mine")));
  {
    const RunFolder folder(path("shared"), false);
    std::ofstream(path("shared/notes.txt")) << "mine";
  }
  EXPECT_EQ(read(path("shared/notes.txt")), "mine");
  mapper.see(0.0, 1.0);
  { RunFolder(path("begun"), false).append_estimate(mapper); }
  EXPECT_EQ(read(path("begun/estimate.tum")), text_of(mapper.now)) << "what was mapped is kept";
}

TEST_F(RunFolderFiles, OnlyWhatARunWritesIsReplaced) {
  RunFolder(path("run"), false).close();
  const std::string run = path("run") + "/";
  for (const std::string name : {"thesis.txt", "map.tif.bak", "sub"}) {
    if (name == "sub")
      std::filesystem::create_directory(run + name);
    else
      std::ofstream(run + name) << "mine";
    EXPECT_THROW(RunFolder(path("run"), true), InputError) << name;
    EXPECT_TRUE(std::filesystem::exists(run + name)) << name;
    EXPECT_TRUE(std::filesystem::exists(run + "estimate.tum")) << "nothing is removed before all is known";
    std::filesystem::remove(run + name);
  }
  for (const std::string& name : run_folder_names()) std::ofstream(run + name) << "old";
  read_text_file(run + "map.rmap");
  EXPECT_THROW(RunFolder(path("run"), true), InputError) << "what is read";
  EXPECT_EQ(read(run + "log.rlog"), "old");
  std::filesystem::remove(run + "map.rmap");
  RunFolder again(path("run"), true);
  EXPECT_FALSE(std::filesystem::exists(run + "log.rlog"));
  again.close();
  EXPECT_FALSE(std::filesystem::exists(run + ".replaced"));
}

/// What a run left, with words of its own in each file.
void write_older_run(const std::string& run) {
  std::filesystem::create_directories(run);
  for (const std::string& name : run_folder_names()) std::ofstream(run + name) << "older " << name;
}

void expect_older_run(const std::string& run) {
  for (const std::string& name : run_folder_names()) {
    std::ifstream file(run + name);
    std::string content;
    std::getline(file, content);
    EXPECT_EQ(content, "older " + name);
  }
}

TEST_F(RunFolderFiles, ARunThatFailsLeavesTheOneItWouldReplace) {
  const std::string run = path("run") + "/";
  write_older_run(run);
  {
    RunFolder fails(path("run"), true);
    fails.write("map.yaml", "newer");
  }
  expect_older_run(run);
  EXPECT_FALSE(std::filesystem::exists(run + ".replaced"));
}

TEST_F(RunFolderFiles, ARunThatWasEndedOrKilledKeepsTheOlderOneBeside) {
  const std::string run = path("run") + "/";
  write_older_run(run);
  {
    RunFolder ended(path("run"), true);
    ended.write("map.yaml", "newer");
    ended.close(false);
  }
  expect_older_run(run + ".replaced/");
  EXPECT_EQ(read(run + "map.yaml"), "newer");
  {
    // What lies above the older run is not whole: it goes, and the older one still waits for one that is.
    RunFolder fails(path("run"), true);
    EXPECT_FALSE(std::filesystem::exists(run + "map.yaml"));
    expect_older_run(run + ".replaced/");
  }
  expect_older_run(run);
}

TEST_F(RunFolderFiles, AnOlderRunThatWasHalfSetAsideIsWholeAgain) {
  const std::string run = path("run") + "/";
  write_older_run(run);
  std::filesystem::create_directory(run + ".replaced.part");
  for (const std::string name : {"estimate.tum", "map.tif"})
    std::filesystem::rename(run + name, run + ".replaced.part/" + name);
  { RunFolder fails(path("run"), true); }
  expect_older_run(run);
}

TEST_F(RunFolderFiles, SomebodysFileBesideAnOlderRunIsKept) {
  const std::string run = path("run") + "/";
  write_older_run(run);
  std::filesystem::create_directory(run + ".replaced");
  std::ofstream(run + ".replaced/thesis.txt") << "mine";
  EXPECT_THROW(RunFolder(path("run"), true), InputError);
  expect_older_run(run);
  EXPECT_EQ(read(run + ".replaced/thesis.txt"), "mine");
}

}  // namespace
}  // namespace rubble::scenarios
