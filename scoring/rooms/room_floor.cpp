#include "scoring/rooms/room_floor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "scoring/walls/overlap.h"

namespace rubble::scoring {
namespace {

cv::Mat mask_of(const OccupancyGrid& map, Occupancy what) {
  cv::Mat mask(map.height(), map.width(), CV_8U);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) mask.at<unsigned char>(y, x) = map[{x, y}] == what ? 255 : 0;
  return mask;
}

/// Walls of one cell have holes and steps where a map was turned: they are drawn as three.
void thicken_thin_walls(const OccupancyGrid& map, cv::Mat& floor) {
  constexpr double kThin = 0.8;  // half of their thickness [cells]
  if (wall_half_thickness(map) >= kThin * map.resolution()) return;
  cv::Mat walls;
  cv::dilate(mask_of(map, Occupancy::Occupied), walls, cv::Mat::ones(3, 3, CV_8U));
  floor.setTo(0, walls);
}

/// Walls of one cell that do not lie along the grid touch by their corners, and contours of the floor would lead
/// between them: of two such floor cells the lower one is shut.
void shut_diagonal_gaps(cv::Mat& floor) {
  for (int y = 0; y + 1 < floor.rows; ++y) {
    unsigned char* low = floor.ptr(y);
    unsigned char* high = floor.ptr(y + 1);
    for (int x = 0; x + 1 < floor.cols; ++x) {
      if (low[x] == 0 && high[x + 1] == 0 && low[x + 1] != 0 && high[x] != 0) low[x + 1] = 0;
      if (low[x] != 0 && high[x + 1] != 0 && low[x + 1] == 0 && high[x] == 0) low[x] = 0;
    }
  }
}

/// Connected parts of the non-zero cells of a mask.
struct Parts {
  explicit Parts(const cv::Mat& mask) {
    cv::Mat centres;
    count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8);
  }
  int at(int x, int y) const { return labels.at<int>(y, x); }
  int area(int part) const { return stats.at<int>(part, cv::CC_STAT_AREA); }
  int across(int part) const {
    return std::max(stats.at<int>(part, cv::CC_STAT_WIDTH), stats.at<int>(part, cv::CC_STAT_HEIGHT));
  }
  cv::Mat labels;
  cv::Mat stats;
  int count = 0;
};

/// Turns islands of obstacles that are small enough to be furniture into floor. Small islands in a row, each near the
/// next, stay: they are the dots of a wall that a noisy sensor drew.
void clear_clutter(cv::Mat& floor, double resolution, const RoomConfig& config) {
  const Parts islands(floor == 0);
  std::vector<unsigned char> is_small(static_cast<std::size_t>(islands.count), 0);
  for (int i = 1; i < islands.count; ++i)
    if (islands.area(i) * resolution * resolution < config.clutter_area &&
        islands.across(i) * resolution < config.clutter_extent)
      is_small[static_cast<std::size_t>(i)] = 255;
  cv::Mat small(floor.size(), CV_8U);
  for (int y = 0; y < floor.rows; ++y)
    for (int x = 0; x < floor.cols; ++x)
      small.at<unsigned char>(y, x) = is_small[static_cast<std::size_t>(islands.at(x, y))];
  const int reach = std::max(1, static_cast<int>(std::lround(config.dots_reach / resolution)));
  cv::Mat joined;
  cv::dilate(small, joined, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  const Parts rows(joined);
  for (int y = 0; y < floor.rows; ++y)
    for (int x = 0; x < floor.cols; ++x)
      if (small.at<unsigned char>(y, x) != 0 &&
          (rows.across(rows.at(x, y)) - 2 * reach) * resolution < config.clutter_extent)
        floor.at<unsigned char>(y, x) = 255;
}

}  // namespace

RoomFloor room_floor(const OccupancyGrid& map, const RoomConfig& config) {
  RoomFloor out;
  out.resolution = map.resolution();
  out.free = mask_of(map, Occupancy::Free);
  out.cleared = out.free.clone();
  shut_diagonal_gaps(out.cleared);
  clear_clutter(out.cleared, out.resolution, config);
  out.open = out.cleared.clone();
  thicken_thin_walls(map, out.open);
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
