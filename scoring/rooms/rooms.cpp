#include "scoring/rooms/rooms.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "base/planar.h"
#include "scoring/rooms/passages.h"
#include "scoring/rooms/room_clusters.h"
#include "scoring/rooms/room_floor.h"
#include "scoring/rooms/room_regions.h"
#include "scoring/walls/resample.h"

namespace rubble::scoring {
namespace {

constexpr int kMostRooms = 65535;
constexpr double kElongationWeight = 0.5;  // of d(f, g) against the area's logarithm
constexpr double kShapeWeight = 2.0;

/// By how many cells of the map one is wide that is small enough for a door and large enough for the time there is.
int cells_in_one(const GridFrame& frame, const RoomConfig& config) {
  int shrink = std::max(1, static_cast<int>(config.finest / frame.resolution + 1e-6));
  const auto cells = [&](int by) { return frame.size() / static_cast<std::size_t>(by) / static_cast<std::size_t>(by); };
  while (cells(shrink) > config.most_cells) ++shrink;
  return shrink;
}

OccupancyGrid shrunk(const OccupancyGrid& map, int by) {
  GridFrame frame = map.frame();
  frame.resolution *= by;
  frame.width = (frame.width + by - 1) / by;
  frame.height = (frame.height + by - 1) / by;
  return resample(map, {}, frame);
}

mrpt::math::TPoint2D middle_of_cell(const cv::Point& cell, const GridFrame& frame) {
  return {frame.x0 + (cell.x + 0.5) * frame.resolution, frame.y0 + (cell.y + 0.5) * frame.resolution};
}

/// Describes one room from its mask; `corner` is the mask's first cell in `frame`.
Room describe(const cv::Mat& mask, const cv::Rect& box, const GridFrame& frame) {
  const double cell = frame.resolution;
  const cv::Moments m = cv::moments(mask, true);
  Room room;
  room.centre = {frame.x0 + (box.x + m.m10 / m.m00 + 0.5) * cell, frame.y0 + (box.y + m.m01 / m.m00 + 0.5) * cell};
  room.box_min = {frame.x0 + box.x * cell, frame.y0 + box.y * cell};
  room.box_max = {room.box_min.x + box.width * cell, room.box_min.y + box.height * cell};
  room.area = m.m00 * cell * cell;
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask.clone(), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  for (const auto& outline : outlines) room.perimeter = std::max(room.perimeter, cv::arcLength(outline, true) * cell);
  const double xx = m.mu20 / m.m00 + 1.0 / 12.0;  // a cell is a square, not a point
  const double yy = m.mu02 / m.m00 + 1.0 / 12.0;
  const double xy = m.mu11 / m.m00;
  const double root = std::hypot(0.5 * (xx - yy), xy);
  room.elongation = std::sqrt((0.5 * (xx + yy) + root) / (0.5 * (xx + yy) - root));
  room.direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  double hu[7];
  cv::HuMoments(m, hu);
  room.shape = {hu[0], std::sqrt(std::abs(hu[1])), std::sqrt(std::abs(hu[2])), std::sqrt(std::abs(hu[3]))};
  return room;
}

/// Boxes and sizes of the regions, then their order: largest first.
std::vector<int> by_size(const RoomRegions& regions, std::vector<cv::Rect>& boxes) {
  std::vector<std::size_t> size(static_cast<std::size_t>(regions.count) + 1, 0);
  std::vector<cv::Rect> found(size.size());
  for (int y = 0; y < regions.labels.rows; ++y)
    for (int x = 0; x < regions.labels.cols; ++x) {
      const auto label = static_cast<std::size_t>(regions.labels.at<int>(y, x));
      if (label == 0) continue;
      found[label] = ++size[label] == 1 ? cv::Rect(x, y, 1, 1) : found[label] | cv::Rect(x, y, 1, 1);
    }
  std::vector<int> order;
  for (int label = 1; label <= regions.count; ++label)
    if (size[static_cast<std::size_t>(label)] != 0) order.push_back(label);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)]; });
  if (order.size() > kMostRooms) order.resize(kMostRooms);
  boxes = std::move(found);
  return order;
}

Rooms describe_all(const RoomRegions& regions, const GridFrame& frame) {
  Rooms out;
  out.labels = Grid<std::uint16_t>(frame, 0);
  for (const Passage& door : regions.doors)
    out.doors.push_back({middle_of_cell(door.a, frame), middle_of_cell(door.b, frame)});
  std::vector<cv::Rect> boxes;
  const std::vector<int> order = by_size(regions, boxes);
  std::vector<std::uint16_t> number(boxes.size(), 0);
  for (const int label : order) {
    const cv::Rect& box = boxes[static_cast<std::size_t>(label)];
    out.rooms.push_back(describe(regions.labels(box) == label, box, frame));
    number[static_cast<std::size_t>(label)] = static_cast<std::uint16_t>(out.rooms.size());
  }
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      out.labels[{x, y}] = number[static_cast<std::size_t>(regions.labels.at<int>(y, x))];
  return out;
}

bool has_too_many_corners(const RoomFloor& floor, const RoomConfig& config) {
  return config.method == RoomMethod::Passages &&
         count_corners(floor.open, floor.resolution, config) > config.most_corners;
}

Rooms without_rooms() {
  Rooms none;
  none.too_many_corners = true;
  return none;
}

Rooms finished(RoomRegions regions, const RoomFloor& floor, const GridFrame& frame, const RoomConfig& config) {
  grow_regions(regions, floor);
  fill_niches(regions, floor, config);
  return describe_all(regions, frame);
}

Rooms rooms_on(const RoomFloor& floor, const GridFrame& frame, const RoomConfig& config) {
  if (has_too_many_corners(floor, config)) return without_rooms();
  return finished(config.method == RoomMethod::Passages
                      ? separate(floor, find_passages(floor.open, floor.resolution, config), config)
                      : cluster_rooms(floor, config),
                  floor, frame, config);
}

/// The division of the truth, asked in cells of a map that lies on it.
class TruthsDivision {
 public:
  TruthsDivision(const Rooms& truth, const mrpt::math::TPose2D& T_truth_map, const cv::Mat& floor,
                 const GridFrame& frame)
      : truth_(truth), T_(T_truth_map), floor_(floor), frame_(frame) {}

  /// The truth's doors at whose ends the map has walls, drawn from wall to wall.
  std::vector<Passage> doors() const {
    std::vector<Passage> out;
    for (const RoomDoor& door : truth_.doors) {
      const auto a = wall_near(T_.inverse(door.a)), b = wall_near(T_.inverse(door.b));
      if (!a || !b || *a == *b) continue;
      const cv::Point across = *b - *a;
      out.push_back({*a, *b, std::hypot(across.x, across.y)});
    }
    return out;
  }

  /// Whether the truth has that opening, between the same walls, within one of its rooms.
  bool is_within_a_room(const Passage& line) const {
    constexpr int kAsked = 8;  // places along its middle
    constexpr double kEnd = 0.2;
    const mrpt::math::TPoint2D a = T_(middle_of_cell(line.a, frame_)), b = T_(middle_of_cell(line.b, frame_));
    const std::uint16_t room = room_at(a + (b - a) * 0.5);
    if (room == 0) return false;
    for (int i = 0; i <= kAsked; ++i)
      if (room_at(a + (b - a) * (kEnd + (1.0 - 2.0 * kEnd) * i / kAsked)) != room) return false;
    return room_ends_near(a, room) && room_ends_near(b, room);
  }

 private:
  static constexpr double kSameWall = 0.25;  // walls so far apart may be one, drawn a little off [m]

  std::uint16_t room_at(const mrpt::math::TPoint2D& p) const {
    const Cell c = truth_.labels.cell(p);
    return truth_.labels.inside(c) ? truth_.labels[c] : std::uint16_t{0};
  }
  bool room_ends_near(const mrpt::math::TPoint2D& p, std::uint16_t room) const {
    const double step = truth_.labels.resolution();
    const int reach = static_cast<int>(std::lround(kSameWall / step));
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (x * x + y * y <= reach * reach && room_at({p.x + x * step, p.y + y * step}) != room) return true;
    return false;
  }
  std::optional<cv::Point> wall_near(const mrpt::math::TPoint2D& p_map) const {
    const Cell at = frame_.cell(p_map);
    const int reach = static_cast<int>(std::lround(kSameWall / frame_.resolution));
    int least = reach * reach + 1;
    std::optional<cv::Point> out;
    for (int y = at.y - reach; y <= at.y + reach; ++y)
      for (int x = at.x - reach; x <= at.x + reach; ++x) {
        const int d2 = (x - at.x) * (x - at.x) + (y - at.y) * (y - at.y);
        const bool inside = x >= 0 && y >= 0 && x < floor_.cols && y < floor_.rows;
        if (d2 >= least || !inside || floor_.at<unsigned char>(y, x) != 0) continue;
        least = d2;
        out = cv::Point(x, y);
      }
    return out;
  }

  const Rooms& truth_;
  PlanarTransform T_;
  const cv::Mat& floor_;
  const GridFrame& frame_;
};

}  // namespace

Rooms extract_rooms(const OccupancyGrid& map, const RoomConfig& config) {
  if (map.cells().empty()) return {};
  const int by = cells_in_one(map.frame(), config);
  if (by == 1) return rooms_on(room_floor(map, config), map.frame(), config);
  const OccupancyGrid grid = shrunk(map, by);
  return rooms_on(room_floor(grid, config), grid.frame(), config);
}

Rooms extract_rooms(const OccupancyGrid& map, const RoomFloor& floor_of_map, const RoomConfig& config) {
  if (map.cells().empty() || cells_in_one(map.frame(), config) != 1) return extract_rooms(map, config);
  return rooms_on(floor_of_map, map.frame(), config);
}

Rooms extract_rooms_as(const OccupancyGrid& map, const Rooms& truth, const mrpt::math::TPose2D& T_truth_map,
                       const RoomConfig& config) {
  if (map.cells().empty()) return {};
  RoomConfig by_passages = config;
  by_passages.method = RoomMethod::Passages;
  const int by = cells_in_one(map.frame(), by_passages);
  const OccupancyGrid grid = by == 1 ? map : shrunk(map, by);
  const RoomFloor floor = room_floor(grid, by_passages);
  if (has_too_many_corners(floor, by_passages)) return without_rooms();
  const TruthsDivision division(truth, T_truth_map, floor.open, grid.frame());
  const std::vector<Passage> passages =
      find_passages(floor.open, floor.resolution, by_passages, division.doors(),
                    [&](const Passage& line) { return !division.is_within_a_room(line); });
  return finished(separate(floor, passages, by_passages), floor, grid.frame(), by_passages);
}

double room_difference(const Room& f, const Room& g) {
  double shape = 0.0;
  for (std::size_t i = 0; i < f.shape.size(); ++i) shape += std::abs(f.shape[i] - g.shape[i]);
  return std::abs(std::log(f.area / g.area)) + kElongationWeight * std::abs(std::log(f.elongation / g.elongation)) +
         kShapeWeight * shape;
}

}  // namespace rubble::scoring
