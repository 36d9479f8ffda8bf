// The levelling unit's line protocol: sums and fields of docs/hardware.md's examples.
#include "robot/protocols/levelling_line.h"

#include <gtest/gtest.h>

namespace rubble::robot {
namespace {

std::optional<std::vector<std::string>> only_line(const std::string& bytes) {
  LevellingLines lines;
  lines.feed(bytes);
  return lines.next();
}

TEST(LevellingLine, SumsAreThoseOfTheExamples) {
  EXPECT_EQ(levelling_line("S,1530,1475"), "$S,1530,1475*53\r\n");
  EXPECT_EQ(levelling_line("V"), "$V*56\r\n");
  EXPECT_EQ(levelling_line("E,1"), "$E,1*58\r\n");
  EXPECT_EQ(levelling_line("E,OK"), "$E,OK*6D\r\n");
  EXPECT_EQ(levelling_line("R,50"), "$R,50*7B\r\n");
  EXPECT_EQ(levelling_line("N,BADSUM"), "$N,BADSUM*6E\r\n");
  EXPECT_EQ(levelling_line(body(LevellingIdentity{})), "$V,LEV1,ADXL202,1000000,10000,50,900,2100,500*13\r\n");
}

TEST(LevellingLine, AReportIsReadAndWritten) {
  const auto fields = only_line("$L,1,17,340512,5218,4973,10000,1500,1500,3*53\r\n");
  ASSERT_TRUE(fields);
  const auto report = parse_report(*fields);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->sequence, 17);
  EXPECT_EQ(report->time_us, 340512u);
  EXPECT_EQ(report->t1x, 5218);
  EXPECT_EQ(report->t1y, 4973);
  EXPECT_EQ(report->t2, 10000);
  EXPECT_EQ(report->flags, LevellingReport::kServosOn | LevellingReport::kSettled);
  EXPECT_EQ(body(*report), "L,1,17,340512,5218,4973,10000,1500,1500,3");
}

TEST(LevellingLine, WrongSumsAndFieldsAreRefused) {
  EXPECT_FALSE(only_line("$L,1,17,340512,5218,4973,10000,1500,1500,3*54\r\n"));
  EXPECT_FALSE(only_line("$V*5\r\n"));
  EXPECT_FALSE(only_line("V*56\r\n"));
  EXPECT_FALSE(parse_report({"L", "1", "17", "340512", "5218", "4973", "0", "1500", "1500", "3"}));
  EXPECT_FALSE(parse_report({"L", "1", "17", "340512", "5218x", "4973", "10000", "1500", "1500", "3"}));
  EXPECT_FALSE(parse_report({"L", "2", "17", "340512", "5218", "4973", "10000", "1500", "1500", "3"}));
  EXPECT_FALSE(parse_report({"L", "1", "17"}));
  EXPECT_FALSE(parse_identity({"V", "LEV1"}));
  EXPECT_TRUE(parse_identity({"V", "LEV1", "ADXL202", "1000000", "10000", "50", "900", "2100", "500"}));
  EXPECT_FALSE(parse_identity({"V", "LEV1", "ADXL202", "1000000", "10000", "50", "2100", "900", "500"}))
      << "no pulse lies between these";
}

TEST(LevellingLine, HalfALineAtTheStartIsPassedOver) {
  LevellingLines lines;
  lines.feed("12,5218*00\r\n$E,OK*6D\r\n$N,BAD");
  const auto first = lines.next();
  ASSERT_TRUE(first);
  EXPECT_EQ((*first)[1], "OK");
  EXPECT_EQ(lines.bad_lines(), 1u);
  EXPECT_FALSE(lines.next());
  lines.feed("SUM*6E\r\n");
  EXPECT_TRUE(lines.next());
}

TEST(LevellingLine, AStreamWithoutLinesIsNotHoarded) {
  LevellingLines lines;
  for (int i = 0; i < 1000; ++i) lines.feed(std::string(1000, 'x'));
  lines.feed("\r\n$V*56\r\n");
  EXPECT_TRUE(lines.next());
}

}  // namespace
}  // namespace rubble::robot
