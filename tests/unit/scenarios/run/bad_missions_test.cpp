// What can go wrong on a mission in the real simulator: each has a sensible end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"
#include "base/angle.h"
#include "scenarios/run/core.h"
#include "scenarios/run/mission_figures.h"
#include "scoring/trajectory/trajectory_error.h"
#include "sim/sim_robot.h"
#include "tests/support/base_files.h"

namespace rubble::scenarios {
namespace {

using mrpt::math::TPose2D;

struct Mission {
  std::string end, decisions;
  scoring::DriveFigures drive;
  std::size_t victims = 0, true_victims = 0;
  double ate_m = 0.0;     ///< of the mapper's trajectory, aligned
  double phantoms = 0.0;  ///< share of its map's walls that are nowhere near a true one
  Trajectory truth, estimate;
};

/// Share of the occupied cells of a map that have no wall within 0.2 m in truth.
double phantom_share(const slam::CountMap& map, const arenas::Arena& arena) {
  constexpr int kNear = 4;  // cells of the truth, of 5 cm
  const OccupancyGrid truth = arenas::truth_map(arena);
  const auto wall_near = [&](const Cell& c) {
    for (int y = c.y - kNear; y <= c.y + kNear; ++y)
      for (int x = c.x - kNear; x <= c.x + kNear; ++x)
        if (truth.inside({x, y}) && truth[{x, y}] == Occupancy::Occupied) return true;
    return false;
  };
  int walls = 0, phantoms = 0;
  for (int y = 0; y < map.frame().height; ++y)
    for (int x = 0; x < map.frame().width; ++x) {
      const Cell c{x, y};
      if (map.seen(c) < 3 || 2 * map.occupied(c) < map.seen(c)) continue;
      ++walls;
      phantoms += wall_near(truth.cell(arena.start.composePoint(map.frame().centre(c)))) ? 0 : 1;
    }
  return walls == 0 ? 1.0 : static_cast<double>(phantoms) / walls;
}

/// What happens to the measurements of a tick, which the robot drove by these commands.
using Spoil = std::function<void(robot::Inputs&, const robot::Commands&)>;

Mission drive(const arenas::Arena& arena, Scenario scenario, const Spoil& spoil = {}) {
  scenario.time_limit = scenario.sim.time_limit = 1500.0;
  const test::TempFolder folder;
  sim::SimRobot robot(arena, scenario.robot, scenario.sim, scenario.seed);
  Core core(scenario, scenario.robot, true, folder.path());
  robot::Commands commands;
  while (auto inputs = robot.read()) {
    if (spoil) spoil(*inputs, commands);
    commands = core.step(*inputs);
    robot.command(commands);
    if (core.finished()) break;
  }
  const scoring::MissionFigures figures = mission_figures(arena, robot.truth(), scenario.robot, core);
  return {figures.end_code,
          decisions_text(core),
          figures.drive,
          core.victims().size(),
          arena.victims.size(),
          scoring::trajectory_error(core.mapper().trajectory(), robot.truth()).ate_aligned_m,
          phantom_share(core.mapper().map(), arena),
          robot.truth(),
          core.mapper().trajectory()};
}

arenas::Arena small_yellow(std::uint64_t seed, int pallets = 6) {
  arenas::GenerateConfig config;
  config.columns = config.rows = pallets;
  config.ramps = 0.4;
  config.paper = 0.1;
  config.seed = seed;
  return arenas::parse_arena(arenas::generate_arena(config), "yellow");
}

/// From 60 s on, as soon as the servos stand `deg` off the body's own level.
Mission with_fault(sim::LevellingFault fault, double deg, std::uint64_t seed) {
  Scenario scenario;
  scenario.seed = seed;
  scenario.sim.levelling_fault = fault;
  scenario.sim.levelling_fault_tilt = deg_to_rad(deg);
  return drive(small_yellow(seed), scenario);
}

/// Twenty missions each: by a tilted laser some pose is lost and some robot wedged whatever it does, but few are.
class ALevellingUnitThatFails : public ::testing::Test {
 protected:
  /// `within`: the pose that it drove home by may be off by so much [m].
  static void expect_home(sim::LevellingFault fault, double deg, const std::string& told, double within = 0.6) {
    int home = 0;
    std::vector<double> contact_s;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed);
      const Mission mission = with_fault(fault, deg, seed);
      const std::size_t failed = mission.decisions.find(told);
      EXPECT_NE(failed, std::string::npos) << mission.decisions;
      EXPECT_EQ(mission.decisions.find("confirmed", failed), std::string::npos) << "no victim while scans are doubted";
      EXPECT_LE(mission.victims, mission.true_victims);
      home += mission.end == "home" && mission.drive.home_m < within ? 1 : 0;
      // The bound is that of the ten drives it was set for: of forty with a jam the thirty-second has 2 to 4 s.
      if (seed <= 10) contact_s.push_back(mission.drive.contact_s);
    }
    EXPECT_GE(home, 18);
    std::sort(contact_s.begin(), contact_s.end());
    EXPECT_LT(contact_s[7], 3.0) << "of eight of the first ten";
  }
};

TEST_F(ALevellingUnitThatFails, TiltedAndSilentTheRobotGoesHome) {
  expect_home(sim::LevellingFault::Silent, 7.0, "the levelling unit is silent");
}

TEST_F(ALevellingUnitThatFails, LevelAndSilentTheRobotGoesHome) {
  expect_home(sim::LevellingFault::Silent, 0.0, "the levelling unit is silent");
}

TEST_F(ALevellingUnitThatFails, WithServosThatJamTheRobotGoesHome) {
  expect_home(sim::LevellingFault::Jammed, 7.0, "the levelling unit does not take the tilt away",
              1.0);  // a jam is seen late: farther is `lost`
}

TEST(StartOnARamp, IsAMissionLikeAnyOther) {
  const arenas::Arena arena = arenas::parse_arena(
      "name: ramp\n"
      "maze: |\n"
      "  +---+---+---+---+\n"
      "  |S>  .1  <   .  |\n"
      "  +---+---+---+   +\n"
      "  |.   .   .   .  |\n"
      "  +---+---+---+---+\n",
      "ramp");
  // Of any twenty drives two or three touch something for 3 to 7 s, whatever the mapper expects of slopes.
  std::vector<double> contact_s;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Scenario scenario;
    scenario.seed = seed;
    const Mission mission = drive(arena, scenario);
    EXPECT_EQ(mission.end, "home") << mission.decisions;
    EXPECT_LT(mission.drive.home_m, 0.6);
    contact_s.push_back(mission.drive.contact_s);
  }
  std::sort(contact_s.begin(), contact_s.end());
  EXPECT_LT(contact_s[7], 3.0) << "of eight of them";
}

/// A spell in the middle of a mission: from 60 s on, as soon as the robot is told to drive fast.
class Spell {
 public:
  explicit Spell(double seconds) : seconds_(seconds) {}

  /// In each tick, in order.
  bool on(Stamp now, const robot::Commands& commands) {
    if (!from_ && now.seconds() > 60.0 && commands.drive.v > 0.3) from_ = now;
    const bool is_on = from_ && now - *from_ < seconds_;
    if (is_on) told_way_ += std::abs(commands.drive.v) * kTick;
    return is_on;
  }
  bool came() const { return from_.has_value(); }
  /// That the robot was told to drive meanwhile [m].
  double told_way() const { return told_way_; }
  /// Of the drive in this spell and for ten seconds after it.
  scoring::DriveFigures figures(const arenas::Arena& arena, const Trajectory& truth) const {
    return drive_figures(arena, piece(truth, 0.0, seconds_ + 10.0), {});
  }
  /// Of the poses from ten seconds after it on [m].
  double error_after(const Mission& mission) const {
    return scoring::trajectory_error(piece(mission.estimate, seconds_ + 10.0, 1e9), mission.truth).ate_aligned_m;
  }

 private:
  /// From so long after it began to so long after it.
  Trajectory piece(const Trajectory& all, double from, double to) const {
    Trajectory part;
    for (const StampedPose& at : all)
      if (from_ && at.stamp - *from_ >= from && at.stamp - *from_ < to) part.push_back(at);
    return part;
  }

  const double kTick = robot::RobotModel().tick;
  double seconds_;
  std::optional<Stamp> from_;
  double told_way_ = 0.0;
};

/// A fault that passes, with the mapper that drives a mission unless another is asked for.
class AFaultThatPasses : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kSeeds = 8;

  void drive_spoilt(std::uint64_t seed, const Spoil& spoil) {
    Scenario scenario;
    scenario.seed = seed;
    ASSERT_EQ(scenario.mapper.kind(), "robust");
    arena_ = small_yellow(seed, 5);
    mission_ = drive(arena_, scenario, spoil);
  }
  bool is_good_mission() const {
    return mission_.end == "home" && mission_.victims == mission_.true_victims && mission_.phantoms < 0.02;
  }
  void expect_good_mission() const {
    EXPECT_EQ(mission_.end, "home") << mission_.decisions;
    EXPECT_EQ(mission_.victims, mission_.true_victims);
    EXPECT_LT(mission_.phantoms, 0.02);
  }
  /// The odometry stays what it was for 5 s. `goes_on`: the wheels were counted meanwhile, so it then jumps to where it
  /// would be; otherwise it goes on from where it stayed.
  void expect_to_get_over_frozen_odometry(bool goes_on) {
    std::uint64_t good = 0;
    int pushed_on = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed);
      Spell frozen(5.0);
      TPose2D last;    // that was counted
      TPose2D stayed;  // that was told
      drive_spoilt(seed, [&](robot::Inputs& inputs, const robot::Commands& commands) {
        const bool on = frozen.on(inputs.now, commands);
        for (robot::Odometry& odometry : inputs.odometry) {
          const TPose2D counted = odometry.pose;
          if (!on) stayed = goes_on ? counted : stayed + (counted - last);
          last = counted;
          odometry.pose = stayed;
          if (on) odometry.v = odometry.w = 0.0;
        }
      });
      ASSERT_TRUE(frozen.came());
      good += is_good_mission() ? 1 : 0;
      EXPECT_LT(frozen.error_after(mission_), 0.15);
      const double contact_s = frozen.figures(arena_, mission_.truth).contact_s;
      pushed_on += contact_s < 2.0 ? 0 : 1;
      EXPECT_LT(contact_s, 7.0) << "longer than the spell";
    }
    // In a corridor without an end in sight nothing but wheels tells how far the robot came: 2 m in such a spell.
    EXPECT_GE(good, kSeeds - 2) << "of " << kSeeds;
    // The place lags by up to 0.3 m meanwhile, and a robot that touches something has no wheels to tell it.
    EXPECT_LE(pushed_on, 1) << "of " << kSeeds;
  }

  arenas::Arena arena_;
  Mission mission_;
};

TEST_F(AFaultThatPasses, ALaserThatIsSilentFor2SecondsStopsTheRobotAndSpoilsNothing) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Spell silent(2.0);
    drive_spoilt(seed, [&](robot::Inputs& inputs, const robot::Commands& commands) {
      if (silent.on(inputs.now, commands)) inputs.scans.clear();
    });
    ASSERT_TRUE(silent.came());
    expect_good_mission();
    EXPECT_LT(mission_.ate_m, 0.03);
    EXPECT_LT(silent.told_way(), 0.3) << "drives blindly";
  }
}

TEST_F(AFaultThatPasses, AReportOfOdometryThatIsFrozenFor5SecondsIsGotOver) {
  expect_to_get_over_frozen_odometry(true);
}

TEST_F(AFaultThatPasses, CountersOfWheelsThatStopFor5SecondsAreGotOver) { expect_to_get_over_frozen_odometry(false); }

}  // namespace
}  // namespace rubble::scenarios
