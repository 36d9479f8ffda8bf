#include "scenarios/hardware/scanner_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rubble::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;

robot::ScannerInfo answers_as(const std::string& name, const std::string& told) {
  robot::ScannerInfo info;
  info.model = told;
  info.laser = robot::laser_model(name);
  return info;
}

TEST(ScannerCheck, EveryKnownScannerFitsItsOwnFile) {
  for (const std::string& name : robot::laser_names())
    EXPECT_EQ(scanner_mismatch(answers_as(name, name + "(Hokuyo Automatic Co.,Ltd.)"), robot::laser_model(name)), "");
}

/// A URG-04LX measures up to 5.6 m, and is specified to the 4 m that its file has.
TEST(ScannerCheck, AFileThatAsksForLessThanTheScannerSeesFits) {
  robot::ScannerInfo urg = answers_as("URG-04LX", "URG-04LX(Hokuyo Automatic Co.,Ltd.)");
  urg.laser.range_max = 5.6;
  EXPECT_EQ(scanner_mismatch(urg, robot::laser_model("URG-04LX")), "");
}

/// The same geometry under another name.
TEST(ScannerCheck, AKinOfAScannerFitsItsFile) {
  EXPECT_EQ(scanner_mismatch(answers_as("URG-04LX", "URG-04LX-UG01(Simple-URG)"), robot::laser_model("URG-04LX")), "");
}

TEST(ScannerCheck, EveryOtherKnownScannerIsNamedWithTheRemedy) {
  for (const std::string& name : robot::laser_names()) {
    for (const std::string& file : robot::laser_names()) {
      if (name == file || name == robot::kGenericLaser) continue;
      SCOPED_TRACE(name + " at the file of " + file);
      const std::string line = scanner_mismatch(answers_as(name, name + "(Hokuyo)"), robot::laser_model(file));
      EXPECT_THAT(line, AllOf(HasSubstr("it is a " + name + " ("), HasSubstr("is of a " + file + " ("),
                              HasSubstr("--set robot.laser.model=" + name)));
      EXPECT_EQ(line.find('\n'), std::string::npos);
    }
  }
}

TEST(ScannerCheck, AStrangersNumbersAreGivenForTheFile) {
  EXPECT_THAT(scanner_mismatch(answers_as("generic", "XYZ-1"), robot::laser_model("URG-04LX")),
              AllOf(HasSubstr("it is a XYZ-1 ("), HasSubstr("model: generic, beams: 541, field_of_view_deg: 270")));
}

TEST(ScannerCheck, NumbersOfTheFileThatAreNotTheScannersAreNamed) {
  robot::LaserModel file = robot::laser_model("URG-04LX");
  file.range_max = 30.0;
  EXPECT_THAT(scanner_mismatch(answers_as("URG-04LX", "URG-04LX"), file), HasSubstr("correct the numbers"));
}

TEST(ScannerCheck, WhoHasNotToldYetIsNotJudged) { EXPECT_EQ(scanner_mismatch({}, robot::laser_model("UTM-30LX")), ""); }

}  // namespace
}  // namespace rubble::scenarios
