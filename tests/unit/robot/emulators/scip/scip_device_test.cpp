// The emulated scanner's answers, byte by byte, as the specification and captures of real scanners have them.
#include "robot/emulators/scip/scip_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot::scip {
namespace {

using testing::EndsWith;
using testing::StartsWith;

class ScipDevice : public testing::Test {
 protected:
  /// What the device sends when it gets the text; time stands still.
  std::string send(const std::string& text) {
    std::string all;
    for (const std::string& reply :
         device_.receive(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), time_))
      all += reply;
    return all;
  }
  std::string line(const std::string& command) { return send(command + "\n"); }
  std::string turn(std::vector<std::uint32_t> values = {}) {
    time_ += 0.1;
    if (values.empty()) values.assign(769, 1234);
    std::string all;
    for (const std::string& block : device_.turn(time_, values)) all += block;
    return all;
  }
  void to_scip2() { ASSERT_EQ(line("SCIP2.0"), "SCIP2.0\n0\n\n"); }

  Device device_{DeviceIdentity{}};
  double time_ = 10.0;
};

TEST_F(ScipDevice, StartsInTheOldProtocolAndRefusesTheNewOne) {
  EXPECT_EQ(line("QT"), "QT\nE\n\n");
  EXPECT_EQ(line("VV"), "VV\nE\n\n");
  EXPECT_EQ(line("RS"), "RS\nE\n\n");
  EXPECT_EQ(line("L0"), "L0\n0\n\n");
  EXPECT_EQ(line("S0192007654321"), "S0192007654321\n0\n\n");
  EXPECT_EQ(line("S1152000000000"), "S1152000000000\n0\n\n");
  EXPECT_THAT(line("V"), StartsWith("V\n0\nVEND:"));
  EXPECT_THAT(line("V"), testing::HasSubstr("(20-4095[mm],240[deg],44-725[step],600[rpm])\n"));
}

TEST_F(ScipDevice, OldScanHasNoSumsAndStartsWithTheStepsThatCannotMeasure) {
  EXPECT_EQ(line("G00076801"), "") << "the turn is not over yet";
  std::vector<std::uint32_t> values(769, 1234);
  std::fill(values.begin(), values.begin() + 44, kNotMeasurable);
  std::fill(values.begin() + 726, values.end(), kNotMeasurable);
  const std::string scan = turn(values);
  EXPECT_THAT(scan, StartsWith("G00076801\n0\n0C0C0C"));
  EXPECT_EQ(scan.substr(12, 64), [] {
    std::string expected;
    for (int i = 0; i < 32; ++i) expected += "0C";
    return expected;
  }());
  EXPECT_EQ(scan[12 + 64], '\n');
  EXPECT_THAT(scan, EndsWith("\n\n"));
  EXPECT_EQ(scan.size(), 12u + 769 * 2 + 25 + 1);  // 1538 characters are 24 lines of 64 and one of 2
}

TEST_F(ScipDevice, OneAnswerATurn) {
  line("G04472501");
  EXPECT_NE(turn(), "");
  EXPECT_EQ(line("G04472501"), "");
  EXPECT_NE(turn(), "");
  EXPECT_EQ(turn(), "");
}

TEST_F(ScipDevice, SwitchHoldsAndASecondOneIsAnsweredInTheNewForm) {
  to_scip2();
  EXPECT_EQ(line("SCIP2.0"), "SCIP2.0\n0Ee\n\n");
  EXPECT_EQ(line("QT"), "QT\n00P\n\n");
  device_.client_left();
  EXPECT_EQ(line("QT"), "QT\n00P\n\n");
  device_.cycle_power(time_);
  EXPECT_EQ(line("QT"), "QT\nE\n\n");
}

TEST_F(ScipDevice, ParametersAreThoseOfARealScannerToTheByte) {
  to_scip2();
  EXPECT_EQ(line("PP"),
            "PP\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nDMIN:20;4\nDMAX:5600;_\nARES:1024;\\\nAMIN:44;7\n"
            "AMAX:725;o\nAFRT:384;6\nSCAN:600;e\n\n");
}

TEST_F(ScipDevice, VersionHasFiveLinesAndStateSeven) {
  to_scip2();
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  EXPECT_EQ(lines(line("VV")), 2 + 5 + 1);
  EXPECT_THAT(line("VV"), StartsWith("VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\nPROD:SOKUIKI Sensor URG-04LX;[\n"));
  const std::string state = line("II");
  EXPECT_EQ(lines(state), 2 + 7 + 1);
  EXPECT_THAT(state, testing::HasSubstr("\nLASR:OFF;7\nSCSP:Initial(600[rpm])<-Default setting by user;A\nMESM:IDLE;:\n"
                                        "SBPS:19200[bps]<-Default setting by user;A\nTIME:002710;"));
  EXPECT_THAT(state, EndsWith("\nSTAT:Sensor works well.;8\n\n"));
}

TEST_F(ScipDevice, StatusOfEveryCommand) {
  to_scip2();
  const std::vector<std::pair<std::string, std::string>> conversation = {
      {"BM", "00P"},
      {"BM", "02R"},
      {"QT", "00P"},
      {"SS115200", "00P"},
      {"SS115200", "03S"},
      {"SS000000", "02R"},
      {"SS038400", "04T"},
      {"SS11520x", "01Q"},
      {"SS1152", "0Cc"},
      {"CR05", "00P"},
      {"CR05", "03S"},
      {"CR99", "00P"},
      {"CR11", "02R"},
      {"CRxx", "01Q"},
      {"HS1", "00P"},
      {"HS1", "02R"},
      {"HS0", "00P"},
      {"HS2", "01Q"},
      {"TM1", "04T"},
      {"TM2", "03S"},
      {"TM0", "00P"},
      {"TM0", "02R"},
      {"TM3", "01Q"},
      {"QT", "0Ee"},
      {"PP", "0Ee"},
      {"SCIP2.0", "0Ee"},
      {"TM2", "00P"},
      {"RS", "00P"},
      {"XX", "0Ee"},
      {"ME0044072501000", "0Ee"},
      {"GD0044072501", "10Q"},
      {"GDx044072501", "01Q"},
      {"GD0044x72501", "02R"},
      {"GD00440725x1", "03S"},
      {"GD0044076901", "04T"},
      {"GD0044004301", "05U"},
      {"GD004407", "0Cc"},
      {"MD0044072501x00", "06V"},
      {"MD00440725010x0", "07W"},
      {"MD0044072501", "0Cc"},
      {"QT;12345678901234567", [] { return std::string("0G") + sum_of("0G"); }()},
      {"QT;a!", std::string("0H") + sum_of("0H")},
      {"QT;my string 1.0_+@", "00P"}};
  for (const auto& [command, status] : conversation)
    EXPECT_EQ(line(command), command + "\n" + status + "\n\n") << command;
}

TEST_F(ScipDevice, TimeIsTwentyFourBitsOfMilliseconds) {
  to_scip2();
  line("TM0");
  device_.set_clock(time_, 16000000);
  EXPECT_EQ(line("TM1"), std::string("TM1\n00P\nm2@0") + sum_of("m2@0") + "\n\n");
  device_.set_clock(time_, (1u << 24) - 1);
  EXPECT_THAT(line("TM1"), StartsWith("TM1\n00P\noooo"));
  time_ += 0.001;
  EXPECT_THAT(line("TM1"), StartsWith("TM1\n00P\n0000"));
}

TEST_F(ScipDevice, StreamRunsUntilQtAndItsBlockHas2137Bytes) {
  to_scip2();
  EXPECT_EQ(line("MD0044072501000"), "MD0044072501000\n00P\n\n");
  for (int i = 0; i < 3; ++i) {
    const std::string block = turn();
    EXPECT_EQ(block.size(), 2137u);
    EXPECT_THAT(block, StartsWith("MD0044072501000\n99b\n"));
    EXPECT_THAT(block, EndsWith("\n\n"));
  }
  EXPECT_EQ(line("QT"), "QT\n00P\n\n");
  EXPECT_EQ(turn(), "");
}

TEST_F(ScipDevice, ShortStreamHas1435Bytes) {
  to_scip2();
  line("MS0044072501000");
  EXPECT_EQ(turn().size(), 1435u);
}

TEST_F(ScipDevice, CountedStreamCountsDownAndEndsWithTheLaserOff) {
  to_scip2();
  line("MD0044072501003");
  for (const char* echo : {"MD0044072501002\n", "MD0044072501001\n", "MD0044072501000\n"})
    EXPECT_THAT(turn(), StartsWith(echo));
  EXPECT_EQ(turn(), "");
  EXPECT_EQ(line("BM"), "BM\n00P\n\n");
}

TEST_F(ScipDevice, StreamSkipsTurns) {
  to_scip2();
  line("MD0044072501200");
  std::string pattern;
  for (int i = 0; i < 7; ++i) pattern += turn().empty() ? '.' : 'x';
  EXPECT_EQ(pattern, "x..x..x");
}

TEST_F(ScipDevice, TurnThatBeganBeforeTheCommandIsNotSent) {
  to_scip2();
  line("MD0044072501000");
  EXPECT_TRUE(device_.turn(time_ - 0.05, std::vector<std::uint32_t>(769, 1000)).empty());
  EXPECT_FALSE(device_.turn(time_ + 0.05, std::vector<std::uint32_t>(769, 1000)).empty());
}

TEST_F(ScipDevice, ClustersGiveTheLeastRangeAndTheLastMayBeShort) {
  to_scip2();
  line("GD0044072501");  // laser is off: refused
  line("BM");
  line("GD0000000703");
  std::vector<std::uint32_t> values(769, 0);
  values[0] = 7, values[1] = 1500, values[2] = 1400;  // 7 is a code, no range
  values[3] = 0, values[4] = 6, values[5] = 19;
  values[6] = 5000, values[7] = 5001;
  const std::string block = turn(values);
  const std::string data = encode(1400, 3) + encode(0, 3) + encode(5000, 3);
  EXPECT_THAT(block, EndsWith("\n" + data + sum_of(data) + "\n\n"));
}

TEST_F(ScipDevice, TwoCharactersEndAt4095) {
  to_scip2();
  line("BM");
  line("GS0044004401");
  const std::string full = encode(4095, 2);
  EXPECT_THAT(turn(std::vector<std::uint32_t>(769, 5000)), EndsWith("\n" + full + sum_of(full) + "\n\n"));
}

TEST_F(ScipDevice, LineEndsOfAllKindsAndEmptyLines) {
  to_scip2();
  EXPECT_EQ(send("\n\r\r\n\n"), "");
  EXPECT_EQ(send("QT\r"), "QT\n00P\n\n");
  EXPECT_EQ(send("QT\r\n"), "QT\n00P\n\n");
  EXPECT_EQ(send("Q"), "");
  EXPECT_EQ(send("T\n"), "QT\n00P\n\n");
}

TEST_F(ScipDevice, OtherScannersSayTheirOwnGeometry) {
  const DeviceIdentity utm = identity_of(laser_model("UTM-30LX"));
  EXPECT_EQ(utm.geometry.steps_per_turn, 1440);
  EXPECT_EQ(utm.geometry.first_step, 0);
  EXPECT_EQ(utm.geometry.last_step, 1080);
  EXPECT_EQ(utm.geometry.front_step, 540);
  EXPECT_EQ(utm.geometry.turns_per_minute, 2400);
  LaserModel odd;
  odd.name = "odd";
  odd.angle_step = 0.01;
  EXPECT_THROW(identity_of(odd), InputError);
}

TEST_F(ScipDevice, WhateverComesInWholeRepliesGoOut) {
  Rng rng{99, "noise"};
  const std::string alphabet = "QTMDGSVPBRCHI0123456789;\n\r .SCIP2\xff";
  for (int i = 0; i < 20000; ++i) {
    std::string text(1 + rng.below(24), '\0');
    for (char& c : text) c = alphabet[rng.below(static_cast<std::uint32_t>(alphabet.size()))];
    const std::string all = send(text);
    if (!all.empty()) {
      EXPECT_THAT(all, EndsWith("\n\n"));
    }
    if (i % 5 == 0) turn();
  }
}

}  // namespace
}  // namespace rubble::robot::scip
