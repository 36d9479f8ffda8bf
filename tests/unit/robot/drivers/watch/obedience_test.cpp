#include "robot/drivers/watch/obedience.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "robot/drivers/rate_dither.h"

namespace rubble::robot {
namespace {

constexpr double kAccel = 0.3, kTurnAccel = deg_to_rad(100.0), kStep = 0.01;

/// A base that keeps its ramps and reports ten times a second; `wheels` may change what they do.
class Base {
 public:
  void run(const Drive& told, double seconds) {
    for (const Stamp end = now + seconds; now < end; now = now + kStep) {
      obedience.tell(told, now);
      lag.push_back(told);
      Drive wanted = lag.front();
      if (lag.size() > 10) lag.erase(lag.begin());
      if (wheels) wanted = wheels(wanted);
      motion.v += std::clamp(wanted.v - motion.v, -kAccel * kStep, kAccel * kStep);
      motion.w += std::clamp(wanted.w - motion.w, -kTurnAccel * kStep, kTurnAccel * kStep);
      const Drive seen = blocked ? Drive{} : motion;
      pose.phi = wrap_angle(pose.phi + seen.w * kStep);
      pose.x += seen.v * std::cos(pose.phi) * kStep;
      pose.y += seen.v * std::sin(pose.phi) * kStep;
      if (++steps % 10 == 0 && !silent) obedience.look({now, pose, seen.v, seen.w, stalled}, now);
      if (first == Stamp::never() && !obedience.trouble().empty()) first = now;
    }
  }

  Obedience obedience{kAccel, kTurnAccel};
  Stamp now = Stamp::from_seconds(50.0);
  std::function<Drive(Drive)> wheels;
  bool blocked = false, stalled = false, silent = false;
  Drive motion;
  std::vector<Drive> lag;  ///< of line and motors
  mrpt::math::TPose2D pose;
  int steps = 0;
  Stamp first = Stamp::never();  ///< trouble
};

TEST(Obedience, WheelsThatStandThoughToldToTurnAreNamedAndPardonedWhenTheyTurn) {
  for (const Drive& told : {Drive{0.4, 0.0}, Drive{-0.1, 0.0}, Drive{0.0, 0.5}}) {
    Base base;
    base.run(told, 5.0);
    ASSERT_EQ(base.obedience.trouble(), "");
    base.blocked = true;
    const Stamp since = base.now;
    base.run(told, 1.5);
    EXPECT_EQ(base.obedience.trouble(), "") << "a moment";
    base.run(told, 2.0);
    EXPECT_THAT(base.obedience.trouble(), testing::HasSubstr("does not obey"));
    EXPECT_LT(base.first - since, Obedience::kStands + 0.8);
    EXPECT_FALSE(base.obedience.runs_away());
    base.blocked = false;
    base.run(told, 0.3);
    EXPECT_EQ(base.obedience.trouble(), "");
  }
}

TEST(Obedience, AStallOrAMomentOrACrawlIsNoDisobedience) {
  Base stalled;
  stalled.blocked = stalled.stalled = true;
  stalled.run({0.3, 0.0}, 10.0);
  EXPECT_EQ(stalled.obedience.trouble(), "") << "the motors push: it tells so itself";
  Base crawl;
  crawl.blocked = true;
  crawl.run({0.03, 0.05}, 4.0);
  EXPECT_EQ(crawl.obedience.trouble(), "");
  Base shaken;
  shaken.blocked = true;
  for (int i = 0; i < 100; ++i) shaken.run({i % 2 == 0 ? 0.3 : -0.3, 0.0}, 0.1);
  EXPECT_EQ(shaken.obedience.trouble(), "") << "no wheel could follow that";
}

TEST(Obedience, WheelsThatTurnThoughToldToStandRunAway) {
  for (const Drive& runs : {Drive{0.4, 0.0}, Drive{-0.15, 0.0}, Drive{0.0, 0.6}}) {
    Base base;
    base.run(runs, 5.0);
    base.wheels = [runs](Drive) { return runs; };
    const Stamp since = base.now;
    base.run({}, 1.0);
    EXPECT_FALSE(base.obedience.runs_away()) << "it may brake";
    base.run({}, 2.5);
    EXPECT_TRUE(base.obedience.runs_away());
    EXPECT_LT(base.first - since, 2.3);
    EXPECT_THAT(base.obedience.trouble(), testing::HasSubstr("motors are being switched off"));
    base.obedience.pause();
    EXPECT_FALSE(base.obedience.runs_away());
  }
  Base rest;
  rest.run({}, 5.0);
  rest.wheels = [](Drive) { return Drive{0.2, 0.0}; };
  const Stamp since = rest.now;
  rest.run({}, 3.0);
  EXPECT_TRUE(rest.obedience.runs_away()) << "from rest";
  EXPECT_LT(rest.first - since, 1.0 + 0.5 + 0.5);
}

/// Its core commands on, as an explorer does that does not know.
TEST(Obedience, WheelsThatGoOnElsewhereThanToldRunAway) {
  for (const auto& [runs, told] :
       {std::pair(Drive{0.4, 0.0}, Drive{0.0, 0.6}), std::pair(Drive{0.0, 0.9}, Drive{0.4, 0.0}),
        std::pair(Drive{0.0, 0.9}, Drive{0.0, -0.9}), std::pair(Drive{0.5, 0.0}, Drive{0.1, 0.0})}) {
    Base base;
    base.run(runs, 5.0);
    base.wheels = [runs = runs](Drive) { return runs; };
    const Stamp since = base.now;
    base.run(told, 4.0);
    EXPECT_TRUE(base.obedience.runs_away());
    EXPECT_LT(base.first - since, 3.5);
  }
}

/// A base that obeys, told whatever, is never blamed, though what it is told changes at any time.
TEST(Obedience, ABaseThatObeysIsNeverBlamed) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> v(-0.7, 0.7), w(-1.7, 1.7), seconds(0.05, 4.0);
    Base base;
    for (int i = 0; i < 200; ++i) {
      const auto kind = random() % 4;
      const Drive told = kind == 0   ? Drive{}
                         : kind == 1 ? Drive{v(random), 0.0}
                         : kind == 2 ? Drive{0.0, w(random)}
                                     : Drive{v(random), w(random)};
      base.silent = random() % 8 == 0;
      if (random() % 16 == 0) base.obedience.pause();
      base.run(told, seconds(random));
      ASSERT_EQ(base.obedience.trouble(), "")
          << "seed " << seed << " step " << i << " told " << told.v << ", " << told.w;
    }
  }
}

/// A base that was not heard meanwhile is seen moving when it is heard again; then it gets its ramp.
TEST(Obedience, AfterASilenceItMayBrakeFirst) {
  Base base;
  base.run({0.6, 0.0}, 5.0);
  base.silent = true;
  base.wheels = [](Drive) { return Drive{0.6, 0.0}; };
  base.run({}, 4.0);
  base.silent = false;
  base.wheels = {};
  base.run({}, 5.0);
  EXPECT_EQ(base.obedience.trouble(), "");
  EXPECT_NEAR(base.motion.v, 0.0, 1e-9);
}

TEST(Obedience, APushIsForgivenAndAHandThatMovesItForLongIsNot) {
  Base base;
  base.run({}, 3.0);
  base.wheels = [](Drive) { return Drive{0.2, 0.0}; };
  base.run({}, 0.7);
  base.wheels = {};
  base.run({}, 5.0);
  EXPECT_FALSE(base.obedience.runs_away());
  base.wheels = [](Drive) { return Drive{0.2, 0.0}; };
  base.run({}, 3.0);
  EXPECT_TRUE(base.obedience.runs_away());
}

/// A base behind a line: orders and reports are late by times that change, reports get lost, turn rates are whole
/// degrees, its ramps are steeper or flatter than they are taken to be, orders to brake are obeyed at once.
class LateBase {
 public:
  explicit LateBase(unsigned seed) : random_(seed) {
    way_ = uniform(0.0, 0.2);
    back_ = uniform(0.0, 0.25 - way_);
    jitter_ = uniform(0.0, 0.05);
    lost_ = uniform(0.0, 0.3);
    ramp_ = uniform(0.8, 1.5);
  }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int choice(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

  void run(const Drive& told, double seconds, bool hard = false) {
    for (const Stamp end = now + seconds; now < end; now = now + kStep) {
      obedience.tell(told, now);
      orders_.push_back({later(orders_, way_), {told.v, deg_to_rad(dither_.next(rad_to_deg(told.w), now))}, hard});
      while (!orders_.empty() && orders_.front().at <= now) {
        heard_ = orders_.front();
        orders_.pop_front();
      }
      const Drive wanted = wheels ? wheels(heard_.drive) : heard_.drive;
      const bool brakes = heard_.hard && !wheels;
      const double ramp = brakes ? 100.0 : ramp_;
      const auto follow = [&](double is, double to, double accel) {
        const double most = ramp * accel * kStep;
        return is + std::clamp(to - is, -most, most);
      };
      motion_ = {follow(motion_.v, wanted.v, kAccel), follow(motion_.w, wanted.w, kTurnAccel)};
      pose_.phi = wrap_angle(pose_.phi + motion_.w * kStep);
      pose_.x += motion_.v * std::cos(pose_.phi) * kStep;
      pose_.y += motion_.v * std::sin(pose_.phi) * kStep;
      if (++steps_ % 10 == 0 && uniform(0.0, 1.0) >= lost_) reports_.push_back({later(reports_, back_), report()});
      while (!reports_.empty() && reports_.front().at <= now) {
        obedience.look(reports_.front().odometry, now);
        reports_.pop_front();
      }
      if (first == Stamp::never() && !obedience.trouble().empty()) first = now;
    }
  }

  Obedience obedience{kAccel, kTurnAccel};
  Stamp now = Stamp::from_seconds(50.0);
  std::function<Drive(Drive)> wheels;
  Stamp first = Stamp::never();  ///< trouble

 private:
  struct Order {
    Stamp at;
    Drive drive;
    bool hard = false;
  };
  struct Report {
    Stamp at;
    Odometry odometry;
  };

  /// Nothing overtakes.
  template <class T>
  Stamp later(const std::deque<T>& line, double by) {
    const Stamp at = now + by + uniform(0.0, jitter_);
    return line.empty() ? at : std::max(at, line.back().at);
  }
  /// In whole millimetres and twelfths of a degree, as firmware tells it.
  Odometry report() const {
    const auto whole = [](double value, double unit) { return unit * std::round(value / unit); };
    return {now,
            {whole(pose_.x, 1e-3), whole(pose_.y, 1e-3), whole(pose_.phi, deg_to_rad(1.0 / 12.0))},
            whole(motion_.v, 1e-3),
            motion_.w,
            false};
  }

  std::mt19937 random_;
  double way_, back_, jitter_, lost_, ramp_;
  RateDither dither_;
  std::deque<Order> orders_;
  std::deque<Report> reports_;
  Order heard_;
  Drive motion_;
  mrpt::math::TPose2D pose_;
  int steps_ = 0;
};

Drive some_order(LateBase& base) {
  const double slow = base.choice(2) == 0 ? 1.0 : 0.1;
  switch (base.choice(5)) {
    case 0:
      return {};
    case 1:
      return {slow * base.uniform(-0.7, 0.7), 0.0};
    case 2:
      return {0.0, slow * base.uniform(-1.7, 1.7)};
    case 3:
      return {slow * 0.4, base.uniform(-0.05, 0.05)};
    default:
      return {slow * base.uniform(-0.7, 0.7), slow * base.uniform(-1.7, 1.7)};
  }
}

TEST(Obedience, ABaseBehindALateLineThatLosesReportsIsNeverBlamed) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    LateBase base(seed);
    for (int i = 0; i < 100; ++i) {
      const Drive told = some_order(base);
      const bool hard = told.v == 0.0 && told.w == 0.0 && base.choice(2) == 0;
      base.run(told, base.choice(3) == 0 ? base.uniform(0.02, 0.4) : base.uniform(0.2, 5.0), hard);
      ASSERT_EQ(base.obedience.trouble(), "")
          << "seed " << seed << " step " << i << " told " << told.v << ", " << told.w;
    }
  }
}

/// However slowly: told to stand now and then, as an explorer tells it.
TEST(Obedience, WheelsThatGoOnThoughToldToStopRunAwayHoweverSlowly) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    LateBase base(seed);
    for (int i = 0; i < 10; ++i) base.run(some_order(base), base.uniform(0.5, 3.0));
    base.run({}, 6.0);
    ASSERT_EQ(base.obedience.trouble(), "") << "seed " << seed;
    const double sign = base.choice(2) == 0 ? 1.0 : -1.0;
    const double share = base.uniform(0.0, 1.0);
    const Drive creep = base.choice(2) == 0 ? Drive{sign * (0.004 + 0.05 * share), 0.0}
                                            : Drive{0.0, sign * deg_to_rad(0.4 + 8.0 * share)};
    base.wheels = [creep](Drive) { return creep; };
    const Stamp since = base.now;
    if (seed % 2 == 0) {
      base.run({}, 16.0);
    } else {
      for (int i = 0; i < 16; ++i) {
        base.run({0.02, deg_to_rad(1.5)}, 0.3);
        base.run({}, 3.0);
      }
    }
    EXPECT_TRUE(base.obedience.runs_away()) << "seed " << seed << " " << creep.v << ", " << rad_to_deg(creep.w);
    EXPECT_THAT(base.obedience.trouble(), testing::HasSubstr("motors are being switched off"));
    const bool quick = std::abs(creep.v) > 0.012 || std::abs(creep.w) > deg_to_rad(1.2);
    EXPECT_LT(base.first - since, (quick ? 4.5 : 14.0) * (seed % 2 == 0 ? 1.0 : 3.0)) << "seed " << seed;
  }
}

/// Told to go one way it goes the other, too slowly to be seen as a runaway at once.
TEST(Obedience, WheelsThatCreepAgainstWhatTheyAreToldRunAway) {
  const std::vector<std::pair<Drive, Drive>> cases{
      {{-0.2, 0.0}, {0.03, 0.0}},  // told, done
      {{0.3, 0.0}, {-0.012, 0.0}},
      {{0.1, deg_to_rad(20.0)}, {-0.02, deg_to_rad(20.0)}},  // the other axis obeys
      {{0.0, deg_to_rad(30.0)}, {0.0, deg_to_rad(-3.0)}},
      {{0.2, deg_to_rad(-10.0)}, {0.2, deg_to_rad(2.0)}}};
  for (const auto& [told, creep] : cases) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      LateBase base(seed);
      base.run({-creep.v, -creep.w}, 3.0);
      base.run(told, 5.0);
      ASSERT_EQ(base.obedience.trouble(), "") << "seed " << seed;
      base.wheels = [creep = creep](Drive) { return creep; };
      const Stamp since = base.now;
      if (seed % 2 == 0) {
        base.run(told, 16.0);
      } else {  // what it is told changes, but not the way
        for (int i = 0; i < 16; ++i) {
          base.run(told, 0.9);
          base.run({1.5 * told.v, 1.5 * told.w}, 0.4);
          base.run({}, 0.2);
        }
      }
      EXPECT_TRUE(base.obedience.runs_away()) << told.v << ", " << told.w << " seed " << seed;
      EXPECT_THAT(base.obedience.trouble(), testing::HasSubstr("motors are being switched off"));
      EXPECT_LT(base.now - since, 30.0);
    }
  }
}

/// Wheels that are not quite alike go ahead or aside a little when they are told to turn on the spot or to go straight.
TEST(Obedience, UnequalWheelsAreNoDisobedience) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    LateBase base(seed);
    const double more = base.uniform(-0.04, 0.04);
    constexpr double kHalfTrack = 0.294;
    base.wheels = [more](Drive told) {
      const double left = told.v - kHalfTrack * told.w, right = (1.0 + more) * (told.v + kHalfTrack * told.w);
      return Drive{0.5 * (left + right), 0.5 * (right - left) / kHalfTrack};
    };
    for (int i = 0; i < 60; ++i) {
      base.run(some_order(base), base.uniform(0.2, 20.0));
      ASSERT_EQ(base.obedience.trouble(), "") << "seed " << seed << " step " << i;
    }
  }
}

/// A push at the robot that stands, again and again, each shorter than a second and a half.
TEST(Obedience, PushesAreForgiven) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    LateBase base(seed);
    base.run({}, 3.0);
    for (int i = 0; i < 10; ++i) {
      const double v = base.uniform(-0.1, 0.1);
      base.wheels = [v](Drive) { return Drive{v, 0.0}; };
      base.run({}, 0.6);
      base.wheels = {};
      base.run({}, 4.0);
    }
    EXPECT_FALSE(base.obedience.runs_away()) << "seed " << seed << ": " << base.obedience.trouble();
  }
}

/// It is named and driven on, and what it is told may change meanwhile.
TEST(Obedience, WheelsThatDoLessThanHalfOfWhatTheyAreToldAreNamedUntilTheyDoIt) {
  const std::vector<std::pair<Drive, std::function<Drive(Drive)>>> cases{{{0.38, 0.0},
                                                                          [](Drive d) {
                                                                            return Drive{0.4 * d.v, 0.4 * d.w};
                                                                          }},
                                                                         {{-0.3, 0.3},
                                                                          [](Drive d) {
                                                                            return Drive{0.4 * d.v, 0.4 * d.w};
                                                                          }},
                                                                         {{0.0, deg_to_rad(50.0)},
                                                                          [](Drive) {
                                                                            return Drive{0.04, deg_to_rad(3.0)};
                                                                          }},
                                                                         {{0.38, 0.0},
                                                                          [](Drive) {
                                                                            return Drive{0.026, deg_to_rad(1.0)};
                                                                          }},
                                                                         {{0.38, 0.0}, [](Drive) {
                                                                            return Drive{0.0, deg_to_rad(5.0)};
                                                                          }}};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const auto& [told, wheels] = cases[c];
      LateBase base(seed);
      base.run(told, 4.0);
      base.wheels = wheels;
      const Stamp since = base.now;
      for (int i = 0; i < 3; ++i) {
        base.run(told, c < 2 ? 6.0 : 2.2);
        base.run({-told.v, -told.w}, c < 2 ? 6.0 : 2.2);
      }
      EXPECT_THAT(base.obedience.trouble(), testing::HasSubstr("that it was told")) << "case " << c << " seed " << seed;
      EXPECT_FALSE(base.obedience.runs_away());
      EXPECT_LT(base.first - since, 12.0) << "case " << c << " seed " << seed;
      base.wheels = {};
      base.run(told, 6.0);
      EXPECT_EQ(base.obedience.trouble(), "") << "case " << c << " seed " << seed;
    }
  }
}

}  // namespace
}  // namespace rubble::robot
