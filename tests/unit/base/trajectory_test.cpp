#include "base/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/angle.h"
#include "base/error.h"
#include "base/rng.h"
#include "base/text/text_file.h"
#include "tests/support/base_files.h"

namespace rubble {
namespace {

using mrpt::math::TPose2D;

std::string read_error(const std::string& text) {
  const test::TempFolder folder;
  write_text_file(folder / "a.tum", text);
  try {
    read_tum(folder / "a.tum");
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind(folder / "a.tum", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr((folder / "a.tum").size());
  }
  return "no error";
}

TEST(Interpolate, EndsAreExactAndTheAngleTakesTheShortWay) {
  const TPose2D a{1.0, 2.0, 3.0};
  const TPose2D b{5.0, -2.0, -3.0};
  EXPECT_EQ(interpolate(a, b, 0.0).x, 1.0);
  EXPECT_EQ(interpolate(a, b, 1.0).y, -2.0);
  EXPECT_NEAR(std::abs(interpolate(a, b, 0.5).phi), kPi, 1e-12);
  EXPECT_NEAR(interpolate(a, b, 0.25).x, 2.0, 1e-12);
  EXPECT_NEAR(interpolate(a, b, 0.25).phi, 3.0 + 0.25 * (2.0 * kPi - 6.0), 1e-12);
}

TEST(PoseAt, IsThereOnlyWithinTheTrajectory) {
  const Trajectory trajectory{{Stamp{100}, {0, 0, 0}}, {Stamp{200}, {1, 0, 0}}, {Stamp{400}, {3, 0, 0}}};
  EXPECT_FALSE(pose_at(trajectory, Stamp{99}));
  EXPECT_FALSE(pose_at(trajectory, Stamp{401}));
  EXPECT_FALSE(pose_at({}, Stamp{0}));
  EXPECT_EQ(pose_at(trajectory, Stamp{100})->x, 0.0);
  EXPECT_EQ(pose_at(trajectory, Stamp{400})->x, 3.0);
  EXPECT_NEAR(pose_at(trajectory, Stamp{150})->x, 0.5, 1e-12);
  EXPECT_NEAR(pose_at(trajectory, Stamp{350})->x, 2.5, 1e-12);
}

TEST(Tum, ALineHasEightFieldsAndSingleSpaces) {
  EXPECT_EQ(tum_line({Stamp{1500000000}, {1.25, -2.5, 0.0}}),
            "1.500000000 1.250000 -2.500000 0.000000 0.000000 0.000000 0.000000000 1.000000000");
  EXPECT_EQ(tum_line({Stamp{-500000000}, {0, 0, 0}}).substr(0, 13), "-0.500000000 ");
  EXPECT_EQ(tum_line({Stamp{1700000000123456789}, {0, 0, 0}}).substr(0, 21), "1700000000.123456789 ");
}

TEST(Tum, ReadsBackWhatItWrote) {
  const test::TempFolder folder;
  Rng rng(1, "trajectory");
  Trajectory written;
  Stamp stamp{1700000000000000000};
  for (int i = 0; i < 500; ++i) {
    stamp.ns += 1 + rng.below(300000000);
    const double x = rng.uniform(-50, 50);
    const double y = rng.uniform(-50, 50);
    const double phi = rng.uniform(-kPi, kPi);
    written.push_back({stamp, {x, y, phi}});
  }
  std::string text;
  for (const StampedPose& stamped : written) text += tum_line(stamped) + '\n';
  write_text_file(folder / "a.tum", text);
  const Trajectory read = read_tum(folder / "a.tum");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp, written[i].stamp);
    EXPECT_NEAR(read[i].pose.x, written[i].pose.x, 1e-6);
    EXPECT_NEAR(read[i].pose.y, written[i].pose.y, 1e-6);
    EXPECT_NEAR(wrap_angle(read[i].pose.phi - written[i].pose.phi), 0.0, 1e-8);
  }
}

TEST(Tum, CommentsExponentsAndWindowsLineEndsAreRead) {
  const test::TempFolder folder;
  write_text_file(folder / "a.tum",
                  "# time x y z qx qy qz qw\n\n1.5e+00 1 2 9 0 0 1 0 # turned\r\n  2 1 2 0 0 0 0 1\n");
  const Trajectory read = read_tum(folder / "a.tum");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].stamp, Stamp{1500000000});
  EXPECT_NEAR(std::abs(read[0].pose.phi), kPi, 1e-12);
}

TEST(Tum, AMistakeIsNamedByLineAndColumn) {
  EXPECT_EQ(read_error("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n"), ":2:1: 7 fields; give 8 numbers 'time x y z qx qy qz qw'");
  EXPECT_EQ(read_error("1 0 0 0 0 0 0 1 5\n"), ":1:1: 9 fields; give 8 numbers 'time x y z qx qy qz qw'");
  EXPECT_EQ(read_error("# c\n1 0 nan 0 0 0 0 1\n"),
            ":2:5: 'nan' is no number; give 8 numbers 'time x y z qx qy qz qw'");
  EXPECT_EQ(read_error("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
            ":2:1: the time does not increase; sort the file by time");
  EXPECT_EQ(read_error("1 0 0 0 0 0 0 0\n"), ":1:9: the quaternion is not of length 1; give qx qy qz qw in this order");
  EXPECT_EQ(read_error("1e30 0 0 0 0 0 0 1\n"), ":1:1: '1e30' is no time in seconds");
  EXPECT_THROW(read_tum("/nowhere/a.tum"), InputError);
}

}  // namespace
}  // namespace rubble
