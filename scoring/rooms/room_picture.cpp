#include "scoring/rooms/room_picture.h"

#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/image/png.h"

namespace rubble::scoring {
namespace {

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
  cv::Mat picture(map.height(), map.width(), CV_8UC3);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const Cell c = rooms.labels.cell(map.centre({x, y}));
      const std::size_t label = rooms.labels.inside(c) ? rooms.labels[c] : 0;
      const Occupancy cell = map[{x, y}];
      picture.at<cv::Vec3b>(map.height() - 1 - y, x) =
          label != 0 && cell != Occupancy::Occupied ? colours[label] : plain_colour(cell);
    }
  for (const Room& room : rooms.rooms) {
    const Cell c = map.cell(room.centre);
    cv::circle(picture, cv::Point(c.x, map.height() - 1 - c.y), 3, cv::Scalar(50, 46, 44), cv::FILLED, cv::LINE_AA);
  }
  write_png(path, picture);
}

}  // namespace rubble::scoring
