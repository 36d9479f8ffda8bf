#include "scenarios/run/loop_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/image/legend.h"
#include "tests/support/planted_mapper.h"

namespace rubble::scenarios {
namespace {

using slam::FoundLoop;

const cv::Vec3b kGreen(115, 158, 0), kOrange(0, 159, 230), kBlue(178, 114, 0);

/// Pixels of the longest row of one colour, as smooth lines have it.
int longest_row(const cv::Mat& picture, const cv::Vec3b& ink) {
  int longest = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0, run = 0; x < picture.cols; ++x) {
      run = cv::norm(picture.at<cv::Vec3b>(y, x), ink) < 60.0 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  return longest;
}

/// Four places in known ground, 2 m apart from west to east.
class LoopPicture : public testing::Test {
 protected:
  LoopPicture() {
    const GridFrame frame{100, 100, 0.05, -2.5, -2.5};
    slam::CountMap map(100, 100, 0.05);
    map.assign(frame, std::vector<std::uint16_t>(frame.size(), 1), std::vector<std::uint16_t>(frame.size(), 0));
    mapper_.show(std::move(map));
    for (int i = 0; i < 4; ++i)
      mapper_.plant(Stamp{i * 1'000'000'000LL}, {i % 2 == 0 ? -1.0 : 1.0, i < 2 ? 0.01 : 1.01, 0.0});
  }
  static FoundLoop loop(int from, int to, const std::string& end) {
    FoundLoop out;
    out.from = Stamp{from * 1'000'000'000LL};
    out.to = Stamp{to * 1'000'000'000LL};
    out.T_from_to = {2.0, 0.0, 0.0};
    out.end = end;
    return out;
  }

  test::PlantedMapper mapper_;
  int way_ = static_cast<int>(0.9 * 2.0 / 0.05) * pixels_per_cell({100 + 20, 100 + 20, 0.05, 0.0, 0.0});
};

TEST_F(LoopPicture, EachPlaceIsALineInTheColourOfItsEnd) {
  const cv::Mat both = loop_picture(mapper_, {loop(0, 1, "closed"), loop(2, 3, "contradicted")});
  EXPECT_GE(longest_row(both, kGreen), way_);
  EXPECT_GE(longest_row(both, kOrange), way_);
  const cv::Mat one = loop_picture(mapper_, {loop(0, 1, "closed")});
  EXPECT_GE(longest_row(one, kGreen), way_);
  EXPECT_LT(longest_row(one, kOrange), 10);
}

TEST_F(LoopPicture, AnOlderPlaceLiesWhereTheMapperHasItElseWhereTheLoopSays) {
  // By the clock of this drive the older stamp lies one way, in the map the other: it is of an earlier drive.
  FoundLoop earlier = loop(2, 1, "contradicted");
  earlier.T_map_from = mrpt::math::TPose2D{-1.0, 0.01, 0.0};
  EXPECT_GE(longest_row(loop_picture(mapper_, {earlier}), kOrange), way_);
  EXPECT_GE(longest_row(loop_picture(mapper_, {loop(-1000, 1, "closed")}), kGreen), way_);
  const cv::Mat nowhere = loop_picture(mapper_, {loop(0, 1000, "contradicted")});
  EXPECT_LT(longest_row(nowhere, kOrange), way_ / 2) << "of a newer place that nobody knows only the legend tells";
}

TEST_F(LoopPicture, AMapperThatDoesNotKnowWhereItIsYetIsDrawnAsWell) {
  const cv::Mat picture = loop_picture(test::PlantedMapper(), {loop(0, 1, "closed"), loop(0, 2, "unfit")});
  EXPECT_GE(picture.cols, 700);
}

TEST_F(LoopPicture, TestsThatWereNotAskedHaveNoMark) {
  FoundLoop asked = loop(0, 1, "closed");
  const cv::Mat before = loop_picture(mapper_, {asked});
  asked.inliers = 0.8;
  const cv::Mat after = loop_picture(mapper_, {asked});
  ASSERT_EQ(before.size(), after.size());
  std::vector<cv::Point> changed;
  for (int y = 0; y < after.rows; ++y)
    for (int x = 0; x < after.cols; ++x)
      if (before.at<cv::Vec3b>(y, x) != after.at<cv::Vec3b>(y, x)) changed.emplace_back(x, y);
  ASSERT_GT(changed.size(), 20U);
  const cv::Rect mark = cv::boundingRect(changed);
  EXPECT_LE(mark.width, 9) << "one mark more, and none that was there has gone";
  EXPECT_LE(mark.height, 9);
  EXPECT_GT(longest_row(after(mark).clone(), kBlue), 3);
}

}  // namespace
}  // namespace rubble::scenarios
