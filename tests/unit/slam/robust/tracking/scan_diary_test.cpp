#include "slam/robust/tracking/scan_diary.h"

#include <gtest/gtest.h>

namespace rubble::slam {
namespace {

TEST(ScanDiary, ColumnsThatOthersReadHaveTheirNames) {
  const ScanDiary diary;
  const auto& columns = diary.records().columns;
  EXPECT_EQ(columns.at(kInliersColumn), "inliers");
  EXPECT_EQ(columns.at(kContradictionColumn), "contradiction");
  EXPECT_EQ(columns.at(kBeamsColumn), "beams");
  EXPECT_EQ(columns.at(kRejectedColumn), "beams_rejected");
}

}  // namespace
}  // namespace rubble::slam
