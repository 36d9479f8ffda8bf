// A mapper that is another process: what it says is what the mapper shows; whatever happens to it ends in one clear
// line within its time; and nothing of it is left behind.
#include "slam/process/process_mapper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

namespace rubble::slam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ProcessMapperTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "process-mapper-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<ProcessMapper> mapper(const std::string& command, double timeout = 20.0) const {
    return std::make_unique<ProcessMapper>(
        robot::RobotModel(), MapperProcess{command, {"/bin/sh", "-c", command}, file("mapper.log"), "", timeout}, 1);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string content(const std::string& name) const {
    std::ifstream in(file(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

/// A mapper in shell: `answer` is what it says before the end of each answer.
std::string answering(const std::string& answer) {
  return "echo ready 1; while read -r word rest; do case $word in end) " + answer + "; echo end;; esac; done";
}

robot::Inputs tick_at(double now, bool with_scan = false) {
  robot::Inputs in;
  in.now = Stamp::from_seconds(now);
  in.odometry.push_back({Stamp::from_seconds(now - 0.01), {now, 0.0, 0.0}, 1.0, 0.0, false});
  if (with_scan) {
    robot::LaserScan scan;
    scan.stamp = Stamp::from_seconds(now - 0.05);
    scan.angle_step = 0.1;
    scan.range_max = 4.0;
    scan.ranges = {1.0f, 2.0f, 3.0f};
    in.scans.push_back(scan);
  }
  return in;
}

/// The line that ends the run; empty when nothing went wrong in `ticks` ticks.
std::string end_of(Mapper& mapper, int ticks = 3) {
  try {
    for (int i = 1; i <= ticks; ++i) mapper.update(tick_at(0.1 * i));
    mapper.finish();
  } catch (const MapperLost& lost) {
    return lost.what();
  }
  return "";
}

bool alive(pid_t pid) {
  if (kill(pid, 0) != 0) return false;
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text{std::istreambuf_iterator<char>(stat), {}};
  const auto name = text.rfind(')');
  return name != std::string::npos && text[name + 2] != 'Z';
}

/// Waits for what other processes do; false: it did not come about in a time that no machine needs.
bool soon(const std::function<bool()>& holds) {
  for (int i = 0; i < 2000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST_F(ProcessMapperTest, AnswersBeforeTheFirstTickAndStartsNothing) {
  const auto m = mapper("touch " + file("started"));
  EXPECT_EQ(m->pose().x, 0.0);
  EXPECT_TRUE(m->trajectory().empty());
  EXPECT_EQ(m->map().seen({0, 0}), 0);
  m->finish();
  EXPECT_FALSE(fs::exists(file("started")));
}

TEST_F(ProcessMapperTest, ShowsWhatItIsTold) {
  const auto m =
      mapper(answering("printf 'pose 1 2 0.5\\ncovariance 4 0 0 9 0 1\\nmap 2 2 0.1 -1 -2\\n?.\\n#.\\nmapped 7\\n"
                       "settled 0\\nblind_way 1.5\\nfigure loops 3\\n'"));
  EXPECT_TRUE(m->settled());
  EXPECT_EQ(m->blind_way(), 0.0);
  ASSERT_EQ(end_of(*m), "");
  EXPECT_EQ(m->pose().y, 2.0);
  EXPECT_EQ(m->covariance()(1, 1), 9.0);
  EXPECT_EQ(m->map().frame(), (GridFrame{2, 2, 0.1, -1.0, -2.0}));
  EXPECT_EQ(m->map().p_occ({0, 1}), 1.0);
  EXPECT_EQ(m->map().seen({0, 0}), 0);
  EXPECT_EQ(m->counts().mapped, 7u);
  EXPECT_FALSE(m->settled());
  EXPECT_EQ(m->blind_way(), 1.5);
  ASSERT_EQ(m->figures().size(), 1u);
  EXPECT_EQ(m->figures()[0].key, "mapper_loops");  // no figure of somebody else's can pass for one of ours
}

TEST_F(ProcessMapperTest, ScansLieBetweenThePosesOfTheTicks) {
  // The pose of tick n is x = n, told of odometry at 0.1 n - 0.01 s.
  const auto m = mapper("n=0; " + answering("n=$((n+1)); echo pose $n 0 0"));
  for (int i = 1; i <= 20; ++i) m->update(tick_at(0.1 * i, i % 2 == 0));
  m->finish();
  ASSERT_EQ(m->trajectory().size(), 10u);
  for (const StampedPose& at : m->trajectory())
    EXPECT_NEAR(at.pose.x, (at.stamp.seconds() + 0.01) / 0.1, 1e-6) << at.stamp.seconds();
  EXPECT_TRUE(m->pose_at(Stamp::from_seconds(1.0)));
  EXPECT_FALSE(m->last_hits().empty());
}

TEST_F(ProcessMapperTest, ACorrectionMovesThePastAndRaisesTheRevision) {
  const auto m =
      mapper("n=0; " + answering("n=$((n+1)); echo at $n 1 0 0; if [ $n = 3 ]; then printf 'trajectory 3\\n1 5 0 0\\n"
                                 "2 6 0 0\\n3 7 0 0\\n'; fi"));
  m->update(tick_at(0.1));
  m->update(tick_at(0.2));
  const std::uint64_t before = m->revision();
  EXPECT_EQ(m->pose_at({2})->x, 1.0);
  m->update(tick_at(0.3));
  EXPECT_GT(m->revision(), before);
  EXPECT_EQ(m->pose_at({2})->x, 6.0);
  EXPECT_EQ(m->live_trajectory()[1].pose.x, 1.0);
}

TEST_F(ProcessMapperTest, TheMapsCornerMayMoveByAPartOfACell) {
  const auto m = mapper("n=0; " + answering("n=$((n+1)); printf \"map 2 1 0.1 0.02$n 0\\n.#\\n\""));
  m->update(tick_at(0.1));
  EXPECT_NEAR(m->map().frame().x0, 0.021, 1e-9);
  m->update(tick_at(0.2));
  EXPECT_NEAR(m->map().frame().x0, 0.022, 1e-9);
  EXPECT_GT(m->map().occupied({1, 0}), 0);
}

TEST_F(ProcessMapperTest, EveryFailureIsOneLineThatNamesTheCommandAndTheCause) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"exit 3", "ended with exit code 3"},
      {"no-such-program-at-all", "ended with exit code 127"},
      {"kill -9 $$", "was ended by signal 9"},
      {"echo ready 1; read -r line; exit 5", "ended with exit code 5"},
      {"echo ready 7", "speaks version 7"},
      {"echo Starting up...", "'Starting up...' where 'ready 1'"},
      {answering("echo debugging"), "'debugging' where a line of the answer"},
      {answering("echo pose 1 2"), "a word is missing"},
      {answering("echo map 9999999 9999999 0.05 0 0"), "not within 1 to 8000"},
      {answering("head -c 3000000 /dev/zero | tr '\\0' a"), "a line is longer than"},
      {"n=0; " + answering("n=$((n+1)); printf \"map 1 1 0.0$n 0 0\\n.\\n\""), "resolution changed"},
      {answering("echo at 5 0 0 0"), "do not rise"},
  };
  for (const auto& [command, cause] : cases) {
    const auto m = mapper(command);
    const std::string end = end_of(*m);
    EXPECT_THAT(end, HasSubstr(cause)) << command;
    EXPECT_THAT(end, HasSubstr("mapper '")) << command;
    EXPECT_THAT(end, HasSubstr("mapper.log")) << command;
    EXPECT_EQ(end.find('\n'), std::string::npos) << command;
    EXPECT_THAT(end, ::testing::Not(::testing::ContainsRegex("at [0-9]+[.][0-9][0-9][0-9][0-9]")))
        << "more than milliseconds";
    EXPECT_EQ(end_of(*m), "") << "it is over, and can still be asked";
  }
}

TEST_F(ProcessMapperTest, ItsLastWordsAreTold) {
  const auto m = mapper("echo 'Traceback' >&2; echo 'ModuleNotFoundError: numpy' >&2; exit 1");
  EXPECT_THAT(end_of(*m), HasSubstr("its last words: 'ModuleNotFoundError: numpy'"));
  EXPECT_THAT(content("mapper.log"), HasSubstr("Traceback"));
}

TEST_F(ProcessMapperTest, SilenceEndsWithTheTime) {
  for (const char* command :
       {"sleep 1000", "echo ready 1; sleep 1000", "echo ready 1; read -r l; printf 'pose 1'; sleep 1000"}) {
    const auto m = mapper(command, 0.5);
    EXPECT_THAT(end_of(*m), HasSubstr("no whole answer within 0.5 s")) << command;
  }
}

TEST_F(ProcessMapperTest, MuchOnItsStandardErrorStopsNothing) {
  const auto m = mapper(answering("head -c 300000 /dev/zero >&2"));
  EXPECT_EQ(end_of(*m), "");
  EXPECT_GE(fs::file_size(file("mapper.log")), 900000u);
}

TEST_F(ProcessMapperTest, TalkingBeforeItWasAskedDoesNotBlock) {
  // Both pipes are full before the other side reads: neither may wait for the other.
  const auto m = mapper("echo ready 1; head -c 4000000 /dev/zero | tr '\\0' '\\n'; cat >/dev/null", 20.0);
  EXPECT_THAT(end_of(*m), HasSubstr("a word is missing"));
}

TEST_F(ProcessMapperTest, TheLastAnswerIsTakenAndTheProcessMayEndByItself) {
  const auto m = mapper(
      "echo ready 1; while read -r word rest; do case $word in finish) f=1;; end) echo pose ${f:-0} 0 0; echo "
      "end;; esac; done; sleep 0.2; echo bye >" +
      file("bye"));
  ASSERT_EQ(end_of(*m), "");
  EXPECT_EQ(m->pose().x, 1.0);
  EXPECT_EQ(content("bye"), "bye\n");
}

/// A mapper that leaves processes: one in its group, one in a session of its own whose parent is gone.
std::string with_descendants(const std::string& folder) {
  return "sleep 1000 & echo $! >" + folder + "/a; (setsid sh -c 'sleep 1000 & echo $! >" + folder +
         "/b; sleep 1000' &) ; while [ ! -s " + folder + "/b ]; do sleep 0.01; done; echo $$ >" + folder + "/c; " +
         answering("echo pose 0 0 0");
}

TEST_F(ProcessMapperTest, NothingIsLeftBehind) {
  auto m = mapper(with_descendants(folder_.string()));
  m->update(tick_at(0.1));
  std::vector<pid_t> pids;
  for (const char* name : {"a", "b", "c"}) pids.push_back(std::stoi(content(name)));
  for (const pid_t pid : pids) EXPECT_TRUE(alive(pid));
  m.reset();
  for (const pid_t pid : pids) EXPECT_FALSE(alive(pid)) << pid;
}

TEST_F(ProcessMapperTest, NothingIsLeftBehindByKillMinusNine) {
  const pid_t owner = fork();
  ASSERT_GE(owner, 0);
  if (owner == 0) {
    const auto m = mapper(with_descendants(folder_.string()));
    m->update(tick_at(0.1));
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(owner, &status, 0), owner);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  for (const char* name : {"a", "b", "c"}) {
    const pid_t pid = std::stoi(content(name));
    EXPECT_TRUE(soon([&] { return !alive(pid); })) << name << " " << pid;
  }
}

TEST_F(ProcessMapperTest, ItEndsWhenItsCommandEndsAlthoughAChildHoldsThePipe) {
  const auto m = mapper("sleep 1000 & exit 6");
  EXPECT_THAT(end_of(*m), HasSubstr("ended with exit code 6"));
}

TEST(ProcessMapperConfig, ACommandOfAFileNeedsPermission) {
  MapperConfig config;
  config.choose("process");
  const YamlMap yaml = YamlMap::parse("command: touch never", "file.yaml");
  YamlReader reader(yaml);
  config.bind(reader);
  EXPECT_EQ(config.command(), "touch never");
  EXPECT_THROW(config.make(robot::RobotModel(), {}), InputError);
  EXPECT_THROW(make_here(config, robot::RobotModel(), {}), InputError);
  MapperConfig copy = config;
  copy.permit_command();
  EXPECT_NO_THROW(copy.make(robot::RobotModel(), {}));
  EXPECT_NO_THROW(MapperConfig(copy).make(robot::RobotModel(), {}));
  copy = config;
  EXPECT_THROW(copy.make(robot::RobotModel(), {}), InputError);
}

TEST(ProcessMapperConfig, AProgramThatServesNoMappersIsToldSo) {
  MapperConfig config;
  config.choose("mrpt-rbpf");
  EXPECT_THROW(config.make(robot::RobotModel(), {}), InputError);
}

}  // namespace
}  // namespace rubble::slam
