#include "scenarios/run/scan_picture.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rubble::scenarios {
namespace {

/// A thousand scans in 100 s, of one value in all columns, and one that may stand out.
slam::ScanRecords scans_of(const std::vector<std::string>& columns, float value, float peak) {
  slam::ScanRecords records;
  records.columns = columns;
  for (int i = 0; i < 1000; ++i) {
    records.stamps.push_back(Stamp{i * 100'000'000LL});
    for (std::size_t k = 0; k < columns.size(); ++k) records.values.push_back(i == 500 ? peak : value);
  }
  return records;
}

/// Mean row of the pixels of a line, without those of the legend.
double row_of_line(const cv::Mat& picture) {
  cv::Mat line;
  cv::inRange(picture.colRange(90, 500), cv::Scalar(150, 90, 0), cv::Scalar(200, 140, 40), line);
  double sum = 0.0, n = 0.0;
  for (int y = 0; y < line.rows; ++y) {
    const double here = cv::countNonZero(line.row(y));
    sum += here * y;
    n += here;
  }
  EXPECT_GT(n, 200.0);
  return sum / n;
}

TEST(ScanPicture, ColumnsOfOneUnitShareAPanelAndAnUnknownOneHasItsOwn) {
  const cv::Mat one = scan_picture(scans_of({"sigma_x_m"}, 0.1F, 0.1F));
  const cv::Mat both = scan_picture(scans_of({"sigma_x_m", "sigma_y_m"}, 0.1F, 0.1F));
  const cv::Mat strange = scan_picture(scans_of({"sigma_x_m", "of_tomorrow"}, 0.1F, 0.1F));
  EXPECT_EQ(both.rows, one.rows);
  EXPECT_GT(strange.rows, one.rows + 50);
}

TEST(ScanPicture, ASinglePeakDoesNotFlattenAllElse) {
  const double smooth = row_of_line(scan_picture(scans_of({"residual_m"}, 0.009F, 0.009F)));
  const double peaked = row_of_line(scan_picture(scans_of({"residual_m"}, 0.009F, 5.0F)));
  EXPECT_NEAR(peaked, smooth, 30.0) << "of a panel of 84 pixels";
}

TEST(ScanPicture, OneScanIsEnough) {
  slam::ScanRecords records;
  records.columns = {"inliers", "slipped", "loops_closed"};
  records.stamps = {Stamp{0}};
  records.values = {1.0F, 1.0F, 0.0F};
  EXPECT_GT(scan_picture(records).cols, 1000);
}

}  // namespace
}  // namespace rubble::scenarios
