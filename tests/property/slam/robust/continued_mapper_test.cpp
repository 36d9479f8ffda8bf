#include "slam/robust/continued_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/planar.h"
#include "tests/support/slam_floor.h"
#include "tests/support/slam_outcome.h"

/// A map outlives the run that made it.
namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::Inputs;
using robot::RobotModel;
using slam_test::figure;
using slam_test::play;
using Ticks = std::vector<Inputs>;

const std::vector<Cell> kRound{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}, {0, 0}};
const std::vector<Cell> kElsewhere{{2, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}};

struct Recorded {
  slam_test::Drive drive;
  Ticks ticks;
};

Recorded recorded(const slam_test::Floor& floor, const std::vector<Cell>& rooms, double heading, std::uint64_t seed) {
  Recorded out{slam_test::drive_through(floor.way(rooms), heading), {}};
  out.ticks = slam_test::record(floor.world(), out.drive, RobotModel(), 1.0, 0.01, seed);
  return out;
}

std::string map_of(const Ticks& ticks) {
  RobustMapper mapper(RobotModel(), {}, 1);
  play(mapper, ticks);
  return mapper.saved_map();
}

std::shared_ptr<const MapBase> base(std::string bytes, bool grows, std::optional<TPose2D> start = std::nullopt) {
  return std::make_shared<MapBase>(MapBase{std::move(bytes), "map", grows, start});
}

/// Errors of poses in the map against the truth, where the map's frame is the first pose of the drive that made it.
struct Errors {
  double rmse = 0.0;
  double worst = 0.0;          ///< [m]
  double worst_heading = 0.0;  ///< [rad]
};

Errors errors(const Trajectory& estimate, const Trajectory& truth, const TPose2D& T_world_map) {
  Errors e;
  double sum = 0.0;
  for (const StampedPose& pose : estimate) {
    const TPose2D expected = *pose_at(truth, pose.stamp) - T_world_map;
    const double off = length(pose.pose.x - expected.x, pose.pose.y - expected.y);
    sum += off * off;
    e.worst = std::max(e.worst, off);
    e.worst_heading = std::max(e.worst_heading, std::abs(wrap_angle(pose.pose.phi - expected.phi)));
  }
  e.rmse = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, estimate.size())));
  return e;
}

/// Share of the occupied cells that lie more than 0.1 m off the walls.
double walls_off(const OccupancyGrid& grid, const slam_test::World& world, const TPose2D& T_world_map) {
  int off = 0;
  int occupied = 0;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] != Occupancy::Occupied) continue;
      ++occupied;
      off += slam_test::distance_to(world, T_world_map.composePoint(grid.centre({x, y}))) > 0.1 ? 1 : 0;
    }
  EXPECT_GT(occupied, 300);
  return static_cast<double>(off) / std::max(1, occupied);
}

TEST(ContinuedMapper, ALogCutInTwoIsMappedAsWellAsInOnePiece) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    std::vector<Cell> twice = kRound;
    twice.insert(twice.end(), kRound.begin() + 1, kRound.end());
    const Recorded all = recorded(floor, twice, 0.0, seed);
    const auto cut = all.ticks.begin() + static_cast<std::ptrdiff_t>(all.ticks.size() * 2 / 5);
    RobustMapper whole(RobotModel(), {}, 1);
    play(whole, all.ticks);

    ContinuedMapper second(RobotModel(), {}, base(map_of(Ticks(all.ticks.begin(), cut)), true));
    play(second, Ticks(cut, all.ticks.end()));
    EXPECT_EQ(figure(second, "place_known"), 1.0);
    ASSERT_EQ(second.trajectory().size(), static_cast<std::size_t>(all.ticks.end() - cut));
    const TPose2D& T_world_map = all.drive.truth.front().pose;
    const Errors in_one = errors(whole.trajectory(), all.drive.truth, T_world_map);
    const Errors in_two = errors(second.trajectory(), all.drive.truth, T_world_map);
    RecordProperty("rmse_in_one_mm_" + std::to_string(seed), static_cast<int>(1e3 * in_one.rmse));
    RecordProperty("rmse_in_two_mm_" + std::to_string(seed), static_cast<int>(1e3 * in_two.rmse));
    EXPECT_LT(in_two.rmse, in_one.rmse + 0.01) << "in one piece " << in_one.rmse;
    EXPECT_GT(figure(second, "near_edges") + figure(second, "loops_closed"), 5.0) << "nothing ties the two together";
  }
}

/// The robot begins somewhere else, looking another way, with its wheels at zero.
TEST(ContinuedMapper, GoesOnFromAnUnknownStart) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const Recorded first = recorded(floor, kRound, 0.0, seed);
    const Recorded second = recorded(floor, kElsewhere, 2.0, seed + 50);
    ContinuedMapper mapper(RobotModel(), {}, base(map_of(first.ticks), true));
    play(mapper, second.ticks);
    EXPECT_EQ(figure(mapper, "place_known"), 1.0);
    ASSERT_EQ(mapper.trajectory().size(), second.ticks.size()) << "known afterwards from the first scan on";
    const Errors e = errors(mapper.trajectory(), second.drive.truth, first.drive.truth.front().pose);
    EXPECT_LT(e.worst, 0.08);
    EXPECT_LT(e.worst_heading, deg_to_rad(3.0));
    const Errors live = errors(mapper.live_trajectory(), second.drive.truth, first.drive.truth.front().pose);
    EXPECT_FALSE(mapper.live_trajectory().empty());
    EXPECT_LT(live.worst, 0.10);
    const SavedMap both = decode_map(mapper.saved_map(), "both");
    EXPECT_GT(both.frames.size(), decode_map(map_of(first.ticks), "first").frames.size());
  }
}

TEST(ContinuedMapper, LocalisesFromAnUnknownStartAndLeavesTheMapAsItIs) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const Recorded first = recorded(floor, kRound, 0.0, seed);
    const Recorded second = recorded(floor, kElsewhere, -1.0, seed + 50);
    const std::string bytes = map_of(first.ticks);
    ContinuedMapper mapper(RobotModel(), {}, base(bytes, false));
    play(mapper, second.ticks);
    EXPECT_EQ(figure(mapper, "place_known"), 1.0);
    EXPECT_EQ(figure(mapper, "carried_off"), 0.0);
    const Errors live = errors(mapper.live_trajectory(), second.drive.truth, first.drive.truth.front().pose);
    EXPECT_GT(mapper.live_trajectory().size(), second.ticks.size() / 3);
    EXPECT_LT(live.rmse, 0.04);
    EXPECT_LT(live.worst, 0.10);
    EXPECT_TRUE(mapper.saved_map() == bytes) << "the map has changed";
    EXPECT_EQ(figure(mapper, "key_frames"), decode_map(bytes, "map").frames.size());
  }
}

TEST(ContinuedMapper, AStartThatIsGivenIsTakenAtOnce) {
  const slam_test::Floor floor(1, 3, 2);
  const Recorded first = recorded(floor, kRound, 0.0, 1);
  const Recorded second = recorded(floor, kElsewhere, -1.0, 51);
  const TPose2D off{0.15, -0.1, 0.1};  // as well as people know it
  const TPose2D start = (second.drive.truth.front().pose - first.drive.truth.front().pose) + off;
  ContinuedMapper mapper(RobotModel(), {}, base(map_of(first.ticks), false, start));
  mapper.update(second.ticks.front());
  mapper.update(second.ticks[1]);
  EXPECT_EQ(figure(mapper, "place_known"), 1.0);
  EXPECT_LT(errors(mapper.trajectory(), second.drive.truth, first.drive.truth.front().pose).worst, 0.06);
}

/// As the drive's own map: unsettled where a correction is drawn bit by bit. Until the place is known the map shown is
/// that of the run before, which nobody draws anew.
TEST(ContinuedMapper, SettlesAfterACorrectionOnceThePlaceIsKnown) {
  RobustConfig slowly;
  slowly.budget_ms = 1.0;
  int unsettled = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const Recorded first = recorded(floor, kRound, 0.0, seed);
    const Recorded second = recorded(floor, kElsewhere, 2.0, seed + 50);
    ContinuedMapper mapper(RobotModel(), slowly, base(map_of(first.ticks), true));
    for (const Inputs& tick : second.ticks) {
      const std::uint64_t revision = mapper.revision();
      const bool settled = mapper.settled();
      mapper.update(tick);
      if (figure(mapper, "place_known") == 0.0 || (settled && mapper.revision() == revision)) {
        EXPECT_TRUE(mapper.settled());
      }
      if (!mapper.settled()) ++unsettled;
    }
    mapper.finish();
    EXPECT_TRUE(mapper.settled());
  }
  EXPECT_GT(unsettled, 0);
}

/// All floors have rooms of one size in one frame: only doors and furniture tell them apart.
TEST(ContinuedMapper, AForeignBuildingIsNotTakenForTheMap) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::string bytes = map_of(recorded(slam_test::Floor(seed, 3, 2), kRound, 0.0, seed).ticks);
    const Recorded foreign = recorded(slam_test::Floor(seed + 20, 3, 2), kElsewhere, 0.5, seed);
    for (const bool grows : {true, false}) {
      ContinuedMapper mapper(RobotModel(), {}, base(bytes, grows));
      play(mapper, foreign.ticks);
      EXPECT_EQ(figure(mapper, "place_known"), 0.0);
      EXPECT_TRUE(mapper.trajectory().empty());
      EXPECT_GT(mapper.covariance()(0, 0), 1.0) << "it says that it does not know";
      EXPECT_TRUE(mapper.saved_map() == bytes) << "the map has changed";
    }
  }
}

/// Measurements of a drive that are wrong here and there, each kind alone.
std::vector<std::pair<std::string, Ticks>> spoiled(const Ticks& good) {
  static constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::pair<std::string, Ticks>> all;
  const auto with = [&](const std::string& name, const std::function<void(Inputs&, std::size_t)>& change) {
    all.emplace_back(name, good);
    for (std::size_t i = 0; i < good.size(); ++i) change(all.back().second[i], i);
  };
  const auto scans = [&](const std::string& name, const std::function<void(robot::LaserScan&, std::size_t)>& change) {
    with(name, [&](Inputs& tick, std::size_t i) {
      for (robot::LaserScan& scan : tick.scans) change(scan, i);
    });
  };
  scans("blind at first", [](auto& scan, std::size_t i) {
    if (i < 8) scan.ranges.assign(scan.ranges.size(), kNothing);
  });
  scans("blind now and then", [](auto& scan, std::size_t i) {
    if (i % 5 == 2) scan.ranges.assign(scan.ranges.size(), kNothing);
  });
  scans("one beam now and then", [](auto& scan, std::size_t i) {
    if (i % 3 == 1) scan.ranges.resize(1);
  });
  scans("no angle now and then", [](auto& scan, std::size_t i) {
    if (i % 4 == 1) scan.angle_step = std::numeric_limits<double>::quiet_NaN();
  });
  with("time runs backwards", [](Inputs& tick, std::size_t i) {
    if (i < 40 || i % 7 != 0) return;
    tick.scans.front().stamp = tick.scans.front().stamp - 1.5;
    tick.odometry.front().stamp = tick.odometry.front().stamp - 1.5;
  });
  with("a stamp far ahead", [](Inputs& tick, std::size_t i) {
    if (i == 50) tick.scans.front().stamp = tick.scans.front().stamp + 3600.0;
  });
  with("a gap of three seconds", [](Inputs& tick, std::size_t i) {
    if (i < 60 || i >= 90) return;
    tick.scans.clear();
    tick.odometry.clear();
  });
  with("doubled scans", [](Inputs& tick, std::size_t) { tick.scans.push_back(tick.scans.front()); });
  with("odometry that jumps", [](Inputs& tick, std::size_t i) {
    if (i % 25 == 20) tick.odometry.front().pose = tick.odometry.front().pose + TPose2D(4.0, -3.0, 1.0);
  });
  with("odometry that starts anew", [&](Inputs& tick, std::size_t i) {
    const TPose2D then = good[80].odometry.front().pose;
    if (i >= 80) tick.odometry.front().pose = tick.odometry.front().pose - then;
  });
  with("no odometry", [](Inputs& tick, std::size_t) { tick.odometry.clear(); });
  return all;
}

/// A base map is neither spoiled nor lost by what is wrong in the drive that goes on in it.
TEST(ContinuedMapper, BadInputSpoilsNeitherTheMapNorThePlace) {
  const slam_test::Floor floor(2, 3, 2);
  const Recorded first = recorded(floor, kRound, 0.0, 2);
  const Recorded second = recorded(floor, kElsewhere, -1.0, 52);
  const TPose2D& T_world_map = first.drive.truth.front().pose;
  const std::string bytes = map_of(first.ticks);
  for (const auto& [name, ticks] : spoiled(second.ticks))
    for (const bool grows : {true, false}) {
      SCOPED_TRACE(name + (grows ? ", gone on with" : ", localised"));
      ContinuedMapper mapper(RobotModel(), {}, base(bytes, grows));
      play(mapper, ticks);
      EXPECT_EQ(figure(mapper, "place_known"), 1.0);
      const Errors all = errors(mapper.trajectory(), second.drive.truth, T_world_map);
      EXPECT_GT(mapper.trajectory().size(), second.ticks.size() / 2);
      EXPECT_LT(all.rmse, 0.05);
      EXPECT_LT(all.worst_heading, deg_to_rad(5.0));
      if (grows) {
        EXPECT_GE(decode_map(mapper.saved_map(), "both").frames.size(), decode_map(bytes, "first").frames.size());
        EXPECT_LT(walls_off(mapper.map().classify(), floor.world(), T_world_map), 0.02);
      } else {
        EXPECT_TRUE(mapper.saved_map() == bytes) << "the map has changed";
      }
    }
}

TEST(ContinuedMapper, ARobotThatIsCarriedOffFindsItsPlaceAgain) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const Recorded first = recorded(floor, kRound, 0.0, seed);
    const Recorded before = recorded(floor, {{0, 0}, {1, 0}, {2, 0}}, 0.0, seed + 50);
    const Recorded after = recorded(floor, {{0, 1}, {1, 1}, {2, 1}, {2, 0}}, 1.0, seed + 60);
    ContinuedMapper mapper(RobotModel(), {}, base(map_of(first.ticks), false));
    const Ticks ticks = slam_test::spliced(before.ticks, after.ticks);
    play(mapper, ticks);
    EXPECT_EQ(figure(mapper, "carried_off"), 1.0);
    EXPECT_EQ(figure(mapper, "place_known"), 1.0);
    const TPose2D expected = after.drive.truth.back().pose - first.drive.truth.front().pose;
    const TPose2D& end = mapper.trajectory().back().pose;
    EXPECT_LT(length(end.x - expected.x, end.y - expected.y), 0.08);
    EXPECT_LT(std::abs(wrap_angle(end.phi - expected.phi)), deg_to_rad(3.0));
    for (std::size_t i = 1; i < mapper.trajectory().size(); ++i)
      ASSERT_LT(mapper.trajectory()[i - 1].stamp, mapper.trajectory()[i].stamp);
  }
}

/// A scanner that scans so often, on a robot that localises itself on a map of an earlier drive.
struct Follower {
  slam_test::Floor floor;
  RobotModel model;
  double period;  ///< [s]
  Recorded first;

  Follower(std::uint64_t seed, double period)
      : floor(seed, 3, 2), period(period), first(recorded(floor, kRound, 0.0, seed)) {
    model.laser.scan_period = period;
  }
  Recorded drive(const std::vector<Cell>& rooms, double heading, std::uint64_t seed) const {
    Recorded out{slam_test::finer(slam_test::drive_through(floor.way(rooms), heading), period), {}};
    out.ticks = slam_test::record(floor.world(), out.drive, model, 0.5, 0.01, seed);
    return out;
  }
  ContinuedMapper mapper(const Recorded& drive) const {
    const TPose2D start = drive.drive.truth.front().pose - first.drive.truth.front().pose;
    return {model, {}, base(map_of(first.ticks), false, start)};
  }
};

/// Changes the scans from `from` on, for `seconds`.
Ticks spoiled_for(Ticks ticks, double from, double seconds, float range) {
  for (Inputs& tick : ticks) {
    const double t = tick.now - ticks.front().now;
    if (t < from || t >= from + seconds) continue;
    for (robot::LaserScan& scan : tick.scans) scan.ranges.assign(scan.ranges.size(), range);
  }
  return ticks;
}

/// Scans that see nothing do not say that the robot is elsewhere, and what hides the view for a moment does not either,
/// however often the scanner scans.
TEST(ContinuedMapper, ABlindSpellIsNoReasonToThinkThatTheRobotWasCarriedOff) {
  struct Spell {
    double seconds;
    float range;  ///< of all beams [m]
  };
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const double period : {0.1, 0.025}) {
      const Follower robot(seed, period);
      const Recorded drive = robot.drive(kElsewhere, -1.0, seed + 50);
      for (const Spell& spell :
           {Spell{5.0, kNothing}, Spell{5.0, std::numeric_limits<float>::infinity()}, Spell{0.35, 0.3F}}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", period " + std::to_string(period) + " s, range " +
                     std::to_string(spell.range));
        ContinuedMapper mapper = robot.mapper(drive);
        play(mapper, spoiled_for(drive.ticks, 15.0, spell.seconds, spell.range));
        EXPECT_EQ(figure(mapper, "carried_off"), 0.0);
        EXPECT_EQ(figure(mapper, "place_known"), 1.0);
        const TPose2D expected = drive.drive.truth.back().pose - robot.first.drive.truth.front().pose;
        EXPECT_LT(length(mapper.pose().x - expected.x, mapper.pose().y - expected.y), 0.08);
      }
    }
}

TEST(ContinuedMapper, ARobotThatIsCarriedOffIsMissedSoonHoweverOftenItScans) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const double period : {0.1, 0.025}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", period " + std::to_string(period) + " s");
      const Follower robot(seed, period);
      const Recorded before = robot.drive({{0, 0}, {1, 0}, {2, 0}}, 0.0, seed + 50);
      const Recorded after = robot.drive({{0, 1}, {1, 1}, {2, 1}, {2, 0}}, 1.0, seed + 60);
      ContinuedMapper mapper = robot.mapper(before);
      play(mapper, before.ticks);
      const Ticks all = slam_test::spliced(before.ticks, after.ticks);
      ContinuedMapper again = robot.mapper(before);
      play(again, all);
      EXPECT_EQ(figure(mapper, "carried_off"), 0.0);
      EXPECT_EQ(figure(again, "carried_off"), 1.0);
      EXPECT_EQ(figure(again, "place_known"), 1.0);
      const TPose2D expected = after.drive.truth.back().pose - robot.first.drive.truth.front().pose;
      EXPECT_LT(length(again.pose().x - expected.x, again.pose().y - expected.y), 0.08);
    }
}

/// Who had no time to look for its place under way looks for it when the drive is over.
TEST(ContinuedMapper, APlaceIsFoundWhenTheDriveIsOver) {
  for (const bool grows : {true, false}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + (grows ? ", grows" : ""));
      const slam_test::Floor floor(seed, 3, 2);
      const Recorded first = recorded(floor, kRound, 0.0, seed);
      const Recorded second = recorded(floor, kElsewhere, 2.0, seed + 50);
      RobustConfig hurried;
      hurried.budget_ms = 1e-3;
      ContinuedMapper mapper(RobotModel(), hurried, base(map_of(first.ticks), grows));
      for (const Inputs& tick : second.ticks) mapper.update(tick);
      EXPECT_EQ(figure(mapper, "place_known"), 0.0);
      EXPECT_TRUE(mapper.trajectory().empty());
      mapper.finish();
      EXPECT_EQ(figure(mapper, "place_known"), 1.0);
      ASSERT_EQ(mapper.trajectory().size(), second.ticks.size());
      EXPECT_LT(errors(mapper.trajectory(), second.drive.truth, first.drive.truth.front().pose).worst, 0.08);
    }
  }
}

/// Two robots that saw different parts of a floor, and some of it both.
TEST(MergedMaps, LieInOneFrame) {
  const RobustConfig config = suited_to(RobotModel().laser, {});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const Recorded first = recorded(floor, {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}}, 0.0, seed);
    const Recorded second = recorded(floor, {{1, 1}, {0, 1}, {0, 0}, {1, 0}, {2, 0}, {2, 1}}, 1.0, seed + 50);
    const SavedMap a = decode_map(map_of(first.ticks), "first");
    const SavedMap b = decode_map(map_of(second.ticks), "second");
    const std::optional<SavedMap> both = merged(a, b, config).map;
    ASSERT_TRUE(both);
    ASSERT_EQ(both->frames.size(), a.frames.size() + b.frames.size());
    EXPECT_EQ(both->scans.size(), a.scans.size() + b.scans.size());
    for (int i = 0; i < both->frames.size(); ++i) {
      const Recorded& drive = i < a.frames.size() ? first : second;
      const TPose2D expected = *pose_at(drive.drive.truth, both->frames[i].stamp) - first.drive.truth.front().pose;
      EXPECT_LT(length(both->frames.pose(i).x - expected.x, both->frames.pose(i).y - expected.y), 0.08) << i;
    }
    EXPECT_TRUE(both->frames.graph().walls_direction);
    RobustConfig no_compass = config;
    no_compass.wall_compass = false;
    EXPECT_FALSE(merged(a, b, no_compass).map->frames.graph().walls_direction);
    EXPECT_TRUE(encode_map(decode_map(encode_map(*both), "both")) == encode_map(*both));
    const SavedMap other =
        decode_map(map_of(recorded(slam_test::Floor(seed + 20, 3, 2), kRound, 0.0, 1).ticks), "other");
    std::vector<double> shares;
    const MergedMap none = merged(a, other, config, [&](const std::string&, double share) { shares.push_back(share); });
    EXPECT_EQ(none.end, MergeEnd::NoPlace);
    EXPECT_FALSE(none.map);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    const double way = other.frames[other.frames.last()].path;
    EXPECT_GE(shares.size(), static_cast<std::size_t>(0.3 * way)) << "told at each look";
    EXPECT_LE(shares.size(), static_cast<std::size_t>(std::max(way, 33.0))) << "looks along " << way << " m";
    SavedMap measured_anew = b;
    measured_anew.T_base_laser.x += 2e-3;
    EXPECT_EQ(merged(a, measured_anew, config).end, MergeEnd::Whole);
    SavedMap tilted = b;
    tilted.T_base_laser.pitch += 0.1;
    EXPECT_EQ(merged(a, tilted, config).end, MergeEnd::OtherMount);
  }
}

/// A floor whose lower rooms are those of `floor`, and above them a hall with screens.
slam_test::World with_another_hall(const slam_test::Floor& floor) {
  constexpr double kHall = 1.6;  // above the lower rooms [m]
  slam_test::World world;
  for (const auto& wall : floor.world()) {
    const bool inner = wall.a.y > kHall && wall.b.y > kHall && std::max(wall.a.y, wall.b.y) < 4.4;
    const bool between = wall.a.x == wall.b.x && std::min(wall.a.y, wall.b.y) > 1.4 && wall.a.x > 0.0 && wall.a.x < 6.0;
    if (!inner && !between) world.push_back(wall);
  }
  for (const double x : {0.0, 3.0, 6.0})
    for (const double y : {2.2, 3.8}) world.push_back({{x - 0.7, y}, {x + 0.7, y}});
  return world;
}

/// What two floors have alike joins their maps, unless the walls of one stand where the other looked through.
TEST(MergedMaps, OfTwoFloorsAreRefused) {
  const RobustConfig config = suited_to(RobotModel().laser, {});
  const std::vector<Cell> below{{0, 0}, {1, 0}, {2, 0}, {1, 0}, {0, 0}};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const slam_test::Floor floor(seed, 3, 2);
    const SavedMap first = decode_map(map_of(recorded(floor, kRound, 0.0, seed).ticks), "first");
    const auto drive_in = [&](const slam_test::World& world, const std::vector<Cell>& rooms) {
      const slam_test::Drive drive = slam_test::drive_through(floor.way(rooms), 0.0);
      return decode_map(map_of(slam_test::record(world, drive, RobotModel(), 1.0, 0.01, seed + 50)), "second");
    };
    EXPECT_TRUE(merged(first, drive_in(with_another_hall(floor), below), config).map);
    EXPECT_TRUE(merged(first, drive_in(floor.world(), kRound), config).map);
    const MergedMap refused = merged(first, drive_in(with_another_hall(floor), kRound), config);
    EXPECT_FALSE(refused.map);
    EXPECT_EQ(refused.end, MergeEnd::SeenThrough);

    // So is a drive that looks for its place only when it is over.
    RobustConfig hurried;
    hurried.budget_ms = 1e-3;
    ContinuedMapper late(RobotModel(), hurried, base(encode_map(first), true));
    const slam_test::Drive drive = slam_test::drive_through(floor.way(kRound), 0.0);
    play(late, slam_test::record(with_another_hall(floor), drive, RobotModel(), 1.0, 0.01, seed + 50));
    EXPECT_GE(figure(late, "places_believed"), 3.0);
    EXPECT_EQ(figure(late, "place_known"), 0.0);
    EXPECT_TRUE(late.saved_map() == encode_map(first));
  }
}

TEST(ContinuedMapper, SameInputsSameBits) {
  const slam_test::Floor floor(2, 3, 2);
  const std::string bytes = map_of(recorded(floor, kRound, 0.0, 2).ticks);
  const Recorded second = recorded(floor, kElsewhere, 2.0, 52);
  ContinuedMapper a(RobotModel(), {}, base(bytes, true));
  ContinuedMapper b(RobotModel(), {}, base(bytes, true));
  play(a, second.ticks);
  play(b, second.ticks);
  EXPECT_TRUE(a.saved_map() == b.saved_map());
  ASSERT_EQ(a.trajectory().size(), b.trajectory().size());
  for (std::size_t i = 0; i < a.trajectory().size(); ++i) EXPECT_EQ(a.trajectory()[i].pose, b.trajectory()[i].pose);
}

}  // namespace
}  // namespace rubble::slam
