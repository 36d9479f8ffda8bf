// A thread that the computer woke late, and what its black box tells.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/black_box_replay.h"
#include "robot/drivers/levelling_unit.h"
#include "robot/emulators/levelling_emulator.h"

namespace rubble::robot {
namespace {

/// A levelling unit on a line, and the turns of a thread that leads its driver, which sleeps when told to.
class LateDrive {
 public:
  LateDrive() {
    unit_.client_came(now_);
    box.push_back({"levelling", Direction::Opened, now_, "a\nuart"});
    driver_.opened(now_, LineKind::Uart);
  }

  void go_on(double seconds, bool unit_heard = true, bool thread_awake = true) {
    for (const Stamp end = now_ + seconds; now_ < end;) {
      now_ = now_ + 0.001;
      unit_.advance(now_);
      if (++steps_ % 20 == 0) unit_.measure({now_, 0.001 * steps_, 0.0}, {now_, 0.0, 0.0}, now_);
      const std::string said = unit_.take_output();
      if (unit_heard) waiting_ += said;
      if (thread_awake && (steps_ % 20 == 7 || !waiting_.empty())) turn();
    }
  }

  ReplayedBox replayed() const { return replay_black_box(box, "arcos", {}, {}); }

  std::vector<BlackBoxEntry> box;
  std::vector<Acceleration> accelerations;
  std::vector<AimState> aims;
  int questions = 0;

 private:
  void turn() {
    const std::string read = std::exchange(waiting_, "");
    box.push_back({"levelling", read.empty() ? Direction::Turn : Direction::FromDevice, now_, read});
    if (!read.empty()) driver_.receive(read, now_);
    driver_.advance(now_);
    if (const std::string out = driver_.take_output(now_); !out.empty()) {
      box.push_back({"levelling", Direction::ToDevice, now_, out});
      unit_.receive(out, now_);
      ++questions;
    }
    for (const Acceleration& a : driver_.take_accelerations()) accelerations.push_back(a);
    for (const AimState& a : driver_.take_aims()) aims.push_back(a);
  }

  Stamp now_{1'700'000'000'000'000'000};
  LevellingEmulator unit_{LevellingEmulatorSettings{}};
  LevellingUnit driver_{LevellingUnitSettings{}};
  std::string waiting_;
  int steps_ = 0;
};

void expect_the_same(const LateDrive& drive) {
  const ReplayedBox replayed = drive.replayed();
  ASSERT_EQ(replayed.accelerations.size(), drive.accelerations.size());
  for (std::size_t i = 0; i < replayed.accelerations.size(); ++i) {
    EXPECT_EQ(replayed.accelerations[i].stamp.ns, drive.accelerations[i].stamp.ns) << i;
    EXPECT_EQ(replayed.accelerations[i].x, drive.accelerations[i].x) << i;
    EXPECT_EQ(replayed.accelerations[i].y, drive.accelerations[i].y) << i;
  }
  ASSERT_EQ(replayed.aims.size(), drive.aims.size());
  for (std::size_t i = 0; i < replayed.aims.size(); ++i) {
    EXPECT_EQ(replayed.aims[i].stamp.ns, drive.aims[i].stamp.ns) << i;
    EXPECT_EQ(replayed.aims[i].pitch, drive.aims[i].pitch) << i;
    EXPECT_EQ(replayed.aims[i].roll, drive.aims[i].roll) << i;
  }
}

/// It reads first what came meanwhile; at its deadline, by the clock, the driver would have given the unit up.
TEST(LateThread, WhatItReadsAfterASleepComesOutAgain) {
  for (const double sleep : {0.1, 0.49, 0.51, 0.8, 2.0}) {
    SCOPED_TRACE(sleep);
    LateDrive drive;
    drive.go_on(2.0);
    const std::size_t before = drive.accelerations.size();
    ASSERT_GT(before, 50u);
    drive.go_on(sleep, true, false);
    drive.go_on(1.0);
    ASSERT_GE(drive.accelerations.size(), before + static_cast<std::size_t>((sleep + 0.9) / 0.02)) << "none is lost";
    expect_the_same(drive);
  }
}

TEST(LateThread, AUnitThatWasGivenUpIsGivenUpAgain) {
  for (const double silent : {0.3, 0.505, 0.9, 3.0}) {
    SCOPED_TRACE(silent);
    LateDrive drive;
    drive.go_on(2.0);
    const int questions = drive.questions;
    drive.go_on(silent, false);
    if (silent > 0.6) {
      EXPECT_GT(drive.questions, questions) << "the driver asks anew";
    }
    drive.go_on(2.0);
    ASSERT_GT(drive.accelerations.size(), 150u);
    expect_the_same(drive);
  }
}

}  // namespace
}  // namespace rubble::robot
