#include "scoring/rooms/room_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "scoring/walls/wall_contours.h"

namespace rubble::scoring {
namespace {

constexpr std::size_t kLeastPoints = 5;  // of a room's outline

/// The cell reached from a wall cell by always stepping to the neighbour farthest from walls.
cv::Point into_floor(const cv::Mat& clearance, cv::Point p, double offset) {
  while (clearance.at<float>(p) < offset) {
    cv::Point best = p;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const cv::Point q(std::clamp(p.x + dx, 0, clearance.cols - 1), std::clamp(p.y + dy, 0, clearance.rows - 1));
        if (clearance.at<float>(q) > clearance.at<float>(best)) best = q;
      }
    if (best == p) break;
    p = best;
  }
  return p;
}

/// Like `sees`, but some obstacle cells may stand in the way.
bool sees_past(const cv::Mat& floor, const cv::Point& a, const cv::Point& b, int phantoms) {
  cv::LineIterator line(floor, a, b, 8);
  int blocked = 0;
  for (int i = 0; i < line.count; ++i, ++line)
    if (**line == 0 && ++blocked > phantoms) return false;
  return true;
}

/// Similarities of all pairs of clusters, kept up while they join.
class Linkage {
 public:
  explicit Linkage(const VisibilityMatrix& seen) : n_(seen.size), size_(seen.size, 1), value_(n_ * n_, 0.0f) {
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = i + 1; j < n_; ++j) value_[i * n_ + j] = value_[j * n_ + i] = jaccard(seen, i, j);
  }
  /// Neither joined to another nor finished.
  bool open(std::size_t i) const { return size_[i] != 0; }
  void finish(std::size_t i) { size_[i] = 0; }
  float at(std::size_t i, std::size_t j) const { return value_[i * n_ + j]; }
  /// The most similar open cluster; of equals `preferred`, or i when there is none.
  std::size_t nearest(std::size_t i, std::size_t preferred) const {
    std::size_t best = preferred;
    float most = preferred == i ? -1.0f : at(i, preferred);
    for (std::size_t j = 0; j < n_; ++j)
      if (j != i && open(j) && at(i, j) > most) {
        most = at(i, j);
        best = j;
      }
    return best;
  }
  /// `other` becomes part of `into`; mean over all pairs of members.
  void join(std::size_t into, std::size_t other) {
    const auto a = static_cast<float>(size_[into]);
    const auto b = static_cast<float>(size_[other]);
    for (std::size_t k = 0; k < n_; ++k) {
      if (!open(k) || k == into || k == other) continue;
      const float mean = (a * at(into, k) + b * at(other, k)) / (a + b);
      value_[into * n_ + k] = value_[k * n_ + into] = mean;
    }
    size_[into] += size_[other];
    size_[other] = 0;
  }

 private:
  static float jaccard(const VisibilityMatrix& seen, std::size_t i, std::size_t j) {
    int both = 0;
    int any = 0;
    const std::uint64_t* const a = &seen.bits[i * seen.words];
    const std::uint64_t* const b = &seen.bits[j * seen.words];
    for (std::size_t w = 0; w < seen.words; ++w) {
      both += __builtin_popcountll(a[w] & b[w]);
      any += __builtin_popcountll(a[w] | b[w]);
    }
    return any == 0 ? 0.0f : static_cast<float>(both) / static_cast<float>(any);
  }

  std::size_t n_;
  std::vector<std::size_t> size_;  // 0: joined to another, or finished
  std::vector<float> value_;
};

std::vector<int> renumbered(const std::vector<std::size_t>& parent) {
  std::vector<int> number(parent.size(), -1);
  std::vector<int> out;
  int next = 0;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    std::size_t root = i;
    while (parent[root] != root) root = parent[root];
    if (number[root] < 0) number[root] = next++;
    out.push_back(number[root]);
  }
  return out;
}

/// Spreads labels over the floor, each cell to the label that reaches it in the fewest steps.
void flood(cv::Mat& labels, const cv::Mat& floor) {
  std::vector<cv::Point> queue;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels.at<int>(y, x) != 0) queue.push_back({x, y});
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const cv::Point p = queue[i];
    for (const cv::Point& d : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
      const cv::Point q = p + d;
      if (q.x < 0 || q.y < 0 || q.x >= labels.cols || q.y >= labels.rows) continue;
      if (labels.at<int>(q) != 0 || floor.at<unsigned char>(q) == 0) continue;
      labels.at<int>(q) = labels.at<int>(p);
      queue.push_back(q);
    }
  }
}

/// Points every `spacing` along the walls, `offset` inside the floor; at most `most_points`.
std::vector<cv::Point> wall_control_points(const RoomFloor& floor, const RoomConfig& config) {
  const std::vector<WallContour> walls = wall_contours(floor.open);
  std::size_t total = 0;
  for (const WallContour& wall : walls) total += wall.size();
  const double least = static_cast<double>(total) / static_cast<double>(std::max<std::size_t>(1, config.most_points));
  const double spacing = std::max({1.0, config.spacing / floor.resolution, least});
  cv::Mat clearance;
  cv::distanceTransform(floor.open, clearance, cv::DIST_L2, cv::DIST_MASK_5);
  std::vector<cv::Point> points;
  for (const WallContour& wall : walls) {
    const auto count = static_cast<std::size_t>(static_cast<double>(wall.size()) / spacing);
    for (std::size_t i = 0; i < count; ++i)
      points.push_back(into_floor(clearance, wall[static_cast<std::size_t>(static_cast<double>(i) * spacing)],
                                  config.offset / floor.resolution));
  }
  return points;
}

}  // namespace

VisibilityMatrix visibility(const RoomFloor& floor, const std::vector<cv::Point>& points, const RoomConfig& config) {
  VisibilityMatrix seen;
  seen.size = points.size();
  seen.words = (points.size() + 63) / 64;
  seen.bits.assign(seen.size * seen.words, 0);
  const double reach = config.sight / floor.resolution;
  for (std::size_t i = 0; i < points.size(); ++i) {
    seen.set(i, i);
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      if (cv::norm(points[i] - points[j]) > reach) continue;
      if (!sees_past(floor.open, points[i], points[j], config.phantom_cells)) continue;
      seen.set(i, j);
      seen.set(j, i);
    }
  }
  return seen;
}

/// A chain of ever nearer neighbours ends in two that are nearest to each other, and average linkage may join those at
/// once (Murtagh 1983). If even they are too far apart, neither will ever be joined: means only fall.
std::vector<int> cluster_rows(const VisibilityMatrix& seen, double least) {
  Linkage linkage(seen);
  std::vector<std::size_t> parent(seen.size);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  std::vector<std::size_t> chain;
  std::size_t start = 0;
  while (true) {
    if (chain.empty()) {
      while (start < seen.size && !linkage.open(start)) ++start;
      if (start == seen.size) return renumbered(parent);
      chain.push_back(start);
    }
    const std::size_t end = chain.back();
    const std::size_t previous = chain.size() > 1 ? chain[chain.size() - 2] : end;
    const std::size_t next = linkage.nearest(end, previous);
    if (next == end || linkage.at(end, next) < static_cast<float>(least)) {
      linkage.finish(end);
      chain.pop_back();
    } else if (next == previous) {
      chain.resize(chain.size() - 2);
      const std::size_t into = std::min(end, next);
      const std::size_t other = std::max(end, next);
      linkage.join(into, other);
      parent[other] = into;
    } else {
      chain.push_back(next);
    }
  }
}

RoomRegions cluster_rooms(const RoomFloor& floor, const RoomConfig& config) {
  const std::vector<cv::Point> points = wall_control_points(floor, config);
  const std::vector<int> cluster = cluster_rows(visibility(floor, points, config), config.similarity);
  RoomRegions out;
  out.labels = cv::Mat::zeros(floor.open.rows, floor.open.cols, CV_32S);
  const int clusters = cluster.empty() ? 0 : *std::max_element(cluster.begin(), cluster.end()) + 1;
  std::vector<std::size_t> members(static_cast<std::size_t>(clusters), 0);
  for (const int c : cluster) ++members[static_cast<std::size_t>(c)];
  std::vector<int> number(members.size(), 0);
  for (std::size_t c = 0; c < members.size(); ++c)
    if (members[c] >= kLeastPoints) number[c] = ++out.count;
  for (std::size_t i = 0; i < points.size(); ++i)
    out.labels.at<int>(points[i]) = number[static_cast<std::size_t>(cluster[i])];
  flood(out.labels, floor.open);
  return out;
}

}  // namespace rubble::scoring
