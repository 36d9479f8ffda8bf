#include "slam/robust/tracking/scan_diary.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/angle.h"

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

/// Sigmas and correlations together are the covariance of the pose.
TEST(ScanDiary, TheCovarianceCanBeReadBack) {
  const Eigen::Matrix3d A = (Eigen::Matrix3d() << 0.02, 0.01, -0.004, 0.0, 0.03, 0.01, 0.002, 0.0, 0.01).finished();
  const Eigen::Matrix3d covariance = A * A.transpose();
  ScanDiary diary;
  robot::LaserScan scan;
  ScanDiary::Entry entry{Stamp::from_seconds(1.0), scan};
  entry.covariance = covariance;
  diary.write(entry, {});
  entry.covariance.setZero();
  diary.write(entry, {});
  const ScanRecords& records = diary.records();
  const auto value = [&](const char* name, std::size_t row) {
    const auto column = std::find(records.columns.begin(), records.columns.end(), name) - records.columns.begin();
    return static_cast<double>(records.values.at(row * records.columns.size() + static_cast<std::size_t>(column)));
  };
  for (const std::size_t row : {0U, 1U}) {
    const Eigen::Vector3d sigmas(value("sigma_x_m", row), value("sigma_y_m", row),
                                 deg_to_rad(value("sigma_heading_deg", row)));
    Eigen::Matrix3d rho = Eigen::Matrix3d::Identity();
    rho(0, 1) = rho(1, 0) = value("rho_x_y", row);
    rho(0, 2) = rho(2, 0) = value("rho_x_heading", row);
    rho(1, 2) = rho(2, 1) = value("rho_y_heading", row);
    const Eigen::Matrix3d read = sigmas.asDiagonal() * rho * sigmas.asDiagonal();
    EXPECT_LT((read - (row == 0 ? covariance : Eigen::Matrix3d::Zero())).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace rubble::slam
