#include "scoring/measures/beyond_walls.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "scoring/measures/off_truth.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/resample.h"

namespace rubble::scoring {
namespace {

constexpr double kSeam = 0.15;    // in walls: rasters leave such [m]
constexpr double kLeaks = 0.01;   // of the free ground, that a way out would reach
constexpr double kBeyond = 2.0;   // [m]
constexpr double kMuchFar = 0.1;  // of what lies on the truth

/// No way leads from the rim of the canvas to the free ground but through walls.
bool is_closed(const OccupancyGrid& truth) {
  const int rim = static_cast<int>(std::ceil(kSeam / truth.resolution())) + 1;
  cv::Mat walls = cv::Mat::zeros(truth.height() + 2 * rim, truth.width() + 2 * rim, CV_8U);
  cv::Mat free = walls.clone();
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x) {
      walls.at<unsigned char>(y + rim, x + rim) = truth[{x, y}] == Occupancy::Occupied ? 255 : 0;
      free.at<unsigned char>(y + rim, x + rim) = truth[{x, y}] == Occupancy::Free ? 255 : 0;
    }
  const int side = static_cast<int>(std::lround(kSeam / truth.resolution())) + 1;
  cv::morphologyEx(walls, walls, cv::MORPH_CLOSE, cv::Mat::ones(side, side, CV_8U));
  cv::floodFill(walls, {0, 0}, cv::Scalar(128), nullptr, cv::Scalar(), cv::Scalar(), 4);
  const double reached = cv::countNonZero((walls == 128) & free);
  return reached <= kLeaks * cv::countNonZero(free);
}

}  // namespace

double share_beyond_walls(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map) {
  const OffTruth off_truth(truth, kBeyond);
  OccupancyGrid beyond(map.frame());
  double on = 0.0, off = 0.0, far = 0.0;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] == Occupancy::Unknown) continue;
      const double distance = off_truth(T_truth_map(map.centre({x, y})));
      if (distance <= kSurvey) {
        on += 1.0;
        continue;
      }
      off += 1.0;
      far += distance > kBeyond ? 1.0 : 0.0;
      beyond[{x, y}] = map[{x, y}];
    }
  if (far < kMuchFar * on || far == 0.0 || !is_closed(truth)) return 0.0;
  const SightLines drawn(crop_to_known(beyond, 0.0));
  return drawn.usable() && !drawn.bare() ? off / (on + off) : 0.0;
}

}  // namespace rubble::scoring
