#include "scoring/rooms/passages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>

#include "base/angle.h"
#include "scoring/walls/wall_contours.h"

namespace rubble::scoring {
namespace {

constexpr int kRays = 32;               // of a half disc
constexpr double kEndCells = 1.5;       // of a passage lie on the walls it joins
constexpr std::size_t kNeighbours = 3;  // a nearest point is nearer than so many on both sides along the wall
constexpr double kDetour = 1.5;         // along one wall it is so many times further than across a passage
const double kIntoRoom[] = {0.06, 0.2, 0.4, 0.6};  // where the half disc is laid: doors may be as deep as walls [m]

bool before(const cv::Point& a, const cv::Point& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }

bool narrower(const Passage& p, const Passage& q) {
  if (p.width != q.width) return p.width < q.width;
  return p.a == q.a ? before(p.b, q.b) : before(p.a, q.a);
}

/// All points of the walls by where they lie: what is near one place is found without asking the others.
class NearWalls {
 public:
  struct Point {
    std::size_t wall = 0;
    std::size_t index = 0;
  };
  NearWalls(const std::vector<WallContour>& walls, const cv::Size& floor)
      : columns_(floor.width / kEdge + 1), buckets_(static_cast<std::size_t>(columns_ * (floor.height / kEdge + 1))) {
    for (std::size_t w = 0; w < walls.size(); ++w)
      for (std::size_t i = 0; i < walls[w].size(); ++i)
        buckets_[static_cast<std::size_t>(walls[w][i].y / kEdge * columns_ + walls[w][i].x / kEdge)].push_back({w, i});
  }
  /// Calls `visit` for all points in the buckets that a square around `centre` meets.
  template <class Visit>
  void around(const cv::Point& centre, int reach, const Visit& visit) const {
    const int rows = static_cast<int>(buckets_.size()) / columns_;
    const int last_x = std::min(columns_ - 1, (centre.x + reach) / kEdge);
    const int last_y = std::min(rows - 1, (centre.y + reach) / kEdge);
    for (int y = std::max(0, centre.y - reach) / kEdge; y <= last_y; ++y)
      for (int x = std::max(0, centre.x - reach) / kEdge; x <= last_x; ++x)
        for (const Point& point : buckets_[static_cast<std::size_t>(y * columns_ + x)]) visit(point);
  }

 private:
  static constexpr int kEdge = 32;  // of a bucket [cells]
  int columns_;
  std::vector<std::vector<Point>> buckets_;
};

int squared(const cv::Point& p) { return p.dot(p); }

/// Whether a passage from the corner may end at point `i` of a wall, as far off as the root of `d2`: the nearest
/// there, and no way along the same wall.
bool may_end(const WallCorner& corner, const WallContour& wall, std::size_t i, bool same_wall, int d2) {
  const std::size_t n = wall.size();
  const auto distance2 = [&](std::size_t k) { return squared(wall[k % n] - corner.at); };
  if (distance2(i + n - 1) == d2) return false;
  for (std::size_t j = 1; j <= kNeighbours; ++j)
    if (distance2(i + j) < d2 || distance2(i + kNeighbours * n - j) < d2) return false;
  if (!same_wall) return true;
  const std::size_t along = i > corner.index ? i - corner.index : corner.index - i;
  return static_cast<double>(std::min(along, n - along)) >= kDetour * std::sqrt(d2);
}

std::vector<WallCorner> corners_of(const std::vector<WallContour>& walls, double resolution, const RoomConfig& config) {
  const int scale = std::max(3, static_cast<int>(std::lround(config.turn_scale / resolution)));
  return wall_corners(walls, scale, config.least_turn);
}

std::vector<Passage> candidates(const cv::Mat& floor, double resolution, const RoomConfig& config) {
  const std::vector<WallContour> walls = wall_contours(floor);
  const NearWalls near(walls, floor.size());
  const double narrowest = config.narrowest / resolution;
  const double widest = config.widest / resolution;
  const int most2 = static_cast<int>(std::ceil(widest * widest)) + 1;
  std::vector<Passage> out;
  for (const WallCorner& corner : corners_of(walls, resolution, config))
    near.around(corner.at, static_cast<int>(std::ceil(widest)), [&](const NearWalls::Point& point) {
      const WallContour& wall = walls[point.wall];
      const cv::Point& end = wall[point.index];
      const int d2 = squared(end - corner.at);
      if (d2 > most2) return;
      const double d = std::sqrt(d2);
      if (d < narrowest || d > widest || !may_end(corner, wall, point.index, point.wall == corner.contour, d2)) return;
      if (sees(floor, corner.at, end, kEndCells)) out.push_back({corner.at, end, d});
    });
  std::sort(out.begin(), out.end(), narrower);
  return out;
}

/// The middle of a passage, the direction into one of its sides, and rays over the half disc there.
struct Side {
  cv::Point2d middle;
  cv::Point2d into;
  std::array<cv::Point2d, kRays> rays;
};

Side side_of(const Passage& passage, double sign) {
  const cv::Point2d along = (cv::Point2d(passage.b) - cv::Point2d(passage.a)) / passage.width;
  Side out{0.5 * (cv::Point2d(passage.a) + cv::Point2d(passage.b)), sign * cv::Point2d(-along.y, along.x), {}};
  const double ahead = std::atan2(out.into.y, out.into.x);
  for (int k = 0; k < kRays; ++k) {
    const double angle = ahead - 0.5 * kPi + kPi * (k + 0.5) / kRays;
    out.rays[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
  }
  return out;
}

/// `share` of the half disc around `origin` is seen. Rays are sent only until that is settled.
bool is_seen(const cv::Mat& floor, const cv::Point2d& origin, const Side& side, double radius, double share) {
  constexpr double kRounding = 1e-9;
  double area = 0.0;
  int left = kRays;
  for (const cv::Point2d& ray : side.rays) {
    const double r = sight(floor, origin, ray.x, ray.y, radius) / radius;
    area += r * r;
    if (area / kRays >= share) return true;
    if ((area + --left) / kRays < share - kRounding) return false;
  }
  return false;
}

/// Enough of a half disc in front of the passage can be seen, from one of several places a little into the room,
/// because the depth of a door in a thick wall hides the room.
bool is_open(const cv::Mat& floor, const Side& side, double radius, double resolution, double share) {
  for (const double metres : kIntoRoom) {
    const double step = metres / resolution;
    if (sight(floor, side.middle, side.into.x, side.into.y, step + 0.5) < step) return false;
    if (is_seen(floor, side.middle + step * side.into, side, radius, share)) return true;
  }
  return false;
}

bool is_door(const cv::Mat& floor, const Passage& passage, double resolution, const RoomConfig& config) {
  const double radius = std::max(config.least_reach / resolution, passage.width);
  return is_open(floor, side_of(passage, 1.0), radius, resolution, config.openness) &&
         is_open(floor, side_of(passage, -1.0), radius, resolution, config.openness);
}

/// Largest distance to a wall among the places seen on one side [cells].
double half_width(const cv::Mat& floor, const cv::Mat& clearance, const Side& side, double reach) {
  double best = 0.0;
  for (const cv::Point2d& ray : side.rays) {
    const double seen = sight(floor, side.middle, ray.x, ray.y, reach);
    for (double t = 0.0; t < seen; t += 2.0) {
      const cv::Point2d p = side.middle + t * ray;
      best = std::max(best, static_cast<double>(clearance.at<float>(nearest_whole(p.y), nearest_whole(p.x))));
    }
  }
  return best;
}

bool is_corridor_end(const cv::Mat& floor, const cv::Mat& clearance, const Passage& passage, double resolution,
                     const RoomConfig& config) {
  const double metres = passage.width * resolution;
  if (metres < config.corridor_min || metres > config.corridor_max) return false;
  Side hall = side_of(passage, 1.0);
  Side corridor = side_of(passage, -1.0);
  const double depth = config.corridor_depth * passage.width;
  const auto is_deep = [&](const Side& side) {
    return sight(floor, side.middle, side.into.x, side.into.y, depth) >= depth;
  };
  if (!is_deep(hall) && !is_deep(corridor)) return false;  // the quick question first
  double widest = half_width(floor, clearance, hall, config.hall_reach * passage.width);
  const double other = half_width(floor, clearance, corridor, config.hall_reach * passage.width);
  if (other > widest) {
    std::swap(hall, corridor);
    widest = other;
  }
  if (widest < config.hall_ratio * 0.5 * passage.width) return false;
  return is_deep(corridor);
}

}  // namespace

void close_passages(cv::Mat& floor, const std::vector<Passage>& passages) {
  for (const Passage& passage : passages) cv::line(floor, passage.a, passage.b, cv::Scalar(0), 1, cv::LINE_4);
}

std::size_t count_corners(const cv::Mat& floor, double resolution, const RoomConfig& config) {
  return corners_of(wall_contours(floor), resolution, config).size();
}

std::vector<Passage> find_passages(const cv::Mat& floor, double resolution, const RoomConfig& config,
                                   std::vector<Passage> given, const std::function<bool(const Passage&)>& may_be) {
  std::vector<Passage> lines = candidates(floor, resolution, config);
  if (may_be)
    lines.erase(std::remove_if(lines.begin(), lines.end(), [&](const Passage& line) { return !may_be(line); }),
                lines.end());
  cv::Mat closed = floor.clone();
  close_passages(closed, given);
  std::vector<Passage> out = std::move(given);
  const auto take = [&](const Passage& line) {
    out.push_back(line);
    close_passages(closed, {line});
  };
  for (const Passage& line : lines)
    if (sees(closed, line.a, line.b, kEndCells) && is_door(closed, line, resolution, config)) take(line);
  cv::Mat clearance;
  cv::distanceTransform(closed, clearance, cv::DIST_L2, cv::DIST_MASK_5);
  for (const Passage& line : lines)
    if (sees(closed, line.a, line.b, kEndCells) && is_corridor_end(closed, clearance, line, resolution, config))
      take(line);
  return out;
}

}  // namespace rubble::scoring
