// The threads between devices and their lines: what they send, when, and at which bit rate.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "robot/drivers/black_box.h"
#include "robot/drivers/device_thread.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/port.h"
#include "robot/emulators/device_server.h"
#include "robot/emulators/port_server.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

/// Says forty bytes ten times a second.
class Speaker : public EmulatedDevice {
 public:
  void client_came(Stamp now) override { next_ = now; }
  void client_left(Stamp /*now*/) override { next_ = Stamp::never(); }
  void receive(std::string_view /*bytes*/, Stamp /*now*/) override {}
  void advance(Stamp now) override {
    if (next_ == Stamp::never() || now < next_) return;
    next_ = next_ + 0.1;
    output_ += std::string(39, 'x') + "\n";
  }
  std::string take_output() override { return std::exchange(output_, ""); }

 private:
  Stamp next_ = Stamp::never();
  std::string output_;
};

TEST(DeviceServer, PiecesOfASplitReplyLeaveApart) {
  Speaker speaker;
  DeviceServer server("tcp:127.0.0.1:0", speaker, 1);
  const auto port = open_port(server.port());
  server.spoil(ByteFault::Split, 30.0);
  std::string all;
  int apart = 0;
  const Stamp end = host_now() + 2.0;
  for (Stamp last = Stamp::never(); host_now() < end;) {
    std::array<std::uint8_t, 256> bytes;
    const auto [size, now] = port->read(bytes.data(), bytes.size(), 0.02);
    if (size == 0) continue;
    const bool within = !all.empty() && all.back() != '\n';
    if (within && now - last > 0.5 * kSplitPause) ++apart;
    all.append(reinterpret_cast<const char*>(bytes.data()), size);
    last = now;
  }
  EXPECT_GE(apart, 5) << "of two cuts in each of twenty replies";
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i % 40 == 39 ? '\n' : 'x') << "nothing is lost";
}

/// Goes to another bit rate with each of its questions, which name the rate they are meant for.
class Searcher : public Device {
 public:
  void opened(Stamp now, LineKind /*line*/) override {
    next_ = now;
    rate_ = 0;
  }
  void receive(std::string_view /*bytes*/, Stamp /*now*/) override {}
  void advance(Stamp now) override {
    if (now < next_) return;
    next_ = next_ + 0.03;
    ++rate_;
    output_ = std::to_string(baud());
  }
  std::string take_output(Stamp /*now*/) override { return std::exchange(output_, ""); }
  Stamp deadline() const override { return next_; }
  int baud() const override { return std::array<int, 3>{9600, 38400, 115200}[rate_ % 3]; }
  bool ready() const override { return false; }
  Stamp last_report() const override { return Stamp::never(); }
  std::string state() const override { return "searches"; }

 private:
  Stamp next_ = Stamp::never();
  std::size_t rate_ = 0;
  std::string output_;
};

TEST(DeviceThread, AQuestionGoesOutAtTheBitRateItIsMeantFor) {
  std::string folder = (fs::temp_directory_path() / "linesXXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const auto server = serve_port("pty:" + folder + "/line");
  {
    BlackBox box(folder + "/bytes");
    Searcher searcher;
    DeviceThread thread("base", server->name(), searcher, &box);
    sleep_until(host_now() + 0.7);
  }
  std::string rate;
  int questions = 0;
  Stamp turned = Stamp::never();
  for (const BlackBoxEntry& entry : read_black_box(folder + "/bytes")) {
    if (entry.direction == Direction::BitRate) rate = entry.bytes;
    if (entry.direction == Direction::Turn) turned = entry.stamp;
    if (entry.direction != Direction::ToDevice) continue;
    EXPECT_EQ(entry.bytes, rate) << "question " << questions;
    EXPECT_EQ(entry.stamp.ns, turned.ns) << "the turn in which it was due stands before it";
    ++questions;
  }
  EXPECT_GE(questions, 4);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace rubble::robot
