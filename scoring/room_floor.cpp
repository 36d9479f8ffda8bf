#include "scoring/room_floor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace rubble::scoring {
namespace {

cv::Mat free_mask(const OccupancyGrid& map) {
  cv::Mat mask(map.height(), map.width(), CV_8U);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) mask.at<unsigned char>(y, x) = map[{x, y}] == Occupancy::Free ? 255 : 0;
  return mask;
}

/// Turns islands of obstacles that are small enough to be furniture into floor.
void clear_clutter(cv::Mat& floor, double resolution, const RoomConfig& config) {
  const cv::Mat obstacles = floor == 0;
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(obstacles, labels, stats, centres, 8);
  std::vector<unsigned char> clutter(static_cast<std::size_t>(count), 0);
  for (int i = 1; i < count; ++i) {
    const int across = std::max(stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    const double area = stats.at<int>(i, cv::CC_STAT_AREA) * resolution * resolution;
    if (area < config.clutter_area && across * resolution < config.clutter_extent)
      clutter[static_cast<std::size_t>(i)] = 255;
  }
  for (int y = 0; y < floor.rows; ++y)
    for (int x = 0; x < floor.cols; ++x)
      floor.at<unsigned char>(y, x) |= clutter[static_cast<std::size_t>(labels.at<int>(y, x))];
}

}  // namespace

RoomFloor room_floor(const OccupancyGrid& map, const RoomConfig& config) {
  RoomFloor out;
  out.resolution = map.resolution();
  out.free = free_mask(map);
  out.cleared = out.free.clone();
  clear_clutter(out.cleared, out.resolution, config);
  out.open = out.cleared.clone();
  const int radius = static_cast<int>(std::lround(0.5 * config.slit / out.resolution));
  if (radius > 0) {
    const cv::Mat disc = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * radius + 1, 2 * radius + 1));
    cv::morphologyEx(out.open, out.open, cv::MORPH_OPEN, disc, cv::Point(-1, -1), 1, cv::BORDER_CONSTANT,
                     cv::Scalar(0));
  }
  cv::rectangle(out.open, cv::Rect(0, 0, out.open.cols, out.open.rows), cv::Scalar(0), 1);
  clear_clutter(out.open, out.resolution, config);  // islands that a slit had joined to a wall may be free now
  return out;
}

}  // namespace rubble::scoring
