#include "scoring/rooms/room_regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace rubble::scoring {
namespace {

constexpr int kGrowth = 7;              // rooms grow so many cells over closed floor
constexpr double kBesidePassage = 4.0;  // a room begins within so many cells of its passage
constexpr std::size_t kLeastHull = 50;  // cells that a hull is taken of

/// Which regions have been joined.
class Joined {
 public:
  explicit Joined(int count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int i) const {
    while (parent_[static_cast<std::size_t>(i)] != i) i = parent_[static_cast<std::size_t>(i)];
    return i;
  }
  void join(int into, int other) { parent_[static_cast<std::size_t>(other)] = into; }

 private:
  std::vector<int> parent_;
};

/// A passage and the regions at its two sides.
struct Door {
  Passage passage;
  int left = 0;
  int right = 0;
};

int beside(const cv::Mat& labels, const Passage& passage, double sign) {
  const cv::Point2d along = (cv::Point2d(passage.b) - cv::Point2d(passage.a)) / passage.width;
  const cv::Point2d middle = 0.5 * (cv::Point2d(passage.a) + cv::Point2d(passage.b));
  for (double d = 1.0; d < kBesidePassage; d += 0.5) {
    const int x = static_cast<int>(std::lround(middle.x - sign * along.y * d));
    const int y = static_cast<int>(std::lround(middle.y + sign * along.x * d));
    if (x < 0 || y < 0 || x >= labels.cols || y >= labels.rows) return 0;
    if (labels.at<int>(y, x) != 0) return labels.at<int>(y, x);
  }
  return 0;
}

/// Small regions join their neighbours, through the widest passage first. `area` [m^2] follows.
Joined join_small(const std::vector<Door>& doors, std::vector<double>& area, double least_area) {
  Joined joined(static_cast<int>(area.size()));
  const auto size = [&](int i) { return area[static_cast<std::size_t>(i)]; };
  while (true) {
    const Door* widest = nullptr;
    for (const Door& door : doors) {
      const int left = joined.root(door.left);
      const int right = joined.root(door.right);
      if (left == right || std::min(size(left), size(right)) >= least_area) continue;
      if (widest == nullptr || door.passage.width > widest->passage.width) widest = &door;
    }
    if (widest == nullptr) return joined;
    const int into = joined.root(widest->left);
    const int other = joined.root(widest->right);
    area[static_cast<std::size_t>(into)] += area[static_cast<std::size_t>(other)];
    joined.join(into, other);
  }
}

/// First and last cell of each row, of cells row by row: no other is a corner of their hull.
std::vector<cv::Point> ends_of_rows(const std::vector<cv::Point>& cells) {
  std::vector<cv::Point> out;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (i == 0 || i + 1 == cells.size() || cells[i - 1].y != cells[i].y || cells[i + 1].y != cells[i].y)
      out.push_back(cells[i]);
  return out;
}

/// The room without what is too narrow to belong to its middle, such as the depth of doors.
std::vector<cv::Point> core_of(const std::vector<cv::Point>& room, const cv::Rect& box, double radius) {
  cv::Mat mask = cv::Mat::zeros(box.height, box.width, CV_8U);
  for (const cv::Point& p : room) mask.at<unsigned char>(p - box.tl()) = 255;
  cv::Mat distance;
  cv::distanceTransform(mask, distance, cv::DIST_L2, cv::DIST_MASK_5);
  double widest = 0.0;
  cv::minMaxLoc(distance, nullptr, &widest);
  if (widest <= radius) return room;  // all of it is narrow
  const cv::Mat away = distance <= radius;
  cv::distanceTransform(away, distance, cv::DIST_L2, cv::DIST_MASK_5);
  std::vector<cv::Point> core;
  for (const cv::Point& p : room)
    if (distance.at<float>(p - box.tl()) <= radius + 0.5) core.push_back(p);
  return core.size() < kLeastHull ? room : core;
}

/// Takes away the niches that reach too deep into the wall, or not deep enough.
void check_depth(const cv::Mat& room, const cv::Mat& parts, const cv::Mat& stats, double resolution,
                 const RoomConfig& config, std::vector<unsigned char>& niche) {
  const int margin = static_cast<int>(std::ceil(config.niche_depth / resolution)) + 1;
  const cv::Rect whole(0, 0, parts.cols, parts.rows);
  for (int part = 1; part < static_cast<int>(niche.size()); ++part) {
    if (niche[static_cast<std::size_t>(part)] == 0) continue;
    const cv::Rect box(stats.at<int>(part, cv::CC_STAT_LEFT) - margin, stats.at<int>(part, cv::CC_STAT_TOP) - margin,
                       stats.at<int>(part, cv::CC_STAT_WIDTH) + 2 * margin,
                       stats.at<int>(part, cv::CC_STAT_HEIGHT) + 2 * margin);
    const cv::Rect around = box & whole;
    cv::Mat distance;
    cv::distanceTransform(room(around) == 0, distance, cv::DIST_L2, cv::DIST_MASK_3);
    double deepest = 0.0;
    cv::minMaxLoc(distance, nullptr, &deepest, nullptr, nullptr, parts(around) == part);
    const double depth = deepest * resolution;
    niche[static_cast<std::size_t>(part)] = depth > config.niche_least && depth < config.niche_depth;
  }
}

/// Obstacles inside the hull of a room that count as its furniture, as a mask over `box`.
cv::Mat niches_of(const RoomRegions& regions, const RoomFloor& floor, int room, const std::vector<cv::Point>& hull,
                  const cv::Rect& box, const RoomConfig& config) {
  std::vector<cv::Point> outline;
  for (const cv::Point& p : hull) outline.push_back(p - box.tl());
  cv::Mat pockets = cv::Mat::zeros(box.height, box.width, CV_8U);
  cv::fillConvexPoly(pockets, outline, cv::Scalar(255));
  const cv::Mat labels = regions.labels(box);
  pockets.setTo(0, labels != 0);
  pockets.setTo(0, floor.free(box));
  cv::Mat parts;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(pockets, parts, stats, centres, 4);
  // Parts of the right size first: few are left for the distances.
  std::vector<unsigned char> niche(static_cast<std::size_t>(count), 0);
  bool any = false;
  for (int part = 1; part < count; ++part) {
    const double area = stats.at<int>(part, cv::CC_STAT_AREA) * floor.resolution * floor.resolution;
    niche[static_cast<std::size_t>(part)] = area < config.niche_area && area > config.niche_least * config.niche_least;
    any = any || niche[static_cast<std::size_t>(part)] != 0;
  }
  if (any) check_depth(labels == room, parts, stats, floor.resolution, config, niche);
  for (int y = 0; y < parts.rows; ++y)
    for (int x = 0; x < parts.cols; ++x)
      if (niche[static_cast<std::size_t>(parts.at<int>(y, x))] == 0) pockets.at<unsigned char>(y, x) = 0;
  return pockets;
}

std::vector<std::vector<cv::Point>> cells_of(const RoomRegions& regions) {
  std::vector<std::vector<cv::Point>> cells(static_cast<std::size_t>(regions.count) + 1);
  for (int y = 0; y < regions.labels.rows; ++y)
    for (int x = 0; x < regions.labels.cols; ++x)
      if (const int room = regions.labels.at<int>(y, x); room != 0)
        cells[static_cast<std::size_t>(room)].push_back({x, y});
  return cells;
}

}  // namespace

RoomRegions separate(const RoomFloor& floor, const std::vector<Passage>& passages, const RoomConfig& config) {
  cv::Mat closed = floor.open.clone();
  close_passages(closed, passages);
  RoomRegions out;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(closed, out.labels, stats, centres, 4);
  std::vector<double> area(static_cast<std::size_t>(count), 0.0);
  for (int i = 1; i < count; ++i)
    area[static_cast<std::size_t>(i)] = stats.at<int>(i, cv::CC_STAT_AREA) * floor.resolution * floor.resolution;
  std::vector<Door> doors;
  for (const Passage& passage : passages) {
    const Door door{passage, beside(out.labels, passage, 1.0), beside(out.labels, passage, -1.0)};
    if (door.left != 0 && door.right != 0 && door.left != door.right) doors.push_back(door);
  }
  const Joined joined = join_small(doors, area, config.least_area);
  for (const Door& door : doors)
    if (joined.root(door.left) != joined.root(door.right)) out.doors.push_back(door.passage);
  std::vector<int> number(static_cast<std::size_t>(count), 0);
  for (int i = 1; i < count; ++i)
    if (joined.root(i) == i && area[static_cast<std::size_t>(i)] >= config.least_isolated)
      number[static_cast<std::size_t>(i)] = ++out.count;
  for (int y = 0; y < out.labels.rows; ++y)
    for (int x = 0; x < out.labels.cols; ++x) {
      int& label = out.labels.at<int>(y, x);
      if (label != 0) label = number[static_cast<std::size_t>(joined.root(label))];
    }
  return out;
}

void grow_regions(RoomRegions& regions, const RoomFloor& floor) {
  cv::Mat& labels = regions.labels;
  std::vector<cv::Point> front;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels.at<int>(y, x) != 0) front.push_back({x, y});
  for (int step = 0; step < kGrowth; ++step) {
    std::vector<cv::Point> next;
    for (const cv::Point& p : front)
      for (const cv::Point& d : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
        const cv::Point q = p + d;
        if (q.x < 0 || q.y < 0 || q.x >= labels.cols || q.y >= labels.rows) continue;
        if (labels.at<int>(q) != 0 || floor.cleared.at<unsigned char>(q) == 0) continue;
        labels.at<int>(q) = labels.at<int>(p);
        next.push_back(q);
      }
    front = std::move(next);
  }
}

void fill_niches(RoomRegions& regions, const RoomFloor& floor, const RoomConfig& config) {
  const std::vector<std::vector<cv::Point>> cells = cells_of(regions);
  cv::Mat filled = regions.labels.clone();
  for (int room = 1; room <= regions.count; ++room) {
    const std::vector<cv::Point>& own = cells[static_cast<std::size_t>(room)];
    if (own.size() < kLeastHull) continue;
    const cv::Rect whole(0, 0, regions.labels.cols, regions.labels.rows);
    const cv::Rect tight = cv::boundingRect(own);
    const cv::Rect box = cv::Rect(tight.x - 1, tight.y - 1, tight.width + 2, tight.height + 2) & whole;
    std::vector<cv::Point> hull;
    cv::convexHull(ends_of_rows(core_of(own, box, config.niche_core / floor.resolution)), hull);
    filled(box).setTo(room, niches_of(regions, floor, room, hull, box, config));
  }
  regions.labels = filled;
}

}  // namespace rubble::scoring
