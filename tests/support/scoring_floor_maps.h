#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/assignment.h"
#include "base/error.h"
#include "scoring/measures/victims.h"
#include "scoring/rooms/rooms.h"

/// Public floor maps with rooms drawn by hand (ipa_room_segmentation), and how found rooms are compared with them.
namespace rubble::scoring::testing {

constexpr double kFloorMapResolution = 0.05;  ///< [m] a pixel, nominal
constexpr int kLeastRoomPixels = 100;         ///< smaller segments and rooms do not count

struct FloorMap {
  const char* name;
  bool tuned;  ///< the defaults of RoomConfig were chosen on this map
};

inline const std::vector<FloorMap>& floor_maps() {
  static const std::vector<FloorMap> maps = {
      {"lab_a_scan", true},  {"lab_f_scan", true}, {"lab_ipa", true},   {"office_a", true},  {"office_c", true},
      {"lab_c_scan", false}, {"lab_intel", false}, {"office_b", false}, {"office_d", false}, {"office_e", false}};
  return maps;
}

inline cv::Mat read_grey(const std::string& path) {
  cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError(path + ": cannot be read");
  cv::flip(image, image, 0);  // row 0 in the south, as in a grid
  return image;
}

/// Grey 250 and up is free, 170 and down is wall, the rest unknown.
inline OccupancyGrid read_floor_map(const std::string& path) {
  const cv::Mat image = read_grey(path);
  OccupancyGrid grid(GridFrame{image.cols, image.rows, kFloorMapResolution, 0.0, 0.0});
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const int grey = image.at<unsigned char>(y, x);
      grid[{x, y}] = grey >= 250 ? Occupancy::Free : grey <= 170 ? Occupancy::Occupied : Occupancy::Unknown;
    }
  return grid;
}

/// Labels 1 to n of the rooms drawn by hand: what is lighter than 250, 8-connected.
inline cv::Mat read_true_rooms(const std::string& path) {
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(read_grey(path) > 250, labels, stats, centres, 8);
  std::vector<int> number(static_cast<std::size_t>(count), 0);
  int rooms = 0;
  for (int i = 1; i < count; ++i)
    if (stats.at<int>(i, cv::CC_STAT_AREA) > kLeastRoomPixels) number[static_cast<std::size_t>(i)] = ++rooms;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      int& label = labels.at<int>(y, x);
      label = number[static_cast<std::size_t>(label)];
    }
  return labels;
}

struct RoomAgreement {
  double precision = 0.0;  ///< mean over segments of the largest overlap with a true room / the segment's area
  double recall = 0.0;     ///< mean over true rooms of the largest overlap with a segment / the room's area
  double iou = 0.0;        ///< one to one, the best assignment: sum of intersection / union over the true rooms
  double strict = 0.0;     ///< the same over the larger of both numbers: segments too many cost as well
  int segments = 0;
  int rooms = 0;
};

/// Both label images of one size; 0 is no room.
inline RoomAgreement compare_rooms(const Grid<std::uint16_t>& found, const cv::Mat& truth) {
  double last = 0.0;
  cv::minMaxLoc(truth, nullptr, &last);
  const auto rooms = static_cast<std::size_t>(last);
  const std::size_t segments = *std::max_element(found.cells().begin(), found.cells().end());
  std::vector<double> segment_area(segments + 1, 0.0);
  std::vector<double> room_area(rooms + 1, 0.0);
  std::vector<std::vector<double>> overlap(segments + 1, std::vector<double>(rooms + 1, 0.0));
  for (int y = 0; y < truth.rows; ++y)
    for (int x = 0; x < truth.cols; ++x) {
      const std::size_t s = found[{x, y}];
      const auto t = static_cast<std::size_t>(truth.at<int>(y, x));
      segment_area[s] += 1.0;
      room_area[t] += 1.0;
      overlap[s][t] += 1.0;
    }
  RoomAgreement out;
  out.rooms = static_cast<int>(rooms);
  std::vector<std::size_t> counted;
  for (std::size_t s = 1; s <= segments; ++s)
    if (segment_area[s] > kLeastRoomPixels) counted.push_back(s);
  out.segments = static_cast<int>(counted.size());
  const std::size_t side = std::max(counted.size(), rooms);
  if (counted.empty() || rooms == 0) return out;
  std::vector<std::vector<double>> cost(side, std::vector<double>(side, 0.0));
  for (std::size_t i = 0; i < counted.size(); ++i) {
    const std::size_t s = counted[i];
    out.precision += *std::max_element(overlap[s].begin() + 1, overlap[s].end()) / segment_area[s];
    for (std::size_t t = 1; t <= rooms; ++t)
      cost[i][t - 1] = -overlap[s][t] / (segment_area[s] + room_area[t] - overlap[s][t]);
  }
  for (std::size_t t = 1; t <= rooms; ++t) {
    double best = 0.0;
    for (const std::size_t s : counted) best = std::max(best, overlap[s][t]);
    out.recall += best / room_area[t];
  }
  const std::vector<std::size_t> column = assign(cost);
  double sum = 0.0;
  for (std::size_t i = 0; i < side; ++i) sum -= cost[i][column[i]];
  out.precision /= static_cast<double>(counted.size());
  out.recall /= static_cast<double>(rooms);
  out.iou = sum / static_cast<double>(rooms);
  out.strict = sum / static_cast<double>(side);
  return out;
}

}  // namespace rubble::scoring::testing
