// What is read is never waited for, and never written over.
#include "base/text/input_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "base/error.h"
#include "base/text/text_file.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

class InputFileTest : public ::testing::Test {
 protected:
  InputFileTest() {
    std::string path = (fs::temp_directory_path() / "rubble-input-XXXXXX").string();
    folder_ = mkdtemp(path.data());
  }
  ~InputFileTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string made(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  /// What the one line says.
  static std::string refusal(const std::function<void()>& work) {
    try {
      work();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(InputFileTest, WhatIsReadIsNotWrittenByAnyOfItsNames) {
  const std::string file = made("in.yaml", "text");
  fs::create_hard_link(file, path("hard"));
  fs::create_symlink("in.yaml", path("soft"));
  EXPECT_EQ(read_text_file(file), "text");
  for (const std::string& name : {file, path("./in.yaml"), path("hard"), path("soft")})
    EXPECT_NE(refusal([&] { write_text_file(name, "new"); }).find("is what is read"), std::string::npos) << name;
  EXPECT_EQ(read_text_file(file), "text");
  EXPECT_TRUE(was_read(file));
}

TEST_F(InputFileTest, WhatWasWrittenHereMayBeReadAndWrittenAgain) {
  for (const std::string text : {"one", "two", "three"}) {
    write_text_file(path("own"), text);
    EXPECT_EQ(read_text_file(path("own")), text);
  }
}

/// A file system gives the number of a deleted file to the next one.
TEST_F(InputFileTest, AFileWithTheNumberOfADeletedInputIsAnotherFile) {
  struct stat old {
  }, now{};
  int same = 0;
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(stat(made("a", "old").c_str(), &old), 0);
    read_text_file(path("a"));
    fs::remove(path("a"));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // a tick of the file system's clock
    ASSERT_EQ(stat(made("b", "new").c_str(), &now), 0);
    same += old.st_ino == now.st_ino;
    struct statx s {};
    statx(AT_FDCWD, path("b").c_str(), 0, STATX_BTIME, &s);
    if ((s.stx_mask & STATX_BTIME) == 0) GTEST_SKIP() << "this file system knows no time of birth";
    EXPECT_FALSE(was_read(path("b")));
    fs::remove(path("b"));
  }
  RecordProperty("numbers used again", same);
}

TEST_F(InputFileTest, PipesDevicesSocketsAndFoldersAreToldAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", path("zero"));
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path("socket").c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_NE(refusal([&] { read_input(path("pipe")); }).find("is a pipe"), std::string::npos);
  EXPECT_NE(refusal([&] { read_input(path("zero")); }).find("is a device"), std::string::npos);
  EXPECT_NE(refusal([&] { read_input(path("socket")); }).find("is a socket"), std::string::npos);
  EXPECT_NE(refusal([&] { read_input(path(".")); }).find("is a folder"), std::string::npos);
  EXPECT_NE(refusal([&] { read_input(path("none")); }).find("cannot be opened"), std::string::npos);
  EXPECT_THROW(write_text_file(path("pipe"), "nobody reads this"), RunError);
  close(socket);
}

TEST_F(InputFileTest, ATypedPipeIsRead) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "abc", 3), 3);
  close(ends[1]);
  const std::string name = "/dev/fd/" + std::to_string(ends[0]);
  EXPECT_NE(refusal([&] { read_input(name, image_rules()); }).find("is a pipe"), std::string::npos);
  EXPECT_EQ(read_input(name), "abc");
  close(ends[0]);
}

TEST_F(InputFileTest, ASignalEndsTheWaitForAPipe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  struct sigaction quiet {
  }, before{};
  quiet.sa_handler = [](int) {};
  quiet.sa_flags = SA_RESTART;  // as std::signal() sets it
  sigaction(SIGUSR1, &quiet, &before);
  const pthread_t reader = pthread_self();
  std::thread killer([&] {
    for (int i = 0; i < 20; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      pthread_kill(reader, SIGUSR1);
    }
  });
  InputRules rules;
  rules.pipes = Pipes::Named;
  EXPECT_THROW(read_input(path("pipe"), rules), Interrupted);
  killer.join();
  sigaction(SIGUSR1, &before, nullptr);
}

TEST_F(InputFileTest, MoreThanTheRulesAllowIsNotRead) {
  InputRules rules;
  rules.most = 1u << 20;
  const std::string file = made("large", std::string((1u << 20) + 1, 'x'));
  EXPECT_NE(refusal([&] { read_input(file, rules); }).find("is over 1 MB"), std::string::npos);
}

TEST_F(InputFileTest, ANameOfOurOwnFollowsNoLink) {
  made("victim", "mine");
  fs::create_symlink("victim", path("score.json"));
  EXPECT_NE(refusal([&] { place_in(folder_.string(), "score.json"); }).find("is a symbolic link"), std::string::npos);
  EXPECT_EQ(place_in(folder_.string(), "other.json"), path("other.json"));
}

}  // namespace
}  // namespace rubble
