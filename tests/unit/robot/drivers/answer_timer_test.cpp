#include "robot/drivers/answer_timer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <string>

#include "robot/drivers/watch/answer_watch.h"

namespace rubble::robot {
namespace {

/// A device that answers every question after `way` of that moment; a negative one: the question is lost.
class Line {
 public:
  explicit Line(std::function<double(double)> way) : way_(std::move(way)) {}

  void run(double seconds) {
    for (const Stamp end = now + seconds; now < end; now = now + 0.01) {
      for (; !coming_.empty() && coming_.front() <= now; coming_.pop_front()) timer.answered(now);
      timer.advance(now);
      if (timer.due(now)) {
        timer.asked(now);
        ++questions;
        const double way = way_(now - start);
        if (way >= 0.0) coming_.push_back(coming_.empty() ? now + way : std::max(coming_.back(), now + way));
      }
      worst = std::max(worst, timer.late(now));
      waited = waited || timer.missing(now);
    }
  }
  double late() const { return timer.late(now); }

  const Stamp start = Stamp::from_seconds(100.0);
  Stamp now = start;
  AnswerTimer timer;
  int questions = 0;
  double worst = 0.0;
  bool waited = false;  ///< an answer was called missing

 private:
  std::function<double(double)> way_;
  std::deque<Stamp> coming_;
};

TEST(AnswerTimer, TellsHowLateEveryLineIs) {
  for (const double way : {0.0, 0.05, 0.29, 0.35, 0.6, 0.95, 1.0, 1.3, 2.2, 4.1}) {
    Line line([way](double) { return way; });
    line.run(6.0 * way + 4.0);
    EXPECT_NEAR(line.late(), way, 0.02) << way;
  }
}

TEST(AnswerTimer, ALineThatIsSlowFromTheStartIsFoundOutByItsFirstAnswer) {
  for (const double way : {0.35, 0.7, 1.2}) {
    Line line([way](double) { return way; });
    line.run(2.0 * way + 1.0);
    EXPECT_NEAR(line.late(), way, 0.02);
  }
}

TEST(AnswerTimer, ALineThatBecomesSlowIsFoundOutAndOneThatRecoversToo) {
  for (const double slow : {0.4, 0.7, 1.0, 1.6}) {
    SCOPED_TRACE(slow);
    Line line([slow](double t) { return t > 10.0 && t < 20.0 ? slow : 0.02; });
    line.run(10.0);
    EXPECT_LT(line.worst, 0.05);
    line.run(2.0);
    EXPECT_GT(line.worst, 0.3) << "what is slow is named within 2 s";
    line.run(20.0 - (line.now - line.start));
    EXPECT_NEAR(line.late(), slow, 0.02);
    line.run(slow + 3.0);
    EXPECT_NEAR(line.late(), 0.02, 0.02);
  }
}

/// In an hour of each line, whose answers wait for a cycle of 0.1 s.
TEST(AnswerTimer, WhatGetsLostOnALineThatIsQuickIsNotCalledLate) {
  for (const double loss : {0.01, 0.05, 0.1}) {
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform;
      int lost = 0;
      Line line([&](double) {
        const bool gone = uniform(random) < loss;
        lost += gone ? 1 : 0;
        return gone ? -1.0 : 0.02 + 0.1 * uniform(random);
      });
      line.run(3600.0);
      EXPECT_GT(lost, 50);
      EXPECT_FALSE(line.waited) << "seed " << seed << ", loss " << loss;
      EXPECT_LT(line.worst, 0.3) << "seed " << seed << ", loss " << loss;
    }
  }
}

/// At any moment, by any delay: a robot is stopped within 2 s and does not drive again while the line is so.
TEST(AnswerTimer, ALineThatIsSlowOrDeafIsNamedWithinTwoSecondsAndStaysSo) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 150; ++i) {
    const double slow = i % 5 == 0 ? -1.0 : 0.35 + 2.0 * uniform(random), since = 5.0 + uniform(random);
    SCOPED_TRACE("run " + std::to_string(i) + ", slow by " + std::to_string(slow) + " s");
    Line line([=](double t) { return t >= since ? slow : 0.02; });
    line.run(since + 2.0);
    EXPECT_GT(line.late(), 0.3);
    for (int k = 0; k < 2000; ++k) {
      line.run(0.01);
      ASSERT_GT(line.late(), 0.3) << "after " << 0.01 * k << " s";
    }
    if (slow > 0.0) {
      EXPECT_NEAR(line.late(), slow, 0.03);
    }
  }
}

/// The line loses answers and is slow: what got lost must not make it seem quick, for it would be driven on.
TEST(AnswerTimer, ALineThatIsSlowAndLosesMuchIsNeverTakenForQuick) {
  for (const double slow : {0.4, 0.5, 0.7, 1.0, 1.6, 2.5}) {
    for (const double loss : {0.05, 0.1, 0.2, 0.3}) {
      SCOPED_TRACE(testing::Message() << slow << " s, loss " << loss);
      std::mt19937 random(3);
      std::uniform_real_distribution<double> uniform;
      Line line([&, slow, loss](double) { return uniform(random) < loss ? -1.0 : slow + 0.1 * uniform(random); });
      line.run(20.0);
      double quick = 0.0;
      for (int k = 0; k < 360000; ++k) {
        line.run(0.01);
        quick += line.late() > 0.3 ? 0.0 : 0.01;
      }
      EXPECT_EQ(quick, 0.0) << "s of an hour";
    }
  }
}

/// From one moment on: it is found out some seconds later, for a single late answer may be this computer's, and not let
/// go again from then on.
TEST(AnswerTimer, ALineThatBecomesSlowAndLosesMuchIsNotTakenForQuickAgain) {
  double latest = 0.0;
  for (const double slow : {0.4, 0.5, 0.7, 1.0, 1.6, 2.5}) {
    for (const double loss : {0.1, 0.2, 0.3}) {
      for (unsigned seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(testing::Message() << slow << " s, loss " << loss << ", seed " << seed);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform;
        Line line([&, slow, loss](double t) {
          return uniform(random) < loss ? -1.0 : t < 20.0 ? 0.02 : slow + 0.1 * uniform(random);
        });
        line.run(20.0);
        double found = 0.0, quick = 0.0;
        AnswerWatch watch(0.3);  // for a second more, as who drives by it
        for (int k = 1; k <= 4000; ++k) {
          line.run(0.01);
          const bool well = watch.look({line.late(), line.timer.missing(line.now)}, line.now);
          if (!well && found == 0.0) found = 0.01 * k;
          if (well && found > 0.0) quick += 0.01;
        }
        EXPECT_GT(found, 0.0);
        EXPECT_EQ(quick, 0.0) << "s of forty";
        latest = std::max(latest, found);
      }
    }
  }
  std::printf("found out after %.1f s at the latest\n", latest);
  EXPECT_LT(latest, 8.0);
}

/// Once it is quick again it is used again, though it loses as much as before.
TEST(AnswerTimer, ALineThatRecoversIsQuickThoughItLosesMuch) {
  for (const double slow : {0.5, 1.0, 2.0}) {
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform;
      Line line([&, slow](double t) { return uniform(random) < 0.1 ? -1.0 : t < 20.0 ? slow : 0.02; });
      line.run(20.0);
      ASSERT_GT(line.late(), 0.3);
      line.run(slow + 8.0);
      EXPECT_LT(line.late(), 0.3) << slow << " seed " << seed;
    }
  }
}

/// An answer to a question of before, such as one that had been counted as lost, is taken for the next one's: the error
/// must not go on from each to the next.
TEST(AnswerTimer, AnAnswerTooManyDoesNotMakeASlowLineQuick) {
  for (const double slow : {0.5, 0.8, 1.2, 1.6, 2.0}) {
    SCOPED_TRACE(slow);
    Line line([slow](double) { return slow; });
    line.run(10.0);
    for (const double after : {0.1, 0.5, 0.9}) {
      line.run(after);
      line.timer.answered(line.now);
      for (int k = 0; k < 1000; ++k) {
        line.run(0.01);
        ASSERT_GT(line.late(), 0.3) << after << " s, " << 0.01 * k << " s after it";
      }
    }
  }
}

/// The computer stood still for 3 s: questions and answers waited.
TEST(AnswerTimer, AComputerThatStoodStillKnowsASlowLineAfterwards) {
  for (const double slow : {0.4, 0.6, 1.0, 1.6}) {
    for (double at = 10.0; at < 12.0; at += 0.1) {
      SCOPED_TRACE(testing::Message() << slow << ", still at " << at);
      Line line([slow](double) { return slow; });
      line.run(at);
      line.now = line.now + 3.0;
      for (int k = 0; k < 800; ++k) {
        line.run(0.01);
        ASSERT_GT(line.late(), 0.3) << 0.01 * k << " s after it";
      }
    }
  }
}

TEST(AnswerTimer, OneAnswerThatIsHeldUpIsNotASlowLine) {
  Line line([](double t) { return std::abs(t - 10.0) < 0.25 ? 0.45 : 0.02; });
  line.run(20.0);
  EXPECT_LT(line.worst, 0.1);
}

TEST(AnswerTimer, ADeviceThatFallsDeafHasNotAnsweredForSoLongAndIsWellWhenItHearsAgain) {
  Line line([](double t) { return t > 10.0 && t < 13.0 ? -1.0 : 0.02; });
  line.run(11.3);
  EXPECT_FALSE(line.waited);
  line.run(1.6);
  EXPECT_TRUE(line.waited);
  EXPECT_NEAR(line.late(), 2.8, 0.3);
  line.run(2.0);
  EXPECT_LT(line.late(), 0.05);
}

TEST(AnswerTimer, ADeviceThatNeverAnswersIsNotWaitedForForEver) {
  Line line([](double) { return -1.0; });
  line.run(AnswerTimer::kUnable - 0.1);
  EXPECT_FALSE(line.waited) << "it may not know the question, and its reports come";
  line.run(1.0);
  EXPECT_EQ(line.late(), 0.0);
  const int asked = line.questions;
  line.run(10.0);
  EXPECT_EQ(line.questions, asked);
  line.timer.reset();
  EXPECT_TRUE(line.timer.due(line.now)) << "a new connection may be to another one";
}

/// Its one answer to another question was late, which says nothing of now.
TEST(AnswerTimer, ADeviceThatDoesNotKnowTheQuestionIsNotHeldForWhatAnotherOneTook) {
  Line line([](double) { return -1.0; });
  line.timer.assume(0.4);
  line.timer.assume(0.4);
  line.run(1.0);
  EXPECT_GT(line.late(), 0.3);
  line.run(AnswerTimer::kUnable + 1.0);
  EXPECT_EQ(line.late(), 0.0);
}

TEST(AnswerTimer, TheWayOfTheBytesIsNotCounted) {
  AnswerTimer timer;
  Stamp now = Stamp::from_seconds(5.0);
  for (int i = 0; i < 3; ++i) {
    timer.asked(now);
    timer.answered(now + 0.25, 0.2);
    now = now + 1.0;
  }
  EXPECT_NEAR(timer.late(now), 0.05, 1e-9);
}

}  // namespace
}  // namespace rubble::robot
