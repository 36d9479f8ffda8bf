// The ARCOS bytes: examples seen on the wire between ARIA, Player's driver and MobileSim.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "robot/protocols/arcos_commands.h"
#include "robot/protocols/arcos_packet.h"
#include "robot/protocols/arcos_reports.h"

namespace rubble::robot::arcos {
namespace {

std::string hex(const std::string& text) {
  std::string bytes;
  int digits = 0, value = 0;
  for (const char c : text) {
    if (c == ' ') continue;
    value = value * 16 + std::stoi(std::string(1, c), nullptr, 16);
    if (++digits % 2 == 0) {
      bytes.push_back(static_cast<char>(value));
      value = 0;
    }
  }
  return bytes;
}

std::string payload_of(const std::string& packet) { return packet.substr(3, packet.size() - 5); }

TEST(ArcosCommands, HaveTheBytesSeenOnTheWire) {
  EXPECT_EQ(command(kSync0), hex("fa fb 03 00 00 00"));
  EXPECT_EQ(command(kSync1), hex("fa fb 03 01 00 01"));
  EXPECT_EQ(command(kSync2), hex("fa fb 03 02 00 02"));
  EXPECT_EQ(command(kOpen, 1), hex("fa fb 06 01 3b 01 00 02 3b"));
  EXPECT_EQ(command(kEnable, 1), hex("fa fb 06 04 3b 01 00 05 3b"));
  EXPECT_EQ(command(kConfig, 1), hex("fa fb 06 12 3b 01 00 13 3b"));
  EXPECT_EQ(command(kVelocity, 300), hex("fa fb 06 0b 3b 2c 01 37 3c"));
  EXPECT_EQ(command(kVelocity, -300), hex("fa fb 06 0b 1b 2c 01 37 1c"));
  EXPECT_EQ(command(kHead, -170), hex("fa fb 06 0c 1b aa 00 b6 1b"));
  EXPECT_EQ(command(kTurnRate, 20), hex("fa fb 06 15 3b 14 00 29 3b"));
  EXPECT_EQ(command(kTurnRate, -20), hex("fa fb 06 15 1b 14 00 29 1b"));
  EXPECT_EQ(command(kStop), hex("fa fb 03 1d 00 1d"));
  EXPECT_EQ(command(kSetOrigin), hex("fa fb 03 07 00 07"));
}

TEST(ArcosCommands, ComeBackWithTheirSigns) {
  const auto velocity = parse_order(payload_of(command(kVelocity, -300)));
  ASSERT_TRUE(velocity);
  EXPECT_EQ(velocity->number, kVelocity);
  EXPECT_EQ(velocity->value, -300);
  EXPECT_EQ(parse_order(payload_of(command(kStop)))->value, std::nullopt);
  EXPECT_FALSE(parse_order(""));
}

TEST(ArcosCommands, AllFormsThatClientsSendAreTaken) {
  // Player: an argument type without a value.
  const auto origin = parse_order(payload_of(hex("fa fb 04 07 3b 07 3b")));
  ASSERT_TRUE(origin);
  EXPECT_EQ(origin->number, kSetOrigin);
  EXPECT_EQ(origin->value, std::nullopt);
  // Wheel speeds: ARIA sends the word as magnitude and sign, Player its raw bytes.
  const auto aria = parse_order(payload_of(hex("fa fb 06 20 1b fb 09 1b 24")));
  ASSERT_TRUE(aria && aria->value);
  EXPECT_EQ(wheel_speeds(*aria->value).left, -10);
  EXPECT_EQ(wheel_speeds(*aria->value).right, 5);
  const auto player = parse_order(payload_of(hex("fa fb 06 20 3b 0a f6 2b 31")));
  ASSERT_TRUE(player && player->value);
  EXPECT_EQ(wheel_speeds(*player->value).left, -10);
  EXPECT_EQ(wheel_speeds(*player->value).right, 10);
  EXPECT_EQ(parse_order(std::string("\x0f\x2b\x03"
                                    "abc",
                                    6))
                ->text,
            "abc");
}

const char* const kReport =
    "fa fb 22 33 e8 03 38 ff 00 04 c8 00 2c 01 80 00 00 00 04 01 00 00 00 00 00 00 00 00 80 00 00 61 00 00 00 9f 18";

StandardInformation example() {
  StandardInformation s;
  s.moving = true;
  s.x = 1000;
  s.y = static_cast<std::uint16_t>(-200);
  s.heading = 1024;
  s.left = 200;
  s.right = 300;
  s.battery = 12.8;
  s.control = 1024;
  s.flags = kMotorsOn;
  s.turn_rate = 9.7;
  return s;
}

TEST(ArcosReports, StandardInformationHasTheBytesSeenOnTheWire) { EXPECT_EQ(packet(encode(example())), hex(kReport)); }

TEST(ArcosReports, StandardInformationIsRead) {
  const auto s = parse_information(payload_of(hex(kReport)));
  ASSERT_TRUE(s);
  EXPECT_TRUE(s->moving);
  EXPECT_EQ(s->x, 1000);
  EXPECT_EQ(s->y, 65336);
  EXPECT_EQ(s->heading, 1024);
  EXPECT_EQ(s->left, 200);
  EXPECT_EQ(s->right, 300);
  EXPECT_DOUBLE_EQ(s->battery, 12.8);
  EXPECT_EQ(s->flags, kMotorsOn);
  ASSERT_TRUE(s->turn_rate);
  EXPECT_DOUBLE_EQ(*s->turn_rate, 9.7);
}

TEST(ArcosReports, SonarMovesWhatFollows) {
  StandardInformation s = example();
  s.sonar = {{3, 1200}, {15, 4999}};
  const auto back = parse_information(encode(s));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->sonar, s.sonar);
  EXPECT_DOUBLE_EQ(*back->turn_rate, 9.7);
}

TEST(ArcosReports, OlderFirmwareSendsNoTurnRate) {
  const auto s = parse_information(payload_of(hex(kReport)).substr(0, 25));
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->turn_rate);
  EXPECT_FALSE(parse_information(payload_of(hex(kReport)).substr(0, 17)));
}

TEST(ArcosReports, IdentityHasTheBytesSeenOnTheWire) {
  const std::string wire = hex("fa fb 1d 02 4d6f62696c6553696d00 50696f6e65657200 703361742d736800 02 d7");
  EXPECT_EQ(packet(encode(Identity{"MobileSim", "Pioneer", "p3at-sh"})), wire);
  const auto identity = parse_identity(payload_of(wire));
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->subclass, "p3at-sh");
}

TEST(ArcosReports, ConfigurationComesBack) {
  Configuration c;
  c.serial = "A1";
  c.cycle_ms = 50;
  c.ticks_mm = 99;
  c.firmware = "2.6";
  c.accel = 450;
  const auto back = parse_configuration(encode(c));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->serial, "A1");
  EXPECT_EQ(back->cycle_ms, 50);
  EXPECT_EQ(back->ticks_mm, 99);
  EXPECT_EQ(back->firmware, "2.6");
  EXPECT_EQ(back->accel, 450);
  EXPECT_EQ(back->watchdog_ms, 2000);
}

TEST(ArcosPackets, AreFoundHoweverTheStreamIsCut) {
  const std::string stream = "WMS2\r" + command(kSync0) + hex("fa") + command(kVelocity, 300) + "junk" +
                             packet(hex("33 fa fb 03 00")) + command(kStop);
  for (std::size_t cut = 1; cut <= stream.size(); ++cut) {
    PacketParser parser;
    std::vector<std::string> payloads;
    for (std::size_t at = 0; at < stream.size(); at += cut) {
      parser.feed(stream.substr(at, cut));
      while (const auto payload = parser.next()) payloads.push_back(*payload);
    }
    EXPECT_THAT(payloads, testing::ElementsAre(payload_of(command(kSync0)), payload_of(command(kVelocity, 300)),
                                               hex("33 fa fb 03 00"), payload_of(command(kStop))))
        << "pieces of " << cut;
    EXPECT_EQ(parser.bad_sums(), 0u);
  }
}

TEST(ArcosPackets, ALostByteCostsOnePacketOnly) {
  const std::string first = packet(encode(example()));
  for (std::size_t lost = 0; lost < first.size(); ++lost) {
    std::string damaged = first;
    damaged.erase(lost, 1);
    PacketParser parser;
    parser.feed(damaged + command(kStop) + std::string(300, '\0'));
    std::vector<std::string> payloads;
    while (const auto payload = parser.next()) payloads.push_back(*payload);
    EXPECT_THAT(payloads, testing::Contains(payload_of(command(kStop)))) << "without byte " << lost;
    EXPECT_THAT(payloads, testing::Not(testing::Contains(payload_of(first))));
  }
}

TEST(ArcosPackets, AHeadInJunkHoldsUpWhatFollowsForAMomentOnly) {
  for (int length = 3; length < 256; ++length) {
    PacketParser parser;
    Stamp now{1'000'000'000};
    parser.feed(hex("fa fb") + static_cast<char>(length), now);
    EXPECT_FALSE(parser.next(now));
    const std::string velocity = command(kVelocity, 300);
    // Commands follow at once and so far apart that together they would fill the false packet after seconds only.
    int heard = 0;
    for (int i = 0; i <= 500; ++i, now = now + 0.001) {
      if (i % 250 == 0) parser.feed(velocity, now);
      while (const auto payload = parser.next(now)) heard += *payload == payload_of(velocity) ? 1 : 0;
      if (i == 350) {
        EXPECT_EQ(heard, 2) << "length " << length;
      }
    }
    EXPECT_EQ(heard, 3) << "length " << length;
  }
}

TEST(ArcosPackets, ASlowLineCutsNoPacket) {
  const std::string longest = packet(std::string(kLongest - 2, 'x'));
  PacketParser parser;
  Stamp now{0};
  int found = 0;
  for (int round = 0; round < 3; ++round)
    for (const char c : longest) {
      parser.feed(std::string_view(&c, 1), now);
      while (parser.next(now)) ++found;
      now = now + 10.0 / 9600.0;
    }
  EXPECT_EQ(found, 3);
  EXPECT_EQ(parser.junk(), 0u);
}

TEST(ArcosPackets, APacketThatWasHeldUpWithinIsWhole) {
  const std::string stop = command(kStop);
  PacketParser parser;
  parser.feed(stop.substr(0, 4), Stamp{0});
  EXPECT_FALSE(parser.next(Stamp{0}));
  // The reader itself was busy for six seconds: nobody asked meanwhile.
  parser.feed(stop.substr(4), Stamp{6'000'000'000});
  EXPECT_EQ(parser.next(Stamp{6'000'000'000}), payload_of(stop));
}

TEST(ArcosPackets, NoDamagedByteGoesUnseen) {
  const std::string good = packet(encode(example()));
  for (std::size_t at = 3; at < good.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = good;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      PacketParser parser;
      parser.feed(damaged);
      EXPECT_FALSE(parser.next()) << "byte " << at << " bit " << bit;
      EXPECT_EQ(parser.bad_sums(), 1u);
    }
}

TEST(ArcosPackets, RandomBytesDoNoHarm) {
  std::mt19937 random(4711);
  PacketParser parser;
  for (int i = 0; i < 2000; ++i) {
    std::string bytes(random() % 100, '\0');
    for (char& c : bytes) c = random() % 8 == 0 ? '\xfa' : random() % 8 == 0 ? '\xfb' : static_cast<char>(random());
    parser.feed(bytes);
    while (const auto payload = parser.next()) {
      parse_order(*payload);
      parse_information(*payload);
      parse_configuration(*payload);
      parse_identity(*payload);
    }
  }
  parser.feed(std::string(300, '\0') + command(kStop));
  std::optional<std::string> last;
  while (const auto payload = parser.next()) last = payload;
  EXPECT_EQ(last, payload_of(command(kStop)));
}

}  // namespace
}  // namespace rubble::robot::arcos
