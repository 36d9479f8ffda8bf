// Our driver against the emulated scanner over real lines, in real time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <vector>

#include "base/error.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/scip/scip_scanner.h"
#include "robot/drivers/scip/scip_text.h"
#include "robot/emulators/port_server.h"
#include "robot/emulators/scip/urg_emulator.h"
#include "tests/support/machine_witness.h"
#include "tests/support/robot_turning_scene.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

constexpr double kThreads = 4.0;  ///< so many talk in turn, and each may be held up by the machine
constexpr double kStalled = 0.1;  ///< held up so long a driver may have to begin anew [s]

/// Waits until `done` or the time is over; the machine's own stalls, as a sleeper beside has them, are not counted.
bool wait_for(const std::function<bool()>& done, double timeout) {
  const Witness machine;
  for (const Stamp begun = host_now(); host_now() - begun - kThreads * machine.total() < timeout;
       sleep_until(host_now() + 0.005))
    if (done()) return true;
  return done();
}

struct Bench {
  explicit Bench(const std::string& kind, UrgEmulatorConfig config = {}) {
    std::string name = (fs::temp_directory_path() / "urgXXXXXX").string();
    folder = ::mkdtemp(name.data());
    config.port = kind == "tcp" ? "tcp:127.0.0.1:0" : "pty:" + (folder / "urg").string();
    emulator = std::make_unique<UrgEmulator>(config);
    scene = std::make_unique<TurningScene>(config.laser, [this](const LaserScan& scan) { emulator->publish(scan); });
  }
  ~Bench() {
    scanner.reset();
    scene.reset();
    emulator.reset();
    fs::remove_all(folder);
  }

  void connect(ScipScannerConfig config = {}) {
    config.port = emulator->port();
    config.retry = 0.1;
    scanner = std::make_unique<ScipScanner>(config);
  }
  /// Takes scans until there are `count` more.
  bool more(std::size_t count, double timeout = 2.5) {
    const std::size_t wanted = scans.size() + count;
    return wait_for(
        [&] {
          for (LaserScan& scan : scanner->take()) scans.push_back(std::move(scan));
          return scans.size() >= wanted;
        },
        timeout);
  }

  fs::path folder;
  std::unique_ptr<UrgEmulator> emulator;
  std::unique_ptr<TurningScene> scene;
  std::unique_ptr<ScipScanner> scanner;
  std::vector<LaserScan> scans;
};

/// Every beam of the scan is what was published under its number, and so is its stamp.
void expect_true(const Bench& bench, const LaserScan& scan, double stamp_tolerance) {
  const int number = number_of(scan);
  const LaserScan truth = numbered_scan({}, number, Stamp{});
  ASSERT_EQ(scan.ranges.size(), truth.ranges.size());
  ASSERT_EQ(scan.codes.size(), truth.ranges.size());
  for (std::size_t i = 0; i < truth.ranges.size(); ++i) {
    EXPECT_NEAR(scan.bearing(i), truth.bearing(i), 1e-12);
    if (i == 200) {
      EXPECT_TRUE(std::isnan(scan.ranges[i])) << i;
    } else {
      EXPECT_EQ(scan.ranges[i], truth.ranges[i]) << i;
    }
    EXPECT_EQ(scan.codes[i], i == 200 ? 7 : 0) << i;
  }
  EXPECT_NEAR(scan.stamp - bench.scene->stamp(number), 0.0, stamp_tolerance) << number;
}

/// A port that does what another one does; who is derived from it changes some of that.
class PortAround : public Port {
 public:
  explicit PortAround(std::unique_ptr<Port> inner) : inner_(std::move(inner)) {}
  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override { return inner_->read(to, size, timeout); }
  void write(const std::uint8_t* from, std::size_t size, Stamp now) override { inner_->write(from, size, now); }
  int descriptor() const override { return inner_->descriptor(); }
  const std::string& name() const override { return inner_->name(); }
  void set_baud(int baud) override { inner_->set_baud(baud); }
  LineKind kind() const override { return inner_->kind(); }
  Stamp opened() const override { return inner_->opened(); }

 protected:
  std::unique_ptr<Port> inner_;
};

/// A pty behind which an UART is said to be: what is written takes its time, what is read does by the emulator.
class Uart : public PortAround {
 public:
  Uart(std::unique_ptr<Port> inner, int baud) : PortAround(std::move(inner)), baud_(baud) {}
  void write(const std::uint8_t* from, std::size_t size, Stamp now) override {
    sleep_until(host_now() + 10.0 * static_cast<double>(size) / baud_);
    inner_->write(from, size, now);
  }
  LineKind kind() const override { return LineKind::Uart; }

 private:
  int baud_;
};

/// A scanner that is heard at 19200 baud only, and has no other rate.
class OneRate : public PortAround {
 public:
  explicit OneRate(std::unique_ptr<Port> inner) : PortAround(std::move(inner)) {}
  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override {
    const Arrival arrival = inner_->read(to, size, timeout);
    for (std::size_t i = 0; i + 8 <= arrival.size; ++i)
      if (std::memcmp(to + i, "SS038400", 8) == 0) std::memcpy(to + i, "SS115200", 8);
    return arrival;
  }
  void write(const std::uint8_t* from, std::size_t size, Stamp now) override {
    if (baud_ != 19200) return;
    std::string bytes(reinterpret_cast<const char*>(from), size);
    // The emulated scanner refuses 38400 baud (04) where this one refuses 115200.
    if (const auto at = bytes.find("SS115200"); at != std::string::npos) bytes.replace(at, 8, "SS038400");
    inner_->write(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), now);
  }
  void set_baud(int baud) override { baud_ = baud; }

 private:
  int baud_ = 9600;
};

TEST(UrgOnAnUart, ABitRateThatIsRefusedIsNotTaken) {
  Bench bench("pty");
  ScipScannerConfig config;
  config.open = [&](const std::string& word) { return std::make_unique<OneRate>(open_port(word)); };
  bench.connect(config);
  ASSERT_TRUE(bench.more(3, 6.0)) << bench.scanner->status().error;
  EXPECT_EQ(bench.scanner->status().connects, 1u);
}

/// A scan of 2137 bytes takes 185 ms at 115200 baud: some turns are left out, but none is stamped with its way.
TEST(UrgOnAnUart, StampsAreRightWithinTheirDoubt) {
  constexpr int kBaud = 115200;
  UrgEmulatorConfig slow;
  slow.baud = kBaud;
  Bench bench("pty", slow);
  ScipScannerConfig config;
  config.open = [&](const std::string& word) { return std::make_unique<Uart>(open_port(word), kBaud); };
  bench.connect(config);
  ASSERT_TRUE(bench.more(12, 10.0)) << bench.scanner->status().error;
  const ScannerStatus status = bench.scanner->status();
  std::vector<double> errors;
  for (const LaserScan& scan : bench.scans) errors.push_back(scan.stamp - bench.scene->stamp(number_of(scan)));
  std::sort(errors.begin(), errors.end());
  const double median = errors[errors.size() / 2];
  std::cout << "UART: median stamp error " << 1e3 * median << " ms, doubt " << 1e3 * status.clock_doubt << " ms, "
            << status.missed << " turns missed\n";
  constexpr double kResolution = 0.001, kDrift = 300e-6 * 5.0;  // of the device's clock, and of a few points' slope
  EXPECT_LE(std::abs(median), status.clock_doubt + kResolution + kDrift);
  EXPECT_EQ(status.damaged, 0u);
  EXPECT_GT(bench.emulator->status().dropped, 0u);
}

/// A line, as a radio or a relay, that hands over what the scanner says so much later; with `bundle` it hands over what
/// has gathered only once in so long.
class SlowLine : public PortAround {
 public:
  SlowLine(std::unique_ptr<Port> inner, double delay, double bundle)
      : PortAround(std::move(inner)), delay_(delay), bundle_(bundle) {}
  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override {
    const Stamp end = host_now() + timeout;
    for (;;) {
      const Stamp now = host_now();
      if (!waiting_.empty() && waiting_.front().first <= now) {
        std::size_t got = 0;
        for (; got < size && !waiting_.empty() && waiting_.front().first <= now; ++got, waiting_.pop_front())
          to[got] = waiting_.front().second;
        return {got, now};
      }
      if (now >= end && asked_inner_) return {0, now};
      const Stamp until = waiting_.empty() ? end : std::min(end, waiting_.front().first);
      std::array<std::uint8_t, 4096> bytes;
      const Arrival arrival = inner_->read(bytes.data(), bytes.size(), std::max(0.0, until - now));
      asked_inner_ = true;
      Stamp due = arrival.stamp + delay_;
      if (bundle_ > 0.0) due = start_ + bundle_ * std::ceil((due - start_) / bundle_);
      for (std::size_t i = 0; i < arrival.size; ++i) waiting_.emplace_back(due, bytes[i]);
    }
  }

 private:
  double delay_, bundle_;
  Stamp start_ = host_now();
  std::deque<std::pair<Stamp, std::uint8_t>> waiting_;
  bool asked_inner_ = false;
};

/// A scanner that works, behind a line that does not: the line is named, with what it was late by.
TEST(UrgOnASlowLine, IsSaidToAnswerTooLateNotToBeBroken) {
  struct Line {
    double delay, bundle;
  };
  for (const Line line : {Line{0.4, 0.0}, Line{0.55, 0.0}, Line{0.9, 0.0}, Line{0.35, 0.2}}) {
    SCOPED_TRACE(std::to_string(line.delay) + " s, bundles of " + std::to_string(line.bundle) + " s");
    Bench bench("tcp");
    ScipScannerConfig config;
    config.open = [&](const std::string& word) {
      return std::make_unique<SlowLine>(open_port(word), line.delay, line.bundle);
    };
    const Stamp begun = host_now();
    const Witness machine;
    bench.connect(config);
    ASSERT_TRUE(wait_for([&] { return !bench.scanner->status().error.empty(); }, 20.0));
    const double all = host_now() - begun;
    const std::string error = bench.scanner->status().error;
    EXPECT_THAT(error, testing::HasSubstr("answers too late"));
    const auto at = error.find("too late, ");
    ASSERT_NE(at, std::string::npos);
    const double told = std::strtod(error.c_str() + at + 10, nullptr);
    EXPECT_GE(told, 0.3) << error;
    EXPECT_GE(told, line.delay - 0.36) << error << "; of a question that was repeated the last one counts";
    EXPECT_LE(told, all + 0.05) << error;
    // It is told to 0.1 s, and a busy machine adds what it likes.
    EXPECT_LE(told, line.delay + line.bundle + 0.1 + 2.0 * machine.worst()) << error;
    EXPECT_EQ(bench.scanner->status().connects, 0u);
  }
}

/// One that only takes a while is put up with, and the scans' age is told.
TEST(UrgOnASlowLine, ALineThatIsSlowButInTimeIsUsed) {
  Bench bench("tcp");
  ScipScannerConfig config;
  config.open = [](const std::string& word) { return std::make_unique<SlowLine>(open_port(word), 0.15, 0.0); };
  bench.connect(config);
  ASSERT_TRUE(bench.more(5, 15.0)) << bench.scanner->status().error;
  EXPECT_GE(bench.scanner->status().worst_latency, 0.07) << "half of the way there and back is charged to either";
}

class UrgWire : public testing::TestWithParam<std::string> {};

TEST_P(UrgWire, EveryBeamCodeAndStampArrives) {
  Bench bench(GetParam());
  bench.connect();
  ASSERT_TRUE(bench.more(8)) << bench.scanner->status().error;
  for (std::size_t i = 0; i < bench.scans.size(); ++i) {
    expect_true(bench, bench.scans[i], 0.002);
    if (i > 0) {
      EXPECT_EQ(number_of(bench.scans[i]), number_of(bench.scans[i - 1]) + 1);
    }
  }
  const ScannerInfo info = bench.scanner->info();
  EXPECT_EQ(info.protocol, "SCIP 2.0");
  EXPECT_THAT(info.model, testing::HasSubstr("URG-04LX"));
  EXPECT_EQ(info.laser.beams, 682);
  EXPECT_EQ(info.lines.size(), 13u);
  const ScannerStatus status = bench.scanner->status();
  EXPECT_TRUE(status.connected);
  EXPECT_EQ(status.damaged, 0u);
  EXPECT_EQ(status.connects, 1u);
  EXPECT_GT(status.clock_doubt, 0.0);
  EXPECT_LT(status.clock_doubt, 0.005);
}

TEST_P(UrgWire, OldProtocolGivesTheSameBeams) {
  Bench bench(GetParam());
  ScipScannerConfig config;
  config.only_scip1 = true;
  bench.connect(config);
  ASSERT_TRUE(bench.more(5)) << bench.scanner->status().error;
  EXPECT_EQ(bench.scanner->info().protocol, "SCIP 1.1");
  for (const LaserScan& scan : bench.scans) expect_true(bench, scan, 0.2);
  for (std::size_t i = 1; i < bench.scans.size(); ++i) EXPECT_GT(bench.scans[i].stamp, bench.scans[i - 1].stamp);
}

/// In SCIP 1.1 each turn has to be asked for, but a turn that came does not wait for the next question.
TEST_P(UrgWire, OldProtocolHandsATurnOverAtOnce) {
  std::atomic<std::int64_t> sent{0};
  UrgEmulatorConfig emulated;
  emulated.scan_sent = [&](Stamp when) { sent = when.ns; };
  Bench bench(GetParam(), emulated);
  ScipScannerConfig config;
  config.only_scip1 = true;
  bench.connect(config);
  // The machine's own delays are in it, so it is measured again: the wait that must not be there is 85 ms in each turn.
  double median = std::numeric_limits<double>::infinity();
  for (int tries = 0; tries < 4 && !(median < 0.03); ++tries) {
    std::vector<double> delays;
    for (int i = 0; i < 15; ++i) {
      ASSERT_TRUE(bench.more(1)) << bench.scanner->status().error;
      delays.push_back(bench.scanner->status().last_scan - Stamp{sent});
    }
    std::sort(delays.begin(), delays.end());
    median = delays[delays.size() / 2];
  }
  EXPECT_LT(median, 0.03);
}

/// Swallows whole replies, as many as it is told to.
class Lossy : public PortAround {
 public:
  Lossy(std::unique_ptr<Port> inner, std::atomic<int>& lose) : PortAround(std::move(inner)), lose_(lose) {}
  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override {
    Arrival arrival = inner_->read(to, size, timeout);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < arrival.size; ++i) {
      const bool ends = to[i] == '\n' && last_ == '\n';
      last_ = to[i];
      if (lose_ == 0) {
        to[kept++] = to[i];
      } else if (ends) {
        --lose_;
      }
    }
    arrival.size = kept;
    return arrival;
  }

 private:
  std::atomic<int>& lose_;
  std::uint8_t last_ = 0;
};

/// Hands over whole replies, each as `edit` has it.
class Edited : public PortAround {
 public:
  Edited(std::unique_ptr<Port> inner, std::function<std::string(const std::string&)> edit)
      : PortAround(std::move(inner)), edit_(std::move(edit)) {}
  Arrival read(std::uint8_t* to, std::size_t size, double timeout) override {
    const Stamp end = host_now() + timeout;
    for (;;) {
      Arrival arrival = inner_->read(to, size, ready_.empty() ? std::max(0.0, end - host_now()) : 0.0);
      waiting_.append(reinterpret_cast<const char*>(to), arrival.size);
      for (std::size_t at; (at = waiting_.find("\n\n")) != std::string::npos; waiting_.erase(0, at + 2))
        ready_ += edit_(waiting_.substr(0, at + 2));
      if (ready_.empty() && arrival.size > 0 && host_now() < end) continue;
      arrival.size = ready_.copy(reinterpret_cast<char*>(to), size);
      ready_.erase(0, arrival.size);
      return arrival;
    }
  }

 private:
  std::function<std::string(const std::string&)> edit_;
  std::string waiting_, ready_;
};

/// Without the scanner's clock its stamps are guessed from arrivals: what a spoilt line loses is asked for again.
class AskedForItsClock : public testing::Test {
 protected:
  /// Of replies that begin with `echo` the first `many` come as `as`; at least `least` of them.
  void connect(const std::string& echo, int many, int least, const std::function<std::string(std::string)>& as) {
    ScipScannerConfig config;
    config.open = [=](const std::string& word) {
      return std::make_unique<Edited>(open_port(word), [=](const std::string& reply) {
        const bool met = reply.rfind(echo, 0) == 0 && met_.fetch_add(1) < many;
        return met ? as(reply) : reply;
      });
    };
    bench_.connect(config);
    ASSERT_TRUE(bench_.more(8, 15.0)) << bench_.scanner->status().error;
    EXPECT_GE(met_, least) << "the line was not spoilt";
  }
  static std::string lost(const std::string&) { return ""; }
  static std::string spoilt(std::string reply) {
    reply[reply.size() - 3] ^= 1;  // the sum of its last line
    return reply;
  }
  void expect_known_clock() {
    EXPECT_GT(bench_.scanner->status().clock_doubt, 0.0);
    for (const LaserScan& scan : bench_.scans) expect_true(bench_, scan, 0.002);
  }

  std::atomic<int> met_{0}, versions_{0};  // its threads use them: they must outlive it
  Bench bench_{"tcp"};
};

TEST_F(AskedForItsClock, AFirstAnswerThatIsLostIsAskedForAgain) {
  connect("TM0", 1, 2, lost);
  expect_known_clock();
}

TEST_F(AskedForItsClock, SpoiltTimesAreAskedForAgain) {
  connect("TM1", 2, 10, spoilt);
  expect_known_clock();
}

TEST_F(AskedForItsClock, LostTimesAreAskedForAgain) {
  connect("TM1", 1, 10, lost);
  expect_known_clock();
}

/// An old firmware does not know the question.
TEST_F(AskedForItsClock, AScannerThatNeverAnswersThatIsUsedAllTheSame) { connect("TM0", 1000, 2, lost); }

/// It goes on with the usual delay, at the first attempt.
TEST_F(AskedForItsClock, AScannerWhoseTimesNeverComeIsUsedAllTheSame) {
  connect("TM1", 1000, 3, lost);
  EXPECT_EQ(bench_.scanner->status().connects, 1u);
  EXPECT_EQ(bench_.scanner->status().clock_doubt, 0.0);
}

TEST_F(AskedForItsClock, AScannerThatSumsItsTimesOtherwiseIsUsedAllTheSame) {
  connect("TM1", 1000, 3, spoilt);
  EXPECT_EQ(bench_.scanner->status().connects, 1u);
  EXPECT_EQ(bench_.scanner->status().clock_doubt, 0.0);
}

/// Here it is the line: a version whose sum is wrong, then three times. Connected anew the clock is known.
TEST_F(AskedForItsClock, ASpoiltLineIsTriedAnew) {
  ScipScannerConfig config;
  config.open = [this](const std::string& word) {
    return std::make_unique<Edited>(open_port(word), [this](const std::string& reply) {
      const bool first = reply.rfind("VV", 0) == 0 && versions_.fetch_add(1) < 1;
      const bool time = reply.rfind("TM1", 0) == 0 && met_.fetch_add(1) < 3;
      return first || time ? spoilt(reply) : reply;
    });
  };
  bench_.connect(config);
  ASSERT_TRUE(bench_.more(8, 15.0)) << bench_.scanner->status().error;
  EXPECT_GT(met_, 3);
  EXPECT_GE(versions_, 3) << "it was not connected anew";
  expect_known_clock();
}

/// In SCIP 1.1 an answer that is lost was the only one on its way.
TEST_P(UrgWire, OldProtocolAsksAgainForATurnThatGotLost) {
  std::atomic<int> lose{0};
  Bench bench(GetParam());
  ScipScannerConfig config;
  config.only_scip1 = true;
  config.silence = 2.0;  // a busy machine shall not decide
  config.open = [&](const std::string& word) { return std::make_unique<Lossy>(open_port(word), lose); };
  bench.connect(config);
  ASSERT_TRUE(bench.more(5)) << bench.scanner->status().error;
  for (int i = 0; i < 3; ++i) {
    lose = 1;
    ASSERT_TRUE(bench.more(4)) << bench.scanner->status().error;
    EXPECT_EQ(lose, 0) << "a reply was lost";
  }
  EXPECT_EQ(bench.scanner->status().connects, 1u) << "the device was started anew for it";
  for (std::size_t i = 1; i < bench.scans.size(); ++i) EXPECT_GT(bench.scans[i].stamp, bench.scans[i - 1].stamp);
}

/// In real time and after four seconds, when the lower envelope has met few of the least delays: 0.45 to 0.72 ms in the
/// mean were seen. What is promised for a minute (0.5 ms in the mean, 1.5 ms of 99 %) is ClockWire's. A machine that is
/// busy elsewhere is measured beside it and gets three attempts.
TEST_P(UrgWire, StampsAreRightThoughTheLineJittersAndTheClockDrifts) {
  constexpr double kMean = 1e-3, kMost = 2e-3, kBusy = 1e-3;  // [s]
  double mean = 0.0, most = 0.0, late = 0.0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    UrgEmulatorConfig emulated;
    emulated.jitter = 0.005;
    emulated.clock_drift = 50e-6;
    Bench bench(GetParam(), emulated);
    Witness witness;
    bench.connect();
    ASSERT_TRUE(bench.more(40, 15.0)) << bench.scanner->status().error;
    witness.end();
    late = witness.lateness(0.99);
    std::vector<double> errors;
    mean = 0.0;
    for (const LaserScan& scan : bench.scans) {
      const double error = scan.stamp - bench.scene->stamp(number_of(scan));
      mean += error / static_cast<double>(bench.scans.size());
      errors.push_back(std::abs(error));
    }
    std::sort(errors.begin(), errors.end());
    most = errors[static_cast<std::size_t>(0.99 * static_cast<double>(errors.size() - 1))];
    std::cout << "stamps off by " << 1e3 * mean << " ms in the mean, " << 1e3 * most << " ms (99 %); sleepers late by "
              << 1e3 * late << " ms (99 %)\n";
    for (const LaserScan& scan : bench.scans) expect_true(bench, scan, 0.004);
    if (std::abs(mean) <= kMean && most <= kMost) return;
  }
  if (late > kBusy) GTEST_SKIP() << "the machine itself is late by " << 1e3 * late << " ms";
  EXPECT_LE(std::abs(mean), kMean);
  EXPECT_LE(most, kMost);
}

TEST_P(UrgWire, RangesBeyondTheLimitAreMissesAndNoEchoIsWhatTheUserSays) {
  Bench bench(GetParam());
  ScipScannerConfig config;
  config.no_echo_is_miss = false;
  config.range_max = 2.0;
  bench.connect(config);
  ASSERT_TRUE(bench.more(1));
  EXPECT_TRUE(std::isnan(bench.scans[0].ranges[100]));
  EXPECT_TRUE(std::isnan(bench.scans[0].ranges[200]));
  EXPECT_TRUE(std::isinf(bench.scans[0].ranges[600])) << "2.3 m is beyond 2 m";
}

TEST_P(UrgWire, ClockWrapsUnnoticed) {
  UrgEmulatorConfig config;
  config.clock_start = (1u << 24) - 900;
  Bench bench(GetParam(), config);
  bench.connect();
  ASSERT_TRUE(bench.more(15));
  for (const LaserScan& scan : bench.scans) expect_true(bench, scan, 0.002);
  EXPECT_EQ(bench.scanner->status().missed, 0u);
}

TEST_P(UrgWire, UnpluggedScannerIsNamedAndFoundAgain) {
  Bench bench(GetParam());
  bench.connect();
  ASSERT_TRUE(bench.more(2));
  const Witness machine;
  bench.emulator->unplug(0.4);
  ASSERT_TRUE(wait_for([&] { return !bench.scanner->status().connected; }, 1.0));
  EXPECT_THAT(bench.scanner->status().error, testing::HasSubstr(bench.emulator->port()));
  bench.scanner->take();
  ASSERT_TRUE(bench.more(4, 2.0)) << bench.scanner->status().error;
  expect_true(bench, bench.scans.back(), 0.002);
  EXPECT_GE(bench.scanner->status().connects, 2u);
  if (machine.worst() < kStalled) {
    EXPECT_EQ(bench.scanner->status().connects, 2u);
  }
}

TEST_P(UrgWire, RestartedScannerIsSwitchedToTheNewProtocolAgain) {
  Bench bench(GetParam());
  bench.connect();
  ASSERT_TRUE(bench.more(2));
  bench.emulator->cycle_power();
  ASSERT_TRUE(wait_for([&] { return bench.scanner->status().connects == 2; }, 10.0)) << bench.scanner->status().error;
  bench.scanner->take();
  ASSERT_TRUE(bench.more(3));
  expect_true(bench, bench.scans.back(), 0.002);
  EXPECT_EQ(bench.scanner->info().protocol, "SCIP 2.0");
}

TEST_P(UrgWire, SilentScannerIsReportedAndScansComeBack) {
  Bench bench(GetParam());
  bench.connect();
  ASSERT_TRUE(bench.more(2));
  bench.emulator->fall_silent(1.0);
  ASSERT_TRUE(wait_for([&] { return !bench.scanner->status().connected; }, 1.0));
  EXPECT_THAT(bench.scanner->status().error, testing::HasSubstr("silent"));
  bench.scanner->take();
  ASSERT_TRUE(bench.more(3, 2.5)) << bench.scanner->status().error;
  expect_true(bench, bench.scans.back(), 0.002);
}

INSTANTIATE_TEST_SUITE_P(Both, UrgWire, testing::Values("tcp", "pty"), [](const auto& info) { return info.param; });

using Spoilt = std::tuple<std::string, ByteFault>;
class SpoiltWire : public testing::TestWithParam<Spoilt> {};

TEST_P(SpoiltWire, NoWrongScanPassesAndGoodOnesComeBack) {
  const auto& [kind, fault] = GetParam();
  Bench bench(kind);
  bench.connect();
  ASSERT_TRUE(bench.more(2));
  bench.emulator->spoil(fault, 1.0);
  sleep_until(host_now() + 1.05);
  ASSERT_TRUE(bench.more(4, 1.5)) << bench.scanner->status().error;
  // The sums have six bits a line, the lengths are known: what got through is true, beam by beam.
  for (const LaserScan& scan : bench.scans) expect_true(bench, scan, 0.002);
  const ScannerStatus status = bench.scanner->status();
  if (fault == ByteFault::Split) {
    EXPECT_EQ(status.damaged, 0u);
    EXPECT_EQ(status.missed, 0u);
  } else {
    EXPECT_GT(status.damaged + status.missed, 0u);
  }
}

std::string spoilt_name(const testing::TestParamInfo<Spoilt>& info) {
  static const std::vector<std::string> names = {"None", "Lost", "Split", "Doubled", "Junk", "WrongSum"};
  return std::get<0>(info.param) + names[static_cast<std::size_t>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(All, SpoiltWire,
                         testing::Combine(testing::Values("tcp", "pty"),
                                          testing::Values(ByteFault::Lost, ByteFault::Split, ByteFault::Doubled,
                                                          ByteFault::Junk, ByteFault::WrongSum)),
                         spoilt_name);

TEST(UrgEmulator, ScannerThatIsNotThereIsAStatusNotAnException) {
  ScipScannerConfig config;
  config.port = "/dev/no-such-scanner";
  ScipScanner scanner(config);
  ASSERT_TRUE(wait_for([&] { return !scanner.status().error.empty(); }, 1.0));
  EXPECT_THAT(scanner.status().error, testing::HasSubstr("/dev/no-such-scanner: there is no such device"));
  config.port = "nonsense";
  EXPECT_THROW(ScipScanner{config}, InputError);
}

TEST(UrgEmulator, ADeviceThatIsNoScannerIsNamed) {
  const auto server = serve_port("tcp:127.0.0.1:0");  // accepts and says nothing
  ScipScannerConfig config;
  config.port = server->name();
  ScipScanner scanner(config);
  ASSERT_TRUE(wait_for([&] { return !scanner.status().error.empty(); }, 5.0));
  EXPECT_THAT(scanner.status().error, testing::HasSubstr("no scanner answers"));
}

}  // namespace
}  // namespace rubble::robot
