#include "robot/drivers/watch/base_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/angle.h"

namespace rubble::robot {
namespace {

using testing::HasSubstr;

constexpr double kTurn = 0.02;  ///< of the base's thread [s]

/// A base that obeys within its ramp and reports ten times a second, unless it is told otherwise.
class WatchedBase {
 public:
  explicit WatchedBase(BaseSettings given = {}, bool mount = true) : settings(given), watch(given, {}, mount) {
    turn.ready = turn.motors_on = true;
  }

  /// Whether it was to be stopped hard meanwhile.
  bool run(const Drive& told, double seconds) {
    bool stopped = false;
    for (const Stamp end = now + seconds; now < end;) {
      now = now + kTurn;
      turn.wanted = told;
      const Drive goal = wheels ? wheels(told) : turn.motors_on ? told : Drive{};
      motion.v += std::clamp(goal.v - motion.v, -settings.max_accel * kTurn, settings.max_accel * kTurn);
      motion.w += std::clamp(goal.w - motion.w, -settings.max_turn_accel * kTurn, settings.max_turn_accel * kTurn);
      pose.phi += motion.w * kTurn;
      pose.x += std::cos(pose.phi) * motion.v * kTurn;
      pose.y += std::sin(pose.phi) * motion.v * kTurn;
      std::vector<Odometry> reports;
      if (++turns % 5 == 0)
        reports.push_back(counts ? Odometry{now, pose, motion.v, motion.w, false} : Odometry{now, {}, 0.0, 0.0, false});
      if (turns % 5 == 2) watch.see(seen_from(scans_stand ? 0.0 : upside_down ? -pose.phi : pose.phi, now), now);
      stopped = watch.look(turn, reports, now) || stopped;
    }
    return stopped;
  }

  /// By a scanner above the turn centre, in a room without symmetry.
  static LaserScan seen_from(double phi, Stamp now) {
    LaserScan scan;
    scan.stamp = now;
    scan.angle_min = -2.0;
    scan.angle_step = 0.02;
    scan.range_max = 4.0;
    for (int i = 0; i <= 200; ++i) {
      const double b = phi + scan.angle_min + i * scan.angle_step;
      scan.ranges.push_back(static_cast<float>(2.0 + 0.8 * std::sin(b) + 0.5 * std::sin(3.0 * b + 1.0)));
    }
    return scan;
  }

  std::string troubles() const {
    std::string all;
    for (const Hindrance& one : watch.troubles()) all += one.what + "\n";
    return all;
  }

  BaseSettings settings;
  BaseWatch watch;
  BaseTurn turn{{}, true};
  std::function<Drive(const Drive&)> wheels;
  Stamp now = Stamp::from_seconds(50.0);
  Drive motion;
  mrpt::math::TPose2D pose;
  int turns = 0;
  bool counts = true;        ///< its encoders do
  bool upside_down = false;  ///< its scanner hangs so
  bool scans_stand = false;  ///< its scanner is another robot's, which stands
};

TEST(BaseWatch, ABaseThatObeysIsInNoTrouble) {
  WatchedBase base;
  for (const Drive& told : {Drive{0.4, 0.0}, Drive{0.0, 1.0}, Drive{}, Drive{-0.2, -0.5}}) {
    EXPECT_FALSE(base.run(told, 5.0));
    EXPECT_EQ(base.troubles(), "");
    EXPECT_EQ(base.watch.moves(), told.v != 0.0 || told.w != 0.0);
  }
  EXPECT_EQ(base.watch.held(), "");
}

TEST(BaseWatch, AnotherRobotsBaseBehindTheSamePortIsHeld) {
  WatchedBase base;
  base.turn.identity = "'Ada', p3at-sh, serial number '17', firmware '2.6'";
  EXPECT_FALSE(base.run({0.2, 0.0}, 3.0));
  base.turn.ready = false;
  base.turn.identity.clear();
  EXPECT_FALSE(base.run({}, 2.0));
  base.turn.ready = true;
  EXPECT_FALSE(base.run({0.2, 0.0}, 0.5)) << "it has not said who it is";
  base.turn.identity = "'Ada', p3at-sh, serial number '17', firmware '2.6'";
  EXPECT_FALSE(base.run({0.2, 0.0}, 2.0)) << "it was away, and is back";
  base.turn.identity = "'Bob', p3at-sh, serial number '18', firmware '2.6'";
  EXPECT_TRUE(base.run({0.2, 0.0}, 0.5));
  EXPECT_THAT(base.watch.held(), testing::AllOf(HasSubstr("another robot's base answers"), HasSubstr("'18'")));
  EXPECT_TRUE(base.watch.blind());
  EXPECT_NE(base.watch.mend(), "");
  EXPECT_FALSE(base.watch.rearm()) << "nobody here sees where it drives";
  EXPECT_THAT(base.watch.refusal(), HasSubstr("'Bob'"));
  EXPECT_THAT(base.watch.held(), HasSubstr("'18'"));
  base.turn.ready = false;
  base.run({}, 1.0);
  base.turn.ready = true;
  base.turn.identity = "'Ada', p3at-sh, serial number '17', firmware '2.6'";
  base.run({}, 1.0);
  EXPECT_TRUE(base.watch.rearm()) << base.watch.refusal();
  EXPECT_FALSE(base.run({0.2, 0.0}, 3.0));
  EXPECT_EQ(base.troubles(), "") << "it has never disobeyed";
}

/// A driver without who() tells nothing of whom it talks to: then wheels that go while scans stand do, behind a break.
TEST(BaseWatch, AnotherBaseThatDoesNotSayWhoItIsIsHeldByItsWheelsBehindABreak) {
  for (const bool breaks : {false, true}) {
    WatchedBase base;
    EXPECT_FALSE(base.run({0.0, 0.8}, 6.0));
    base.turn.ready = !breaks;
    EXPECT_FALSE(base.run({}, 3.0));
    base.turn.ready = true;
    base.scans_stand = true;
    EXPECT_EQ(base.run({0.0, 0.8}, 10.0), breaks);
    EXPECT_EQ(base.watch.held() != "", breaks) << base.watch.held();
    if (!breaks) continue;
    base.run({}, 2.0);
    EXPECT_FALSE(base.watch.rearm()) << "it is driven again, and nobody here sees where";
    EXPECT_NE(base.watch.held(), "");
    base.turn.ready = false;  // its plug is pulled and put back
    base.run({}, 40.0);
    base.turn.ready = true;
    base.run({}, 40.0);
    EXPECT_TRUE(base.watch.rearm());
    EXPECT_TRUE(base.run({0.0, 0.8}, 10.0)) << "the wrong one again, however long it was held";
    base.run({}, 2.0);
    EXPECT_EQ(base.troubles(), "") << "no word of obeying";
    base.turn.ready = false;
    base.run({}, 1.0);
    base.turn.ready = true;
    base.scans_stand = false;
    base.run({}, 1.0);
    EXPECT_TRUE(base.watch.rearm());
    EXPECT_FALSE(base.run({0.0, 0.8}, 10.0)) << "the right one";
    EXPECT_EQ(base.watch.held(), "");
  }
}

TEST(BaseWatch, WhoIsHeldAndMovesAllTheSameIsNamed) {
  WatchedBase base;
  base.run({0.2, 0.0}, 2.0);
  base.turn.held = true;  // its button
  base.turn.asked = false;
  base.wheels = [](const Drive&) { return Drive{}; };
  base.run({}, 3.0);
  EXPECT_FALSE(base.watch.moves_though_held());
  base.wheels = [](const Drive&) { return Drive{0.1, 0.0}; };
  base.run({}, 1.0);
  EXPECT_FALSE(base.watch.moves_though_held()) << "a push";
  base.run({}, 2.0);
  EXPECT_TRUE(base.watch.moves_though_held());
  base.wheels = [](const Drive&) { return Drive{}; };
  base.run({}, 2.0);
  EXPECT_FALSE(base.watch.moves_though_held());
}

/// It turns on the spot, and its scanner is turned over.
TEST(BaseWatch, AScannerThatHangsUpsideDownHoldsTheRobotUnlessItsFileAsksForNoCheck) {
  for (const bool check : {true, false}) {
    for (const bool passive : {false, true}) {
      BaseSettings settings;
      settings.passive = passive;
      WatchedBase base(settings, check);
      base.upside_down = true;
      EXPECT_EQ(base.run({0.0, 0.5}, 8.0), check && !passive);
      EXPECT_EQ(base.watch.held_name(), check && !passive ? "urg" : "");
      EXPECT_EQ(base.watch.blind(), check && !passive);
      EXPECT_EQ(base.troubles().find("upside down") != std::string::npos, check && passive) << "who only maps is told";
    }
  }
}

TEST(BaseWatch, MotorsThatDoNotComeOnAreNamedAfterAWhile) {
  WatchedBase base;
  base.turn.motors_on = false;
  base.run({}, BaseWatch::kMotorsOn - 0.2);
  EXPECT_EQ(base.troubles(), "");
  base.run({}, 0.4);
  EXPECT_THAT(base.troubles(), HasSubstr("do not come on"));
  base.turn.motors_on = true;
  base.run({}, kTurn);
  EXPECT_EQ(base.troubles(), "");
  for (bool* excuse : {&base.turn.held, &base.turn.motors_on}) {  // at its button, or on after all
    base.turn.motors_on = false;
    *excuse = true;
    base.run({}, 2.0 * BaseWatch::kMotorsOn);
    EXPECT_EQ(base.troubles(), "");
    *excuse = false;
  }
}

TEST(BaseWatch, MotorsThatStayOnAreNamedAndASilenceForgetsNothing) {
  WatchedBase base;
  base.turn.asked = false;
  base.turn.off = true;
  base.run({}, BaseWatch::kMotorsOff - 0.1);
  EXPECT_FALSE(base.watch.motors_stay());
  base.run({}, 0.2);
  EXPECT_TRUE(base.watch.motors_stay());
  EXPECT_THAT(base.troubles(), HasSubstr("stay on though switched off"));
  base.turn.ready = base.turn.motors_on = false;
  base.run({}, 1.0);
  EXPECT_TRUE(base.watch.motors_stay()) << "what it does in silence nobody knows";
  base.turn.ready = true;
  base.run({}, kTurn);
  EXPECT_FALSE(base.watch.motors_stay());
}

TEST(BaseWatch, WhoRunsAwayIsHeldUntilLetGoAndDoubtedUntilItObeys) {
  WatchedBase base;
  base.run({0.3, 0.0}, 3.0);
  base.wheels = [](const Drive&) { return Drive{0.3, 0.0}; };
  EXPECT_TRUE(base.run({}, 4.0));
  EXPECT_THAT(base.watch.held(), HasSubstr("does not obey"));
  EXPECT_FALSE(base.run({}, 1.0)) << "it is stopped once";
  base.turn.asked = base.turn.motors_on = false;
  base.wheels = nullptr;
  base.run({}, 2.0);
  EXPECT_THAT(base.watch.held(), HasSubstr("does not obey")) << "only the operator lets it go";
  EXPECT_FALSE(base.watch.moves());
  base.watch.rearm();
  EXPECT_EQ(base.watch.held(), "");
  base.turn.asked = base.turn.motors_on = true;
  base.run({}, BaseWatch::kObeys - 0.2);
  EXPECT_THAT(base.troubles(), HasSubstr("is watched"));
  base.run({}, 0.4);
  EXPECT_EQ(base.troubles(), "");
}

/// Between the limit and what is told to it else nobody looks: a base that is 25 % too fast obeys but for that.
TEST(BaseWatch, WhoIsFasterThanItsLimitIsHeldSoonAndWhoKeepsItNever) {
  for (const double sign : {1.0, -1.0}) {
    for (const bool turns : {false, true}) {
      for (const double too_fast : {1.05, 1.25}) {
        SCOPED_TRACE(testing::Message() << sign * too_fast << (turns ? " turning" : " driving"));
        BaseSettings settings;
        settings.max_v = 0.4;
        settings.max_w = deg_to_rad(60.0);
        WatchedBase base(settings);
        base.wheels = [=](const Drive& told) { return Drive{too_fast * told.v, too_fast * told.w}; };
        const Drive most = turns ? Drive{0.0, sign * settings.max_w} : Drive{sign * settings.max_v, 0.0};
        const bool stopped = base.run(most, turns ? 2.6 : 3.6);  // with its ramp
        EXPECT_EQ(stopped, too_fast > 1.2);
        if (stopped) {
          EXPECT_THAT(base.watch.held(), HasSubstr("faster than its limit"));
          base.watch.rearm();
          EXPECT_EQ(base.watch.held(), "");
        } else {
          EXPECT_FALSE(base.run(most, 20.0));
          EXPECT_EQ(base.troubles(), "");
        }
      }
    }
  }
}

TEST(BaseWatch, AMomentAboveTheLimitIsNone) {
  BaseSettings settings;
  settings.max_v = 0.4;
  settings.max_accel = 2.0;
  WatchedBase base(settings);
  base.run({0.4, 0.0}, 2.0);
  for (int i = 0; i < 20; ++i) {
    base.wheels = [](const Drive&) { return Drive{0.5, 0.0}; };
    EXPECT_FALSE(base.run({0.4, 0.0}, 0.4)) << "a slope";
    base.wheels = nullptr;
    EXPECT_FALSE(base.run({0.4, 0.0}, 1.0));
  }
}

TEST(BaseWatch, WhoseEncodersAreDeadIsHeldAsBlind) {
  WatchedBase base;
  EXPECT_FALSE(base.run({0.0, 0.5}, 3.0));
  EXPECT_FALSE(base.watch.blind());
  base.counts = false;
  EXPECT_TRUE(base.run({0.0, 0.5}, 3.0));
  EXPECT_TRUE(base.watch.blind());
  EXPECT_THAT(base.watch.held(), HasSubstr("encoders and scans disagree"));
  base.watch.rearm();
  EXPECT_FALSE(base.watch.blind());
  EXPECT_EQ(base.watch.held(), "");
}

TEST(BaseWatch, JumpsOfItsPositionsAreNamedWhenTheyCome) {
  WatchedBase base;
  base.turn.jumps = 1;  // an origin set anew
  base.run({}, 1.0);
  EXPECT_EQ(base.troubles(), "");
  base.turn.jumps = 3;
  base.run({}, 1.0);
  EXPECT_THAT(base.troubles(), HasSubstr("jump again and again"));
  base.run({}, 5.0);
  EXPECT_EQ(base.troubles(), "") << "no more";
}

TEST(BaseWatch, WhoOnlyWatchesBlamesNobody) {
  BaseSettings settings;
  settings.passive = true;
  WatchedBase base(settings);
  base.turn.off = true;
  base.wheels = [](const Drive&) { return Drive{0.3, 0.5}; };
  EXPECT_FALSE(base.run({}, 10.0));
  EXPECT_EQ(base.troubles(), "");
  EXPECT_FALSE(base.watch.motors_stay());
  EXPECT_TRUE(base.watch.moves());
}

}  // namespace
}  // namespace rubble::robot
