// A port and its server, both ends of one line.
#include "robot/drivers/port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>
#include <vector>

#include "robot/drivers/descriptor.h"
#include "robot/drivers/host_clock.h"
#include "robot/emulators/port_server.h"
#include "tests/support/base_files.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Bytes bytes(const std::string& text) { return {text.begin(), text.end()}; }

/// Takes what the server gets until `size` bytes are there or a second has passed.
Bytes served(PortServer& server, std::size_t size) {
  Bytes all(size + 100);
  std::size_t got = 0;
  for (const Stamp end = host_now() + 1.0; got < size && host_now() < end;)
    got += server.read(all.data() + got, all.size() - got, 0.05).size;
  all.resize(got);
  return all;
}

Bytes received(Port& port, std::size_t size, PortServer* server = nullptr) {
  Bytes all(size + 100);
  std::size_t got = 0;
  for (const Stamp end = host_now() + 1.0; got < size && host_now() < end;) {
    if (server != nullptr) {
      std::uint8_t none;
      server->read(&none, 0, 0.0);  // sends on what waits
    }
    got += port.read(all.data() + got, all.size() - got, 0.02).size;
  }
  all.resize(got);
  return all;
}

class Line : public testing::TestWithParam<std::string> {
 protected:
  std::string word() const { return GetParam() == "tcp" ? "tcp:127.0.0.1:0" : "pty:" + folder_ / "line"; }
  test::TempFolder folder_;
};

TEST_P(Line, AllBytesPassUnchangedBothWays) {
  const auto server = serve_port(word());
  const auto port = open_port(server->name());
  Bytes all(256);
  std::iota(all.begin(), all.end(), std::uint8_t{0});  // among them CR, LF, ^C, ^Q, ^S, EOF
  port->write(all.data(), all.size(), host_now());
  EXPECT_EQ(served(*server, all.size()), all);
  EXPECT_TRUE(server->write(all.data(), all.size()));
  EXPECT_EQ(received(*port, all.size()), all);
  EXPECT_EQ(port->is_serial(), GetParam() == "pty");
  EXPECT_EQ(port->kind(), GetParam() == "pty" ? LineKind::Pty : LineKind::Tcp);
}

TEST_P(Line, NothingIsReadWhenNothingCame) {
  const auto server = serve_port(word());
  const auto port = open_port(server->name());
  std::uint8_t byte;
  EXPECT_EQ(port->read(&byte, 1, 0.001).size, 0u);
}

TEST_P(Line, AClientThatComesBackIsServedAgain) {
  const auto server = serve_port(word());
  for (int round = 0; round < 3; ++round) {
    const auto port = open_port(server->name());
    const Bytes hello = bytes("hello");
    port->write(hello.data(), hello.size(), host_now());
    EXPECT_EQ(served(*server, hello.size()), hello) << round;
  }
}

TEST_P(Line, PulledPlugIsLostDeviceAndItsReturnIsFound) {
  const auto server = serve_port(word());
  const std::string name = server->name();
  auto port = open_port(name);
  const Bytes hello = bytes("hello");
  port->write(hello.data(), hello.size(), host_now());
  served(*server, hello.size());
  server->unplug();
  std::uint8_t byte;
  EXPECT_THROW(port->read(&byte, 1, 0.5), DeviceLost);
  port.reset();  // as the drivers do: a line belongs to one
  EXPECT_THROW(open_port(name), DeviceLost);
  server->plug_in();
  EXPECT_EQ(server->name(), name);
  port = open_port(name);
  port->write(hello.data(), hello.size(), host_now());
  EXPECT_EQ(served(*server, hello.size()), hello);
}

TEST_P(Line, ABlockIsSentWholeOrNotAtAll) {
  const auto server = serve_port(word());
  const auto port = open_port(server->name());
  std::uint8_t none;
  server->read(&none, 1, 0.05);  // accepts
  const Bytes block(2137, 'x');
  std::size_t taken = 0;
  while (taken < 100000 && server->write(block.data(), block.size())) ++taken;
  ASSERT_GT(taken, 0u);
  ASSERT_LT(taken, 100000u) << "nobody reads, so at last a block must be refused";
  EXPECT_EQ(received(*port, taken * block.size(), server.get()).size(), taken * block.size());
}

TEST_P(Line, DescriptorIsReadableWhenBytesWait) {
  const auto server = serve_port(word());
  const auto port = open_port(server->name());
  const int before = server->descriptor();
  const Bytes hello = bytes("hello");
  port->write(hello.data(), hello.size(), host_now());
  EXPECT_EQ(served(*server, hello.size()), hello);
  EXPECT_EQ(server->descriptor(), before);
}

INSTANTIATE_TEST_SUITE_P(Both, Line, testing::Values("tcp", "pty"), [](const auto& info) { return info.param; });

TEST(TcpLine, ServerTellsThatAClientCameAndLeft) {
  const auto server = serve_port("tcp:127.0.0.1:0");
  std::uint8_t byte;
  auto port = open_port(server->name());
  EXPECT_TRUE(server->read(&byte, 1, 0.5).client_came);
  port.reset();
  EXPECT_TRUE(server->read(&byte, 1, 0.5).client_left);
  EXPECT_FALSE(server->write(&byte, 1));
}

std::string refusal(const std::string& word) {
  try {
    open_port(word);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// A client of another program: no lock of ours keeps it out.
class Stranger {
 public:
  explicit Stranger(const std::string& word) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(word.substr(word.rfind(':') + 1))));
    connected_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  bool connected() const { return connected_; }
  void say(const Bytes& what) const { ::send(socket_.get(), what.data(), what.size(), MSG_NOSIGNAL); }
  /// Whether the other side hangs up within so long.
  bool is_hung_up_on(double seconds) const {
    pollfd file{socket_.get(), POLLRDHUP, 0};
    return ::poll(&file, 1, static_cast<int>(1e3 * seconds)) > 0;
  }
  void hang_up() { socket_.close(); }

 private:
  Descriptor socket_;
  bool connected_ = false;
};

/// Who waits in a queue drives the robot on when the first one has stopped it.
TEST(TcpLine, ASecondClientIsHungUpOnAtOnceAndNeverHeard) {
  const auto server = serve_port("tcp:127.0.0.1:0");
  const auto first = open_port(server->name());
  std::uint8_t byte;
  ASSERT_TRUE(server->read(&byte, 1, 0.5).client_came);
  const Stranger second(server->name()), third(server->name());
  const Bytes hello = bytes("hello"), evil = bytes("drive");
  second.say(evil);
  first->write(hello.data(), hello.size(), host_now());
  EXPECT_EQ(served(*server, hello.size()), hello);
  EXPECT_TRUE(second.is_hung_up_on(2.0));
  EXPECT_TRUE(third.is_hung_up_on(2.0));
  first->write(hello.data(), hello.size(), host_now());
  EXPECT_EQ(served(*server, hello.size()), hello) << "the first one goes on";
}

TEST(TcpLine, WhoIsHungUpOnAtOnceIsToldThatTheDeviceIsInUse) {
  const auto server = serve_port("tcp:127.0.0.1:0");
  const Stranger first(server->name());
  std::uint8_t byte;
  ASSERT_TRUE(server->read(&byte, 1, 0.5).client_came);
  std::atomic<bool> ending{false};
  std::thread serving([&] {
    std::uint8_t none;
    while (!ending) server->read(&none, 0, 0.005);
  });
  const auto second = open_port(server->name());
  try {
    second->read(&byte, 1, 2.0);
    ADD_FAILURE() << "it is not hung up on";
  } catch (const TurnedAway& away) {
    EXPECT_THAT(away.what(), testing::HasSubstr("another program uses the device"));
    EXPECT_THAT(away.otherwise(), testing::HasSubstr("the device closed the line"));
  }
  ending = true;
  serving.join();
}

/// It lives and acknowledges that it has no room; it only loses what it does not take.
TEST(TcpLine, AClientThatDoesNotReadIsKept) {
  const auto server = serve_port("tcp:127.0.0.1:0");
  const Stranger lazy(server->name());
  std::uint8_t byte;
  ASSERT_TRUE(server->read(&byte, 1, 0.5).client_came);
  const Bytes block(2137, 'x');
  bool left = false, refused = false;
  for (const Stamp end = host_now() + 8.0; !left && host_now() < end;) {
    while (!refused && !left && host_now() < end) refused = !server->write(block.data(), block.size());
    server->write(block.data(), block.size());
    left = server->read(&byte, 1, 0.02).client_left;
  }
  EXPECT_TRUE(refused) << "the line was never full";
  EXPECT_FALSE(left);
  EXPECT_FALSE(lazy.is_hung_up_on(0.01));
}

/// A network of its own, whose only device can be switched off: as a cable that is cut.
TEST(TcpLine, WhoseCableIsCutMakesRoom) {
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWNET) != 0)
    GTEST_SKIP() << "no network of one's own may be made here";
  const auto link = [](bool up) {
    const Descriptor any(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    ifreq request{};
    std::strcpy(request.ifr_name, "lo");
    if (::ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return false;
    request.ifr_flags = static_cast<short>(up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
    return ::ioctl(any.get(), SIOCSIFFLAGS, &request) == 0;
  };
  ASSERT_TRUE(link(true));
  for (const bool sends : {true, false}) {
    SCOPED_TRACE(sends ? "while the device sends" : "while nothing is under way");
    const auto server = serve_port("tcp:127.0.0.1:0");
    Stranger lost(server->name());
    ASSERT_TRUE(lost.connected());
    std::uint8_t byte;
    ASSERT_TRUE(server->read(&byte, 1, 0.5).client_came);
    ASSERT_TRUE(link(false));
    bool left = false;
    for (const Stamp end = host_now() + 20.0; !left && host_now() < end;) {
      if (sends) server->write(&byte, 1);
      left = server->read(&byte, 1, 0.05).client_left;
    }
    EXPECT_TRUE(left) << "it keeps others out for good";
    ASSERT_TRUE(link(true));
    const Stranger next(server->name());
    EXPECT_TRUE(server->read(&byte, 1, 2.0).client_came);
  }
}

/// However much of what the first one said is still unread.
TEST(TcpLine, WhoComesBackAtOnceIsServed) {
  const auto server = serve_port("tcp:127.0.0.1:0");
  for (int round = 0; round < 20; ++round) {
    Stranger first(server->name());
    ASSERT_TRUE(first.connected());
    std::uint8_t byte;
    bool first_came = false;
    for (const Stamp end = host_now() + 2.0; !first_came && host_now() < end;)
      first_came = server->read(&byte, 1, 0.05).client_came;
    ASSERT_TRUE(first_came) << round;
    first.say(Bytes(5000, 'x'));
    first.hang_up();
    const Stranger again(server->name());
    Bytes some(1000);
    bool came = false;
    for (const Stamp end = host_now() + 2.0; !came && host_now() < end;)
      came = server->read(some.data(), some.size(), 0.05).client_came;
    EXPECT_TRUE(came) << round;
    EXPECT_FALSE(again.is_hung_up_on(0.01)) << round;
    const Bytes hello = bytes("hello");
    again.say(hello);
    EXPECT_EQ(served(*server, hello.size()), hello) << round;
  }
}

/// As of a serial line; and as soon as one has let go, the next may come.
TEST(TcpLine, BelongsToOneProgramOfThisComputer) {
  const auto server = serve_port("tcp:127.0.0.1:0");
  const std::string by_name = "tcp:localhost" + server->name().substr(server->name().rfind(':'));
  auto first = open_port(server->name());
  EXPECT_THROW(PortClaim(server->name()), PortBusy);
  EXPECT_THROW(open_port(server->name()), PortBusy);
  EXPECT_THROW(open_port(by_name), PortBusy) << "by its other name too";
  EXPECT_THAT(refusal(server->name()), testing::HasSubstr("another program uses it; end that first"));
  first.reset();
  EXPECT_NO_THROW(PortClaim(server->name()));
  EXPECT_NO_THROW(open_port(server->name()));
}

TEST_P(Line, AClaimKeepsTheLineWhileTheDeviceIsUnplugged) {
  const auto server = serve_port(word());
  const std::string other = GetParam() == "tcp" ? "tcp:127.0.0.1:9" : "pty:" + folder_ / "other";
  {
    const PortClaim claim(server->name());
    auto port = open_port(server->name());
    port.reset();
    EXPECT_THROW(PortClaim(server->name()), PortBusy) << "also while it is not open";
    server->unplug();
    EXPECT_THROW(PortClaim(server->name()), PortBusy) << "and while there is nothing to open";
    server->plug_in();
    EXPECT_NO_THROW(open_port(server->name()));
    PortClaim moved = PortClaim(other);
    const PortClaim kept = std::move(moved);
    EXPECT_THROW(PortClaim{other}, PortBusy) << "a claim may be handed on";
  }
  EXPECT_NO_THROW(PortClaim(server->name()));
}

TEST(PtyLine, LinkGoesWithTheServerAndReplacesAnOldOne) {
  const test::TempFolder folder;
  const std::string path = folder / "line";
  fs::create_symlink("/nowhere", path);
  auto server = serve_port("pty:" + path);
  EXPECT_TRUE(fs::is_character_file(path));
  server.reset();
  EXPECT_FALSE(fs::is_symlink(path));
}

TEST(PtyLine, FileOfThatNameIsLeftAlone) {
  const test::TempFolder folder;
  const std::string path = folder / "line";
  std::ofstream(path) << "precious";
  EXPECT_THROW(serve_port("pty:" + path), RunError);
  EXPECT_EQ(fs::file_size(path), 8u);
  EXPECT_THROW(open_port("pty:" + path), InputError) << "a file is no serial line";
}

TEST(PortWord, BadWordsSayWhatAndHowToMend) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "the path is missing"},       {"ttyUSB0", "is no port; give /dev/ttyUSB0"},
      {"tcp:", "host or port number"},   {"tcp:localhost", "host or port number"},
      {"tcp:h:70000", "no port number"}, {"tcp:h:1x", "no port number"},
      {"tcp:::1:80", "no host"},         {"pty:", "the path is missing"},
  };
  for (const auto& [word, text] : cases) {
    EXPECT_THROW(open_port(word), InputError) << word;
    EXPECT_THROW(serve_port(word), InputError) << word;
    EXPECT_THROW(check_port_word(word), InputError) << word;
    EXPECT_THAT(refusal(word), testing::HasSubstr(text));
    EXPECT_EQ(refusal(word).find('\n'), std::string::npos);
  }
}

TEST(PortWord, MissingDevicesAreLostNotBadInput) {
  EXPECT_THROW(open_port("/dev/no-such-line"), DeviceLost);
  EXPECT_THAT(refusal("/dev/no-such-line"), testing::HasSubstr("plug it in"));
  std::string name;
  {
    const auto server = serve_port("tcp:127.0.0.1:0");
    name = server->name();
  }
  EXPECT_THROW(open_port(name), DeviceLost);
  EXPECT_THAT(refusal(name), testing::HasSubstr("nobody answers"));
}

TEST(PortWord, ServersTakeNoSerialLines) { EXPECT_THROW(serve_port("/dev/ttyUSB0"), InputError); }

TEST(Port, UnknownBaudIsRefused) {
  const test::TempFolder folder;
  const auto server = serve_port("pty:" + folder / "line");
  const auto port = open_port(server->name());
  port->set_baud(19200);
  EXPECT_THROW(port->set_baud(12345), InputError);
}

/// Two programs on one line would take each other's bytes, and the second would drive on when the first stops.
TEST(Port, ALineBelongsToOneProgram) {
  const std::string path = testing::TempDir() + "rubble_port_of_one";
  const auto server = serve_port("pty:" + path);
  auto first = open_port(server->name());
  EXPECT_THROW(PortClaim(server->name()), PortBusy);
  EXPECT_THROW(open_port(server->name()), DeviceLost);
  EXPECT_THROW(open_port(path), DeviceLost) << "by its bare path too";
  first.reset();
  EXPECT_NO_THROW(PortClaim(server->name()));
  EXPECT_NO_THROW(open_port(server->name()));
}

}  // namespace
}  // namespace rubble::robot
