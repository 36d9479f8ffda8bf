// The text of SCIP: sums, numbers and lines, against lines that real scanners sent.
#include "robot/drivers/scip/scip_text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/rng.h"
#include "robot/drivers/scip/scip_reply.h"

namespace rubble::robot::scip {
namespace {

TEST(ScipText, SumsOfTheStatusLines) {
  const std::vector<std::pair<std::string, char>> known = {{"00", 'P'}, {"01", 'Q'}, {"02", 'R'}, {"03", 'S'},
                                                           {"04", 'T'}, {"10", 'Q'}, {"99", 'b'}, {"98", 'a'},
                                                           {"0A", 'a'}, {"0C", 'c'}, {"0D", 'd'}, {"0E", 'e'}};
  for (const auto& [text, sum] : known) EXPECT_EQ(sum_of(text), sum) << text;
}

TEST(ScipText, WhatAScannerSaysOfItselfHasNoEscapesForTheTerminal) {
  Reply reply;
  reply.lines = {"VV", "00P", "FI\x07RM:3.1\x1b[31m\r"};
  const auto entries = entries_of(reply, false);
  ASSERT_TRUE(entries);
  ASSERT_EQ(entries->size(), 1u);
  EXPECT_EQ((*entries)[0].first, "FI\\x07RM");
  EXPECT_EQ((*entries)[0].second, "3.1\\x1b[31m\\r");
}

TEST(ScipText, EntriesOfRealScannersHaveTheRightSum) {
  const std::vector<std::string> lines = {"VEND:Hokuyo Automatic Co.,Ltd.;[",
                                          "PROD:SOKUIKI Sensor URG-04LX;[",
                                          "FIRM:3.1.00(18/Jan./2007);`",
                                          "PROT:SCIP 2.0;N",
                                          "SERI:H0614967;V",
                                          "MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N",
                                          "DMIN:20;4",
                                          "DMAX:5600;_",
                                          "ARES:1024;\\",
                                          "AMIN:44;7",
                                          "AMAX:725;o",
                                          "AFRT:384;6",
                                          "SCAN:600;e",
                                          "LASR:OFF;7",
                                          "SCSP:Initial(600[rpm])<-Default setting by user;A",
                                          "MESM:IDLE;:",
                                          "SBPS:19200[bps]<-Default setting by user;A",
                                          "TIME:081615;N",
                                          "STAT:Sensor works well.;8"};
  for (const std::string& line : lines) {
    const auto text = checked_entry(line);
    ASSERT_TRUE(text) << line;
    EXPECT_EQ(*text, line.substr(0, line.size() - 2));
    for (std::size_t i = 0; i + 2 < line.size(); ++i) {
      std::string damaged = line;
      damaged[i] = static_cast<char>(damaged[i] ^ 1);
      EXPECT_FALSE(checked_entry(damaged)) << damaged;
    }
  }
}

TEST(ScipText, NumbersOfTheSpecification) {
  EXPECT_EQ(encode(1234, 2), "CB");
  EXPECT_EQ(encode(5432, 3), "1Dh");
  EXPECT_EQ(encode(16000000, 4), "m2@0");
  EXPECT_EQ(decode("CB"), 1234u);
  EXPECT_EQ(decode("1Dh"), 5432u);
  EXPECT_EQ(decode("m2@0"), 16000000u);
  EXPECT_EQ(decode("0C"), 19u);  // what SCIP 1.1 gives for the steps that cannot measure
  EXPECT_FALSE(decode("0/"));
  EXPECT_FALSE(decode("p0"));
  EXPECT_FALSE(decode("0\xC3"));
}

TEST(ScipText, EveryNumberComesBack) {
  Rng rng{11, "numbers"};
  for (int i = 0; i < 1000; ++i) {
    const std::size_t characters = 1 + rng.below(4);
    const std::uint32_t value = rng.below(1u << (6 * characters));
    EXPECT_EQ(decode(encode(value, characters)), value);
  }
}

TEST(ScipText, DataIsCutAtSixtyFourCharacters) {
  EXPECT_EQ(cut_into_lines(std::string(64, '0'), false), std::string(64, '0') + "\n");
  EXPECT_EQ(cut_into_lines("", true), "");
  const std::string cut = cut_into_lines(std::string(65, '0'), true);
  EXPECT_EQ(cut, std::string(64, '0') + sum_of(std::string(64, '0')) + "\n0" + sum_of("0") + "\n");
  // A scan of steps 44 to 725: 682 values of three characters are 32 lines, with echo, status and time 2137 bytes.
  const std::string scan = cut_into_lines(std::string(682 * 3, '0'), true);
  EXPECT_EQ(scan.size() + std::string("MD0044072501000\n99b\nTTTTs\n\n").size(), 2137u);
}

}  // namespace
}  // namespace rubble::robot::scip
