#include "slam/robust/tracking/scan_diary.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace rubble::slam {

namespace {

double correlation(const Eigen::Matrix3d& covariance, int a, int b) {
  const double variances = covariance(a, a) * covariance(b, b);
  return variances > 0.0 ? covariance(a, b) / std::sqrt(variances) : 0.0;
}

}  // namespace

ScanDiary::ScanDiary()
    : records_{{"inliers",
                "contradiction",
                "residual_m",
                "paired",
                "odometry_chi2",
                "slipped",
                "lost",
                "held",
                "beams",
                "beams_rejected",
                "work_ms",
                "sigma_x_m",
                "sigma_y_m",
                "sigma_heading_deg",
                "rho_x_y",
                "rho_x_heading",
                "rho_y_heading",
                "key_frames",
                "loops_searched",
                "loops_ambiguous",
                "loops_contradicted",
                "loops_needless",
                MapperFigure::kLoopsClosed,
                "near_edges",
                MapperFigure::kLoopsRemoved},
               {},
               {}} {}

void ScanDiary::write(const Entry& entry, const LoopCounts& loops) {
  const robot::LaserScan& scan = entry.scan;
  const auto returns = std::count_if(scan.ranges.begin(), scan.ranges.end(), [&](float range) {
    return std::isfinite(range) && range > 0.0F && static_cast<double>(range) >= scan.range_min;
  });
  const Tracked* tracked = entry.tracked;
  records_.stamps.push_back(entry.reference);
  for (const double value : {tracked != nullptr ? tracked->fit.inliers : 1.0,
                             entry.contradiction,
                             tracked != nullptr ? tracked->fit.residual : 0.0,
                             tracked != nullptr ? static_cast<double>(tracked->fit.paired) : 0.0,
                             tracked != nullptr ? tracked->odometry_chi2 : 0.0,
                             tracked != nullptr && tracked->slipped ? 1.0 : 0.0,
                             tracked != nullptr && tracked->lost ? 1.0 : 0.0,
                             tracked != nullptr && tracked->held ? 1.0 : 0.0,
                             static_cast<double>(returns),
                             static_cast<double>(returns) - static_cast<double>(entry.hits),
                             static_cast<double>(entry.work) * 1e-6,
                             std::sqrt(entry.covariance(0, 0)),
                             std::sqrt(entry.covariance(1, 1)),
                             rad_to_deg(std::sqrt(entry.covariance(2, 2))),
                             correlation(entry.covariance, 0, 1),
                             correlation(entry.covariance, 0, 2),
                             correlation(entry.covariance, 1, 2),
                             static_cast<double>(entry.key_frames),
                             static_cast<double>(loops.searched),
                             static_cast<double>(loops.ambiguous),
                             static_cast<double>(loops.contradicted),
                             static_cast<double>(loops.needless),
                             static_cast<double>(loops.closed),
                             static_cast<double>(loops.near_edges),
                             static_cast<double>(loops.removed)})
    records_.values.push_back(static_cast<float>(value));
}

}  // namespace rubble::slam
