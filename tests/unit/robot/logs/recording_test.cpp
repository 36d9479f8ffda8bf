#include <malloc.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>

#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/own/log_frames.h"
#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using testing::message_of;
using testing::ScriptedRobot;
using testing::TempFolder;

std::vector<Inputs> steady_ticks(double seconds, double tick) {
  std::vector<Inputs> ticks;
  for (int i = 1; static_cast<double>(i) * tick <= seconds + 1e-9; ++i) {
    Inputs inputs;
    inputs.now = Stamp::from_seconds(static_cast<double>(i) * tick);
    Odometry odometry;
    odometry.stamp = inputs.now;
    odometry.pose.x = static_cast<double>(i);
    inputs.odometry.push_back(odometry);
    ticks.push_back(inputs);
  }
  return ticks;
}

TEST(Recording, ModelAndNoteComeBack) {
  const TempFolder folder;
  RobotModel model;
  model.name = "t\xc3\xa4st \"robot\"\n";
  model.mass = 0.1 + 0.2;
  model.command_timeout = std::numeric_limits<double>::infinity();
  model.has_levelling_unit = false;
  model.T_base_laser = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  model.laser.beams = 271;
  model.laser.beam_period = 1.0 / 3.0;
  const std::string note("any bytes: \0\xff\n{}", 17);
  {
    ScriptedRobot robot({}, model);
    RecordingRobot recorder(robot, folder.file("a.log"), note);
    EXPECT_EQ(recorder.model().name, model.name);
  }
  ReplayRobot replay(folder.file("a.log"));
  EXPECT_EQ(replay.format(), "rubble log");
  EXPECT_EQ(replay.note(), note);
  EXPECT_EQ(replay.model().name, model.name);
  EXPECT_TRUE(testing::same(replay.model().mass, model.mass));
  EXPECT_TRUE(testing::same(replay.model().command_timeout, model.command_timeout));
  EXPECT_FALSE(replay.model().has_levelling_unit);
  EXPECT_TRUE(replay.model().T_base_laser == model.T_base_laser);
  EXPECT_EQ(replay.model().laser.beams, 271);
  EXPECT_TRUE(testing::same(replay.model().laser.beam_period, model.laser.beam_period));
  EXPECT_FALSE(replay.read());
  EXPECT_FALSE(replay.was_torn());
  EXPECT_TRUE(replay.reference().empty());
}

TEST(Recording, WrappedRobotIsSeenUnchanged) {
  const TempFolder folder;
  const std::vector<Inputs> ticks = steady_ticks(0.1, 0.02);
  ScriptedRobot robot(ticks);
  RecordingRobot recorder(robot, folder.file("a.log"), "");
  EXPECT_TRUE(testing::same_list(testing::play(recorder), ticks));
  recorder.command({{0.1, 0.2}, {}});
  ASSERT_EQ(robot.received.size(), 1u);
  EXPECT_EQ(robot.received[0].drive.w, 0.2);
}

TEST(Recording, CommandInForceComesBackWithEachTick) {
  const TempFolder folder;
  const std::vector<Inputs> ticks = steady_ticks(0.12, 0.02);
  const Commands go{{0.3, 0.0}, {0.01, 0.0}};
  const Commands turn{{0.0, -0.5}, {0.01, 0.02}};
  const Commands brake{{}, {0.01, 0.02}, true};
  const Commands rest{{}, {0.01, 0.02}};
  {
    ScriptedRobot robot(ticks);
    RecordingRobot recorder(robot, folder.file("a.log"), "");
    for (const Commands* answer :
         {(const Commands*)nullptr, &go, &go, &turn, &brake, &rest, (const Commands*)nullptr}) {
      recorder.read();
      if (answer != nullptr) recorder.command(*answer);
    }
  }
  ReplayRobot replay(folder.file("a.log"));
  EXPECT_TRUE(testing::same(replay.recorded_commands(), Commands{}));
  for (const Commands& expected : {Commands{}, go, go, turn, brake, rest}) {
    ASSERT_TRUE(replay.read());
    EXPECT_TRUE(testing::same(replay.recorded_commands(), expected));
  }
  EXPECT_FALSE(replay.read());
}

TEST(Recording, ScannerCodesAndTheCommandInForceAreInputs) {
  TempFolder folder;
  std::vector<Inputs> ticks = steady_ticks(0.08, 0.02);
  ticks.resize(3);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    LaserScan scan;
    scan.stamp = ticks[i].now - 0.01;
    scan.ranges = {1.0f, testing::kMiss, testing::kUnknown, 2.0f, testing::kUnknown};
    if (i != 1) scan.codes = {0, 0, 7, 0, 19};
    ticks[i].scans = {scan, scan};
    if (i == 2) ticks[i].scans[0].codes.clear();
  }
  {
    ScriptedRobot scripted(ticks);
    RecordingRobot robot(scripted, folder.file("a.log"), "");
    for (double v = 0.1; robot.read(); v += 0.1) robot.command({{v, 0.0}, {}});
  }
  ReplayRobot replayed(folder.file("a.log"));
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const auto inputs = replayed.read();
    ASSERT_TRUE(inputs);
    ASSERT_EQ(inputs->scans.size(), 2u);
    EXPECT_EQ(inputs->scans[0].codes, ticks[i].scans[0].codes) << i;
    EXPECT_EQ(inputs->scans[1].codes, ticks[i].scans[1].codes) << i;
    ASSERT_TRUE(inputs->command);
    EXPECT_NEAR(inputs->command->drive.v, 0.1 * static_cast<double>(i), 1e-12);  // the answer to the tick before
  }
}

TEST(Recording, TheBatterysVoltageComesBackInItsTick) {
  TempFolder folder;
  std::vector<Inputs> ticks = steady_ticks(0.08, 0.02);
  ticks[1].battery = {11.75, 11.5};
  {
    ScriptedRobot scripted(ticks);
    RecordingRobot robot(scripted, folder.file("a.log"), "");
    while (robot.read()) robot.command({});
  }
  ReplayRobot replayed(folder.file("a.log"));
  for (const Inputs& tick : ticks) {
    const auto inputs = replayed.read();
    ASSERT_TRUE(inputs);
    EXPECT_EQ(inputs->battery, tick.battery);
  }
}

TEST(Recording, UnchangedCommandsTakeNoSpace) {
  const TempFolder folder;
  ScriptedRobot robot({});
  RecordingRobot recorder(robot, folder.file("a.log"), "");
  recorder.command({{0.1, 0.2}, {}});
  recorder.flush();
  const std::size_t size = testing::read_bytes(folder.file("a.log")).size();
  for (int i = 0; i < 100; ++i) recorder.command({{0.1, 0.2}, {}});
  recorder.flush();
  EXPECT_EQ(testing::read_bytes(folder.file("a.log")).size(), size);
  EXPECT_EQ(robot.received.size(), 101u) << "but the robot gets each one: they feed its watchdog";
}

TEST(Recording, ProgressGrowsToOne) {
  const TempFolder folder;
  testing::record(steady_ticks(1.0, 0.02), folder.file("a.log"));
  ReplayRobot replay(folder.file("a.log"));
  double last = replay.progress();
  EXPECT_GE(last, 0.0);
  while (replay.read()) {
    EXPECT_GT(replay.progress(), last);
    last = replay.progress();
  }
  EXPECT_EQ(last, 1.0);
}

TEST(Recording, KilledRunLosesAtMostTheLastSecond) {
  const TempFolder folder;
  const std::vector<Inputs> ticks = steady_ticks(5.7, 0.02);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ScriptedRobot robot(ticks);
    RecordingRobot recorder(robot, folder.file("a.log"), "");
    for (std::size_t i = 0; i < ticks.size(); ++i) recorder.read();
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const std::vector<Inputs> left = testing::play(folder.file("a.log"));
  ASSERT_FALSE(left.empty());
  EXPECT_GE(left.back().now, ticks.back().now - 1.0);
  for (std::size_t i = 0; i < left.size(); ++i) EXPECT_TRUE(testing::same(left[i], ticks[i]));
}

TEST(Recording, FullDiskIsReportedWithThePath) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  ScriptedRobot robot({});
  const std::string message = message_of<RunError>([&] { RecordingRobot recorder(robot, "/dev/full", ""); });
  EXPECT_NE(message.find("/dev/full"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(Recording, MissingFolderIsReportedWithThePath) {
  ScriptedRobot robot({});
  const std::string message = message_of<RunError>([&] { RecordingRobot recorder(robot, "/nowhere/at/all.log", ""); });
  EXPECT_NE(message.find("/nowhere/at/all.log"), std::string::npos) << message;
}

TEST(Recording, ReplayOfAReplayIsTheSameFile) {
  const TempFolder folder;
  Rng rng(3, "ticks");
  testing::record(testing::random_ticks(rng, 30), folder.file("a.log"), "note");
  {
    ReplayRobot replay(folder.file("a.log"));
    RecordingRobot recorder(replay, folder.file("b.log"), replay.note());
    while (recorder.read()) {
    }
  }
  EXPECT_EQ(testing::read_bytes(folder.file("a.log")), testing::read_bytes(folder.file("b.log")));
}

TEST(Recording, AFileAndTheSameBytesUnpackedArePlayedAlike) {
  const TempFolder folder;
  Rng rng(4, "ticks");
  testing::record(testing::random_ticks(rng, 30), folder.file("a.log"), "note");
  write_gzip(folder.file("a.log.gz"), testing::read_bytes(folder.file("a.log")));
  ReplayRobot file(folder.file("a.log")), held(folder.file("a.log.gz"));
  while (const auto inputs = file.read()) {
    const auto same = held.read();
    ASSERT_TRUE(same && testing::same(*inputs, *same));
    EXPECT_EQ(file.progress(), held.progress());
  }
  EXPECT_FALSE(held.read());
}

TEST(Recording, FramesLongerThanWhatIsHeldOfAFileArePlayed) {
  const TempFolder folder;
  std::vector<Inputs> ticks = steady_ticks(1.0, 0.1);
  Rng rng(5, "ranges");
  for (Inputs& inputs : ticks) {
    inputs.scans.resize(1);
    inputs.scans[0].stamp = inputs.now;
    for (int i = 0; i < 400'000; ++i) inputs.scans[0].ranges.push_back(static_cast<float>(rng.uniform()));
  }
  testing::record(ticks, folder.file("a.log"));
  ASSERT_GT(std::filesystem::file_size(folder.file("a.log")), 10u << 20);
  ReplayRobot replay(folder.file("a.log"));
  for (const Inputs& tick : ticks) {
    const auto inputs = replay.read();
    ASSERT_TRUE(inputs && testing::same(*inputs, tick));
  }
  EXPECT_FALSE(replay.read());
}

// A sanitizer's allocator is not asked: there this says 0 both times.
TEST(Recording, PlayingALongLogTakesNoMemoryOfItsLength) {
  const auto held = [] {
    const struct mallinfo2 now = mallinfo2();
    return now.uordblks + now.hblkhd;
  };
  const TempFolder folder;
  testing::record(steady_ticks(2000.0, 0.01), folder.file("a.log"));
  ASSERT_GT(std::filesystem::file_size(folder.file("a.log")), 12u << 20);
  const std::size_t before = held();
  ReplayRobot replay(folder.file("a.log"));
  std::size_t most = 0;
  while (replay.read()) most = std::max(most, held());
  EXPECT_LT(most, before + (3u << 20));
}

TEST(Recording, ALogThatIsCutOrChangedWhileItIsPlayedIsTold) {
  const TempFolder folder;
  const std::string path = folder.file("a.log");
  testing::record(steady_ticks(500.0, 0.01), path);
  const std::string bytes = testing::read_bytes(path);
  {
    ReplayRobot replay(path);
    std::filesystem::resize_file(path, bytes.size() / 2);
    EXPECT_NE(message_of<InputError>([&] { testing::play(replay); }).find("became shorter"), std::string::npos);
  }
  for (const char with : {'\0', 'x'}) {
    testing::write_bytes(path, bytes);
    ReplayRobot replay(path);
    testing::write_bytes(path, bytes.substr(0, bytes.size() / 2) + std::string(bytes.size() - bytes.size() / 2, with));
    EXPECT_NE(message_of<InputError>([&] { testing::play(replay); }).find("copy the log"), std::string::npos);
  }
  {
    testing::write_bytes(path, bytes);
    ReplayRobot replay(path);
    testing::write_bytes(path, bytes + bytes);  // it goes on being written
    EXPECT_EQ(testing::play(replay).size(), 50'000u);
  }
}

TEST(Recording, OtherVersionsAndOtherFilesAreRefused) {
  const TempFolder folder;
  const std::string path = folder.file("a.log");
  testing::write_bytes(path, "RUBBLE LOG 7\nxxxxxxxxxxxxxxxxxx");
  const std::string version = message_of<InputError>([&] { ReplayRobot replay(path); });
  EXPECT_NE(version.find(path + ": byte 0"), std::string::npos) << version;
  EXPECT_NE(version.find("'7'"), std::string::npos) << version;
  for (const char* text : {"hello world\n", "\x01\x02\x03", "RUBBLE LIG 1\n", "1 2 3\n"}) {
    testing::write_bytes(path, text);
    const std::string message = message_of<InputError>([&] { ReplayRobot replay(path); });
    EXPECT_NE(message.find("known format"), std::string::npos) << message;
  }
  testing::write_bytes(path, "");
  EXPECT_NE(message_of<InputError>([&] { ReplayRobot replay(path); }).find("empty"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { ReplayRobot replay(folder.file("none")); }).find("cannot be opened"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { ReplayRobot replay(folder.file("")); }).find("folder"), std::string::npos);
}

TEST(Recording, LogWithoutHeaderSaysSo) {
  const TempFolder folder;
  const std::string path = folder.file("a.log");
  testing::write_bytes(path, std::string(kLogMagic));
  EXPECT_NE(message_of<InputError>([&] { ReplayRobot replay(path); }).find("header"), std::string::npos);
}

}  // namespace
}  // namespace rubble::robot
