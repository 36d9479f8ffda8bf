#include "scenarios/config/scenario.h"
#include "slam/paper/paper_mapper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/yaml/binder.h"
#include "tests/support/source_dir.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ScenarioFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("rubble-scenario-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path) << text;
    return path;
  }

  std::string error_of(const std::string& text, const std::vector<Override>& overrides = {}) const {
    try {
      load_scenario(write("s.yaml", text), overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(ScenarioFile, ResolvedScenarioReadsBackToItself) {
  const std::string path = write("s.yaml",
                                 "name: x\nseed: 42\narena: {generate: {columns: 5, rows: 6, ramps: 0.35}}\n"
                                 "geo: {latitude_deg: 50.36, longitude_deg: 7.56, heading_deg: 12.5}\n"
                                 "robot: {levelling: false, laser: {z_m: 0.3}}\n"
                                 "mapper: {kind: paper, rotation_error: 0.07, gate_turn_deg: 3.3}\n"
                                 "expect: {score: {min: 0.5}, ate_aligned_m: {min: 0, max: 0.4}}\n");
  const Scenario scenario = load_scenario(path);
  const std::string resolved = resolved_yaml(scenario);
  const Scenario again = load_scenario(write("again.yaml", resolved));
  EXPECT_EQ(resolved_yaml(again), resolved);
  EXPECT_FALSE(again.levelling.on);
  EXPECT_EQ(again.seed, 42u);
  EXPECT_EQ(again.arena_seed(), 42u);
  EXPECT_EQ(again.mapper.as<slam::PaperConfig>().gate_turn, scenario.mapper.as<slam::PaperConfig>().gate_turn)
      << "angles must survive the trip through degrees";
  EXPECT_EQ(again.robot.laser.angle_min, scenario.robot.laser.angle_min);
  ASSERT_EQ(again.expect.size(), 2u);
  EXPECT_EQ(*again.expect[1].max, 0.4);
}

TEST_F(ScenarioFile, OverridesWinOverTheFile) {
  const std::string path =
      write("s.yaml", "arena: {generate: {}}\nseed: 1\nrobot: {levelling: true}\nmapper: {kind: paper}\n");
  const Scenario s = load_scenario(path, {{"robot.levelling", "false"}, {"seed", "9"}, {"mapper.particles", "50"}});
  EXPECT_FALSE(s.levelling.on);
  EXPECT_EQ(s.seed, 9u);
  EXPECT_EQ(s.mapper.as<slam::PaperConfig>().particles, 50);
}

TEST_F(ScenarioFile, ArenaFollowsTheSeedUnlessItHasItsOwn) {
  const std::string follows = write("a.yaml", "arena: {generate: {columns: 3, rows: 3}}\n");
  const std::string own = write("b.yaml", "arena: {generate: {columns: 3, rows: 3, seed: 5}}\n");
  EXPECT_NE(arena_yaml(load_scenario(follows, {{"seed", "1"}})), arena_yaml(load_scenario(follows, {{"seed", "2"}})));
  EXPECT_EQ(arena_yaml(load_scenario(own, {{"seed", "1"}})), arena_yaml(load_scenario(own, {{"seed", "2"}})));
}

TEST_F(ScenarioFile, AScannerIsChosenByName) {
  const std::string path = write("s.yaml", "arena: {generate: {}}\n");
  EXPECT_EQ(load_scenario(path).robot.laser.beams, 682);
  const std::vector<Override> utm{{"robot.laser.model", "UTM-30LX"}};
  const robot::LaserModel laser = load_scenario(path, utm).robot.laser;
  EXPECT_EQ(laser.beams, 1081);
  EXPECT_EQ(laser.range_max, 30.0);
  EXPECT_NEAR(laser.field_of_view(), deg_to_rad(270.0), 1e-12);
  const std::string resolved = write("again.yaml", resolved_yaml(load_scenario(path)));
  EXPECT_EQ(load_scenario(resolved, utm).robot.laser.beams, 1081) << "no numbers of the other scanner stay behind";
}

TEST_F(ScenarioFile, AGenericScannersNumbersAreItsUsers) {
  const Scenario s = load_scenario(write(
      "s.yaml",
      "arena: {generate: {}}\nrobot:\n  laser: {model: generic, field_of_view_deg: 100, beams: 361, scan_period_s: "
      "0.05, sweep_s: 0.02, min_range_m: 0.1, max_range_m: 25, accuracy_m: 0.02, far_accuracy_m: 0.04}\n"));
  const robot::LaserModel& laser = s.robot.laser;
  EXPECT_NEAR(laser.angle_min, deg_to_rad(-50.0), 1e-12);
  EXPECT_NEAR(laser.field_of_view(), deg_to_rad(100.0), 1e-12);
  EXPECT_NEAR(360 * laser.beam_period, 0.02, 1e-12);
  EXPECT_EQ(laser.accuracy_far, 0.04);
  const robot::LaserModel again = load_scenario(write("again.yaml", resolved_yaml(s))).robot.laser;
  EXPECT_EQ(again.angle_min, laser.angle_min) << "to the bit";
  EXPECT_EQ(again.angle_step, laser.angle_step);
  EXPECT_EQ(again.beam_period, laser.beam_period);
  EXPECT_EQ(again.beams, laser.beams);
}

TEST_F(ScenarioFile, ScannersThatCannotBeAreRefused) {
  const auto error = [&](const std::string& laser) {
    return error_of("arena: {generate: {}}\nrobot:\n  laser: {" + laser + "}\n");
  };
  EXPECT_THAT(error("model: URG-4LX"), HasSubstr("did you mean 'URG-04LX'"));
  EXPECT_THAT(error("sweep_s: 0.05"), HasSubstr("s.yaml:3:11: is for 'model: generic'"));
  EXPECT_THAT(error("model: generic, field_of_view_deg: 90, step_deg: 1"), HasSubstr("keep one way to say it"));
  EXPECT_THAT(error("step_deg: 1"), HasSubstr("more than a full turn"));
  EXPECT_THAT(error("scan_period_s: 0.05"), HasSubstr("shorter than the sweep"));
}

TEST_F(ScenarioFile, AUnitThatIsNotThereCannotFail) {
  const std::string text = "arena: {generate: {}}\nrobot: {levelling: false}\nsim: {levelling_fault: jammed}\n";
  EXPECT_THAT(error_of(text), HasSubstr("s.yaml:3:7: of a robot with 'levelling: false'"));
}

/// The run folder's arena.yaml must not need the files that the arena included.
TEST_F(ScenarioFile, AnArenaOfSeveralFilesBecomesOne) {
  write("piece.yaml", "maze: |\n  +---+\n  | .\n  +---+\n");
  write("arena.yaml",
        "maze: |\n  +---+---+\n  |S.     |\n  +---+---+\ninclude: [{file: piece.yaml, at: [1, 0], turn: 180}]\n");
  const std::string text = arena_yaml(load_scenario(write("s.yaml", "arena: {file: arena.yaml}\n")));
  EXPECT_EQ(text.find("piece.yaml"), std::string::npos);
  EXPECT_THAT(text, HasSubstr("|S.   . |"));
}

TEST_F(ScenarioFile, FaultsAreNamedWithTheirPlace) {
  EXPECT_THAT(error_of("arena: {generate: {}}\nmaper: {particles: 3}\n"), HasSubstr("s.yaml:2:1"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nmaper: {particles: 3}\n"), HasSubstr("mapper"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nmapper: {particles: many}\n"), HasSubstr("s.yaml:2:"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nmapper: {particles: 0}\n"), HasSubstr("particles"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nseed: 1\nseed: 2\n"), HasSubstr("s.yaml:3:1"));
  EXPECT_THAT(error_of("seed: 1\n"), HasSubstr("arena"));
  EXPECT_THAT(error_of("arena: {file: nowhere.yaml}\n"), HasSubstr("nowhere.yaml"));
  EXPECT_THAT(error_of("arena: {generate: {}, file: a.yaml}\n"), HasSubstr("exactly one"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nexpect: {scrore: {min: 1}}\n"), HasSubstr("scrore"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nexpect: {score: {}}\n"), HasSubstr("min"));
  EXPECT_THAT(error_of("arena: {generate: {}}\nexplorer: {d_min_m: 0.7}\n"), HasSubstr("d_opt_m"));
  EXPECT_THAT(error_of("arena: {generate: {}}\n", {{"robot.leveling", "false"}}), HasSubstr("--set robot.leveling"));
}

TEST(Shortest, ReadsBackToTheSameBits) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 12345678.9, 0.05, -2.5})
    EXPECT_EQ(std::stod(number_text(value)), value);
}

/// Section III.B, value by value.
TEST(ShippedScenario, YellowPaperIsThePaperAsPrinted) {
  const Scenario scenario = load_scenario(RUBBLE_SOURCE_DIR "/scenarios/yellow_paper.yaml");
  ASSERT_EQ(scenario.mapper.kind(), "paper");
  const auto& c = scenario.mapper.as<slam::PaperConfig>();
  EXPECT_EQ(c.map_cells, 800);
  EXPECT_EQ(c.resolution, 0.1) << "on ramps";
  EXPECT_EQ(c.particles, 300);
  EXPECT_EQ(c.top_share, 0.05);
  EXPECT_EQ(c.motion_error.rotation, 0.05);
  EXPECT_NEAR(c.motion_error.heading_per_m, deg_to_rad(5.0), 1e-12);
  EXPECT_EQ(c.motion_error.distance, 0.15);
  EXPECT_EQ(c.gated, slam::GatedPart::Resampling);
  EXPECT_EQ(c.gate_distance, 0.02);
  EXPECT_NEAR(c.gate_turn, deg_to_rad(5.0), 1e-12);
  EXPECT_TRUE(c.icp);
  EXPECT_EQ(c.icp_target, slam::IcpTarget::LastScan);
  EXPECT_FALSE(c.icp_trimmed);
  EXPECT_EQ(c.rim_margin, 0.0) << "all beams";
  EXPECT_FALSE(c.deskew);
  EXPECT_EQ(c.sweep_reference, slam::SweepReference::Stamp);
}

}  // namespace
}  // namespace rubble::scenarios
