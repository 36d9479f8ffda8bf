// A base that does not hear us, or late: whether it stops in its own time, or is driven by somebody else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "robot/drivers/watch/base_watch.h"

namespace rubble::robot {
namespace {

constexpr double kFound = 1.3;      ///< so long after the first order that is late the line is found out [s]
constexpr double kDeafTurn = 0.02;  ///< of the base's thread [s]

/// A base at the end of a line that is well up to `deaf_at`. Orders then take `up`, reports `down` [s], or orders never
/// arrive; it has a watchdog and its ramps.
class BaseAtTheEndOfALine {
 public:
  explicit BaseAtTheEndOfALine(const BaseSettings& given = {}) : settings(given), watch(given, {}) {
    turn.ready = turn.motors_on = true;
  }

  /// Told `told` up to the moment when its line is found out, and to stand from then on; whether it was held.
  bool run(const Drive& told, double seconds) {
    for (const Stamp end = now + seconds; now < end;) {
      now = now + kDeafTurn;
      const double since = now - deaf_at;
      turn.deaf = since > kFound;
      turn.asked = !turn.deaf;
      // No answer has come yet, or it is known how long one takes.
      turn.late = since < up + down || !hears ? 1.0 : up + down;
      turn.wanted = turn.deaf ? Drive{} : told;
      if (hears || since <= 0.0) orders.emplace_back(now + (since > 0.0 ? up : 0.0), turn.wanted);
      for (; !orders.empty() && orders.front().first <= now; orders.pop_front()) {
        heard = orders.front().second;
        heard_at = now;
      }
      Drive goal = now - heard_at > turn.watchdog ? Drive{} : heard;
      if (somebody && since > 0.0) goal = somebody(since);
      motion.v += std::clamp(goal.v - motion.v, -settings.max_accel * kDeafTurn, settings.max_accel * kDeafTurn);
      motion.w +=
          std::clamp(goal.w - motion.w, -settings.max_turn_accel * kDeafTurn, settings.max_turn_accel * kDeafTurn);
      pose.phi += motion.w * kDeafTurn;
      pose.x += std::cos(pose.phi) * motion.v * kDeafTurn;
      pose.y += std::sin(pose.phi) * motion.v * kDeafTurn;
      if (++turns % 5 == 0)
        reports.emplace_back(now + (since > 0.0 ? down : 0.0), Odometry{now, pose, motion.v, motion.w, false});
      std::vector<Odometry> come;
      for (; !reports.empty() && reports.front().first <= now; reports.pop_front())
        come.push_back(reports.front().second);
      if (watch.look(turn, come, now)) held_after = since;
    }
    return !watch.held().empty();
  }

  BaseSettings settings;
  BaseWatch watch;
  BaseTurn turn;
  Stamp now = Stamp::from_seconds(50.0), deaf_at = now + 4.0, heard_at = now;
  bool hears = true;
  double up = 0.0, down = 0.0;                    ///< [s]
  std::function<Drive(double seconds)> somebody;  ///< drives it since its line is so
  std::deque<std::pair<Stamp, Drive>> orders;
  std::deque<std::pair<Stamp, Odometry>> reports;
  Drive heard, motion;
  mrpt::math::TPose2D pose;
  int turns = 0;
  double held_after = 0.0;  ///< [s]
};

/// From rest, at full speed, turning; by a line of any delay, or by its watchdog.
TEST(ADeafBase, ThatStopsInItsOwnTimeIsNotHeld) {
  BaseAtTheEndOfALine patient;  // its watchdog waits for long
  patient.turn.watchdog = 6.0;
  patient.hears = false;
  EXPECT_FALSE(patient.run({0.4, 0.0}, 30.0)) << patient.watch.held();
  for (const Drive& told : {Drive{}, Drive{0.7, 0.0}, Drive{-0.4, 0.5}, Drive{0.0, 1.5}}) {
    for (const double up : {-1.0, 0.3, 0.8, 1.6, 2.5, 4.0}) {
      for (const double down : {0.0, 0.3, 0.9}) {
        SCOPED_TRACE(testing::Message() << told.v << " m/s, " << told.w << " rad/s, up " << up << " s, down " << down);
        BaseAtTheEndOfALine base;
        base.hears = up >= 0.0;
        base.up = std::max(0.0, up);
        base.down = down;
        EXPECT_FALSE(base.run(told, 30.0)) << base.watch.held() << ", after " << base.held_after << " s";
      }
    }
  }
}

/// Words and a hold are all that helps: it hears no order.
TEST(ADeafBase, ThatSomebodyElseDrivesIsHeldHoweverHeDrives) {
  const std::pair<const char*, std::function<Drive(double)>> ways[] = {
      {"steadily",
       [](double) {
         return Drive{0.25, 0.0};
       }},
      {"backwards",
       [](double) {
         return Drive{-0.1, 0.0};
       }},
      {"turning",
       [](double) {
         return Drive{0.0, 0.3};
       }},
      {"slowly",
       [](double) {
         return Drive{0.02, 0.0};
       }},
      {"a way now and then",
       [](double t) {
         return Drive{std::fmod(t, 4.0) < 3.0 ? 0.25 : 0.0, 0.0};
       }},
      {"to and fro",
       [](double t) {
         return Drive{std::fmod(t, 8.0) < 4.0 ? 0.25 : -0.25, 0.0};
       }},
      {"after a rest",
       [](double t) {
         return Drive{t > 9.0 ? 0.25 : 0.0, 0.0};
       }},
  };
  for (const auto& [name, way] : ways) {
    SCOPED_TRACE(name);
    BaseAtTheEndOfALine base;
    base.hears = false;
    base.somebody = way;
    EXPECT_TRUE(base.run({0.3, 0.0}, 25.0));
    EXPECT_THAT(base.watch.held(), testing::HasSubstr("does not obey: moves"));
    std::printf("%s: held after %.1f s\n", name, base.held_after);
  }
}

/// The line is well again while he drives on: the hold stays.
TEST(ADeafBase, ThatHearsAgainStaysHeld) {
  BaseAtTheEndOfALine base;
  base.hears = false;
  base.somebody = [](double) { return Drive{0.25, 0.0}; };
  ASSERT_TRUE(base.run({}, 15.0));
  base.deaf_at = base.now + 1e6;
  EXPECT_TRUE(base.run({}, 10.0));
  base.watch.rearm();
  EXPECT_EQ(base.watch.held(), "");
}

/// Shorter than what a base that hears is forgiven.
TEST(ADeafBase, ThatIsGivenAPushIsNotHeld) {
  BaseAtTheEndOfALine base;
  base.hears = false;
  base.settings.max_accel = 3.0;
  base.somebody = [](double t) { return Drive{t > 8.0 && std::fmod(t, 4.0) < 0.6 ? 0.3 : 0.0, 0.0}; };
  EXPECT_FALSE(base.run({}, 40.0)) << base.watch.held();
}

}  // namespace
}  // namespace rubble::robot
