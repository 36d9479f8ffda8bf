#include "scoring/pictures/room_picture.h"

#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/image/png.h"
#include "scoring/pictures/canvas.h"
#include "scoring/room_report.h"

namespace rubble::scoring {
namespace {

const Colour kNoRoom(255, 255, 255);
const Colour kBox(150, 150, 150);
constexpr int kRing = 4;  ///< its radius [pixels]

/// Light colours that differ from label to label: hues a golden angle apart, in three shades.
Colour room_colour(unsigned label) {
  const auto hue = static_cast<unsigned char>(label * 68u % 180u);
  const auto shade = static_cast<unsigned char>(205 + label % 3u * 22u);
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(hue, 85 + label % 2u * 45u, shade));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return bgr.at<Colour>(0, 0);
}

Colour plain_colour(Occupancy cell) {
  if (cell == Occupancy::Free) return kNoRoom;
  return cell == Occupancy::Occupied ? kInk : kUnknown;
}

/// Where a room's name has most room: in its own floor, so that names of rooms around one centre do not meet.
cv::Point middle_of(const cv::Mat& label_of_pixel, unsigned label, cv::Rect box) {
  box &= cv::Rect({0, 0}, label_of_pixel.size());
  const cv::Mat own = label_of_pixel(box) == static_cast<double>(label);
  cv::Mat inside, from_edge;
  cv::copyMakeBorder(own, inside, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(inside, from_edge, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Point at;
  cv::minMaxLoc(from_edge, nullptr, nullptr, nullptr, &at);
  return box.tl() + at - cv::Point(1, 1);
}

}  // namespace

void write_rooms_png(const std::string& path, const OccupancyGrid& map, const Rooms& rooms) {
  if (map.cells().empty()) throw RunError(path + ": a map without cells has no picture");
  std::vector<Colour> colours;
  for (unsigned label = 0; label <= rooms.rooms.size(); ++label) colours.push_back(room_colour(label));
  Canvas canvas(map.frame());
  cv::Mat labels(canvas.map_rows(), canvas.map_columns(), CV_16UC1, cv::Scalar(0));
  for (int row = 0; row < canvas.map_rows(); ++row)
    for (int column = 0; column < canvas.map_columns(); ++column) {
      const mrpt::math::TPoint2D p = canvas.point(column, row);
      const Cell c = rooms.labels.cell(p);
      const Cell in_map = map.cell(p);
      const Occupancy cell = map.inside(in_map) ? map[in_map] : Occupancy::Unknown;
      const std::uint16_t label = rooms.labels.inside(c) && cell != Occupancy::Occupied ? rooms.labels[c] : 0;
      labels.at<std::uint16_t>(row, column) = label;
      canvas.image.at<Colour>(row, column) = label != 0 ? colours[label] : plain_colour(cell);
    }
  const auto box_of = [&](const Room& room) {
    return cv::Rect(canvas.pixel(room.box_min), canvas.pixel(room.box_max));
  };
  for (const Room& room : rooms.rooms) cv::rectangle(canvas.image, box_of(room), cv::Scalar(kBox));
  for (std::size_t i = 0; i < rooms.rooms.size(); ++i) {
    const Room& room = rooms.rooms[i];
    const cv::Point centre = canvas.pixel(room.centre);
    cv::circle(canvas.image, centre, kRing, cv::Scalar(colours[i + 1]), cv::FILLED, cv::LINE_AA);
    cv::circle(canvas.image, centre, kRing, cv::Scalar(kInk), 1, cv::LINE_AA);
    const std::string name = "room " + std::to_string(i + 1);
    const cv::Point middle = middle_of(labels, static_cast<unsigned>(i + 1), box_of(room));
    draw_text(canvas.image, name, middle.x - text_width(name) / 2, middle.y + 4);
  }
  put_axes(canvas.image, canvas.frame, canvas.scale);
  draw_legend(canvas.image,
              {{kInk, "wall"},
               {kNoRoom, "free, of no room"},
               {kUnknown, "unknown"},
               {kBox, "box of a room; ring in its colour: its centre of gravity"}},
              canvas.frame, canvas.scale);
  write_png(path, canvas.image);
}

}  // namespace rubble::scoring
