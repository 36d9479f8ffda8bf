#include "scoring/rooms/room_picture.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/error.h"
#include "base/image/png.h"

namespace rubble::scoring {
namespace {

constexpr int kWide = 1500, kMostZoom = 4;  ///< [pixels], and a cell's

/// Light colours that differ from label to label: hues a golden angle apart, in three shades.
cv::Vec3b room_colour(unsigned label) {
  const auto hue = static_cast<unsigned char>(label * 68u % 180u);
  const auto shade = static_cast<unsigned char>(205 + label % 3u * 22u);
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(hue, 85 + label % 2u * 45u, shade));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return bgr.at<cv::Vec3b>(0, 0);
}

cv::Vec3b plain_colour(Occupancy cell) {
  if (cell == Occupancy::Free) return {255, 255, 255};
  return cell == Occupancy::Occupied ? cv::Vec3b(50, 46, 44) : cv::Vec3b(206, 206, 206);
}

}  // namespace

void write_rooms_png(const std::string& path, const OccupancyGrid& map, const Rooms& rooms) {
  if (map.cells().empty()) throw RunError(path + ": a map without cells has no picture");
  std::vector<cv::Vec3b> colours;
  for (unsigned label = 0; label <= rooms.rooms.size(); ++label) colours.push_back(room_colour(label));
  // Names take room: small maps are drawn larger.
  const int zoom = std::clamp(kWide / std::max(map.width(), map.height()), 1, kMostZoom);
  cv::Mat cells(map.height(), map.width(), CV_8UC3);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const Cell c = rooms.labels.cell(map.centre({x, y}));
      const std::size_t label = rooms.labels.inside(c) ? rooms.labels[c] : 0;
      const Occupancy cell = map[{x, y}];
      cells.at<cv::Vec3b>(map.height() - 1 - y, x) =
          label != 0 && cell != Occupancy::Occupied ? colours[label] : plain_colour(cell);
    }
  cv::Mat picture;
  cv::resize(cells, picture, {}, zoom, zoom, cv::INTER_NEAREST);
  const auto pixel = [&](const mrpt::math::TPoint2D& p) {
    const Cell c = map.cell(p);
    return cv::Point(c.x, map.height() - 1 - c.y) * zoom;
  };
  const cv::Scalar ink(50, 46, 44);
  for (std::size_t i = 0; i < rooms.rooms.size(); ++i) {
    const Room& room = rooms.rooms[i];
    cv::rectangle(picture, pixel(room.box_min), pixel(room.box_max), cv::Scalar(150, 150, 150));
    const cv::Point centre = pixel(room.centre);
    cv::circle(picture, centre, 3, ink, cv::FILLED, cv::LINE_AA);
    cv::putText(picture, "room " + std::to_string(i + 1), centre + cv::Point(6, -4), cv::FONT_HERSHEY_SIMPLEX, 0.4, ink,
                1, cv::LINE_AA);
  }
  write_png(path, picture);
}

}  // namespace rubble::scoring
