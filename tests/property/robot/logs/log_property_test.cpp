#include "base/bytes.h"
#include "robot/logs/own/log_codec.h"
#include "robot/logs/own/log_frames.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using testing::message_of;
using testing::TempFolder;

TEST(LogProperty, RandomInputsAndCommandsComeBackBitExact) {
  const TempFolder folder;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "log");
    const std::vector<Inputs> ticks = testing::random_ticks(rng, 1 + rng.below(30));
    std::vector<Commands> in_force;
    {
      testing::ScriptedRobot robot(ticks);
      RecordingRobot recorder(robot, folder.file("a.log"), "seed");
      Commands commands;
      while (recorder.read()) {
        if (rng.below(3) == 0) {
          commands = testing::random_commands(rng);
          recorder.command(commands);
        }
        in_force.push_back(commands);
      }
    }
    ReplayRobot replay(folder.file("a.log"));
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const auto inputs = replay.read();
      ASSERT_TRUE(inputs);
      ASSERT_TRUE(testing::same(*inputs, ticks[i])) << "tick " << i;
      ASSERT_TRUE(testing::same(replay.recorded_commands(), in_force[i])) << "tick " << i;
    }
    EXPECT_FALSE(replay.read());
    EXPECT_FALSE(replay.was_torn());
  }
}

/// A log of few ticks, and where each of its frames ends.
struct SmallLog {
  std::vector<Inputs> ticks;
  std::string bytes;
  std::vector<std::size_t> ends;

  SmallLog(std::uint64_t seed, const TempFolder& folder) {
    Rng rng(seed, "small log");
    ticks = testing::random_ticks(rng, 6);
    testing::record(ticks, folder.file("whole.log"));
    bytes = testing::read_bytes(folder.file("whole.log"));
    ends = split_frames(bytes, "whole.log").ends;
  }
  /// How many ticks end at or before `size` (frame 0 is the header).
  std::size_t ticks_within(std::size_t size) const {
    std::size_t count = 0;
    while (count + 1 < ends.size() && ends[count + 1] <= size) ++count;
    return count;
  }
};

TEST(LogProperty, CutAtAnyByteLosesOnlyTheTornFrame) {
  const TempFolder folder;
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SmallLog log(seed, folder);
    for (std::size_t size = log.bytes.size(); size > log.ends[2]; --size) {
      std::filesystem::resize_file(folder.file("whole.log"), size);
      ReplayRobot replay(folder.file("whole.log"));
      const std::vector<Inputs> left = testing::play(replay);
      ASSERT_EQ(left.size(), log.ticks_within(size)) << "cut at " << size;
      for (std::size_t i = 0; i < left.size(); ++i) ASSERT_TRUE(testing::same(left[i], log.ticks[i]));
      const bool between_frames = std::find(log.ends.begin(), log.ends.end(), size) != log.ends.end();
      ASSERT_EQ(replay.was_torn(), !between_frames) << "cut at " << size;
    }
  }
}

TEST(LogProperty, TailOfZerosCountsAsTorn) {
  const TempFolder folder;
  const SmallLog log(5, folder);
  const std::size_t last = log.ends[log.ends.size() - 2];
  for (std::size_t size = last; size <= log.bytes.size(); size += 11) {
    testing::write_bytes(folder.file("cut.log"), log.bytes.substr(0, size) + std::string(5000, '\0'));
    ReplayRobot replay(folder.file("cut.log"));
    const std::size_t left = testing::play(replay).size();
    EXPECT_GE(left, log.ticks.size() - 1);
    EXPECT_TRUE(replay.was_torn());
  }
}

TEST(LogProperty, DamageBeforeTheLastFrameIsNeverSilent) {
  const TempFolder folder;
  const SmallLog log(7, folder);
  const std::size_t last = log.ends[log.ends.size() - 2];
  Rng rng(7, "damage");
  for (std::size_t place = kLogMagic.size(); place < last; ++place) {
    std::string bytes = log.bytes;
    bytes[place] = static_cast<char>(bytes[place] ^ static_cast<char>(1 + rng.below(255)));
    const std::string message = message_of<InputError>([&] { split_frames(bytes, "bad.log"); });
    ASSERT_NE(message.find("bad.log: byte "), std::string::npos) << message;
    ASSERT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(LogProperty, RemedyForDamageWorks) {
  const TempFolder folder;
  const SmallLog log(8, folder);
  const std::size_t place = log.ends[3] + 20;
  std::string bytes = log.bytes;
  bytes[place] = static_cast<char>(bytes[place] ^ 1);
  testing::write_bytes(folder.file("bad.log"), bytes);
  const std::string message = message_of<InputError>([&] { ReplayRobot replay(folder.file("bad.log")); });
  EXPECT_NE(message.find("head -c " + std::to_string(log.ends[3])), std::string::npos) << message;
  testing::write_bytes(folder.file("part.log"), bytes.substr(0, log.ends[3]));
  EXPECT_EQ(testing::play(folder.file("part.log")).size(), 3u);
}

TEST(LogProperty, WellCheckedGarbageIsRefusedNotObeyed) {
  const std::uint64_t seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Rng rng(seed, "garbage");
  int refused = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string payload(1 + rng.below(60), 'T');
    for (std::size_t i = 1; i < payload.size(); ++i)
      payload[i] = static_cast<char>(rng.below(rng.below(2) == 0 ? 256 : 4));
    TickContext context;
    for (const char kind : {'T', 'C', 'H'}) {
      payload[0] = kind;
      try {
        if (kind == 'T') decode_tick(payload, context);
        if (kind == 'C') decode_commands(payload);
        if (kind == 'H') decode_header(payload);
      } catch (const BadPayload&) {
        ++refused;
      }
    }
  }
  // A few short payloads happen to be well formed; nearly all must be refused.
  EXPECT_GT(refused, 3 * 20000 * 9 / 10);
}

}  // namespace
}  // namespace rubble::robot
