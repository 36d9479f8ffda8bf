#include "slam/robust/graph/key_frames.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

constexpr Work kWorkPerVisit = 50;  ///< of a search for paths
constexpr Work kWorkPerLink = 12;

}  // namespace

void KeyFrames::add(KeyFrame frame, const TPose2D& pose, const GraphEdge& edge) {
  frames_.push_back(std::move(frame));
  take_walls(last());
  graph_.nodes.push_back(pose);
  newest_link_.push_back(-1);
  before_.push_back(size() < 2 ? -1 : edge.from);
  if (size() < 2) return;
  graph_.edges.push_back(edge);
  link(graph_.edges.size() - 1, length(edge.T_from_to.x, edge.T_from_to.y));
}

KeyFrames::KeyFrames(std::vector<KeyFrame> frames, std::vector<int> before, PoseGraph graph)
    : frames_(std::move(frames)),
      before_(std::move(before)),
      graph_(std::move(graph)),
      newest_link_(frames_.size(), -1) {
  for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
    const GraphEdge& edge = graph_.edges[k];
    if (edge.on) link(k, edge.loop ? kLoopLength : length(edge.T_from_to.x, edge.T_from_to.y));
  }
  graph_.walls.clear();
  for (int i = 0; i < size(); ++i) take_walls(i);
}

void KeyFrames::take_walls(int i) {
  if (const std::optional<WallDirection>& walls = (*this)[i].walls)
    graph_.walls.push_back({i, walls->angle, walls->sigma * walls->sigma});
}

void KeyFrames::add_start(KeyFrame frame, const TPose2D& pose, const GraphEdge& edge) {
  add(std::move(frame), pose, edge);
  before_.back() = -1;
}

void KeyFrames::add_loop(const GraphEdge& edge, double path) {
  graph_.edges.push_back(edge);
  link(graph_.edges.size() - 1, path);
}

void KeyFrames::link(std::size_t index, double length) {
  const GraphEdge& edge = graph_.edges[index];
  for (const auto& [from, to] : {std::pair(edge.from, edge.to), std::pair(edge.to, edge.from)}) {
    int& newest = newest_link_[static_cast<std::size_t>(from)];
    links_.push_back({length, to, static_cast<int>(index), newest});
    newest = static_cast<int>(links_.size()) - 1;
  }
}

void KeyFrames::move(const std::vector<TPose2D>& poses) {
  if (poses.empty()) return;
  const std::size_t moved = std::min(poses.size(), graph_.nodes.size());
  const TPose2D before = graph_.nodes[moved - 1];
  const TPose2D after = poses[moved - 1];
  for (std::size_t i = moved; i < graph_.nodes.size(); ++i) graph_.nodes[i] = after + (graph_.nodes[i] - before);
  std::copy(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(moved), graph_.nodes.begin());
}

void KeyFrames::set_walls(double direction, double variance) {
  graph_.walls_direction = direction;
  graph_.walls_variance = variance;
}

void KeyFrames::switch_off(std::size_t edge) {
  GraphEdge& off = graph_.edges[edge];
  off.on = false;
  for (const int end : {off.from, off.to}) {
    int* next = &newest_link_[static_cast<std::size_t>(end)];
    while (*next >= 0) {
      Link& link = links_[static_cast<std::size_t>(*next)];
      if (link.edge == static_cast<int>(edge))
        *next = link.next;
      else
        next = &link.next;
    }
  }
}

std::vector<int> KeyFrames::ending_at(int i, int most, double path) const {
  std::vector<int> frames;
  int start = i;
  for (int k = i; k >= 0 && static_cast<int>(frames.size()) < most && (*this)[start].path - (*this)[k].path <= path;) {
    frames.push_back(k);
    const int next = before_[static_cast<std::size_t>(k)];
    if (next != k - 1 && next >= 0) {  // between the two the robot drove over known ground
      path -= (*this)[start].path - (*this)[k].path + length(pose(k).x - pose(next).x, pose(k).y - pose(next).y);
      start = next;
    }
    k = next;
  }
  return frames;
}

std::vector<int> KeyFrames::around(int i, int most, double path, int limit) const {
  std::vector<int> frames{i};
  for (int step = 1; step <= most && static_cast<int>(frames.size()) < most; ++step) {
    const int before = i - step;
    const int after = i + step;
    if (before >= 0 && (*this)[i].path - (*this)[before].path <= 0.5 * path) frames.push_back(before);
    if (after < limit && (*this)[after].path - (*this)[i].path <= 0.5 * path) frames.push_back(after);
  }
  return frames;
}

std::vector<int> KeyFrames::closest(const TPose2D& pose, double distance, std::size_t most, int end) const {
  std::vector<std::pair<double, int>> close;
  for (int i = 0; i < end; ++i) {
    const double away = length(this->pose(i).x - pose.x, this->pose(i).y - pose.y);
    if (away <= distance) close.emplace_back(away, i);
  }
  std::sort(close.begin(), close.end());
  if (close.size() > most) close.resize(most);
  std::vector<int> frames;
  for (const auto& [away, i] : close) frames.push_back(i);
  return frames;
}

void KeyFrames::draw(const std::vector<int>& frames, const TPose2D& origin, double cell, SurfelGrid& grid) const {
  constexpr double kFar = std::numeric_limits<double>::max();
  TPoint2D low(kFar, kFar);
  TPoint2D high(-kFar, -kFar);
  std::vector<TPose2D> T_origin_frame;
  for (const int k : frames) {
    T_origin_frame.push_back(pose(k) - origin);
    const PlanarTransform to_origin(T_origin_frame.back());
    for (const OrientedPoint& point : (*this)[k].cloud.points) {
      const TPoint2D p = to_origin({static_cast<double>(point.x), static_cast<double>(point.y)});
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  if (high.x < low.x) low = high = TPoint2D(0, 0);
  grid.begin(cell, low, high);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    grid.add((*this)[frames[i]].cloud.points, T_origin_frame[i]);
    grid.add((*this)[frames[i]].cloud.filled, T_origin_frame[i]);
  }
  grid.finish();
}

std::vector<double> KeyFrames::paths_from(int i, const std::vector<int>& wanted, double most, Work* work) const {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  std::vector<double> lengths(wanted.size(), kUnknown);
  paths_.assign(frames_.size(), kUnknown);
  asked_.assign(frames_.size(), 0);
  std::size_t left = 0;
  for (const int k : wanted) {
    char& asked = asked_[static_cast<std::size_t>(k)];
    left += asked == 0 ? 1U : 0U;
    asked = 1;
  }
  open_.clear();
  paths_[static_cast<std::size_t>(i)] = 0.0;
  open_.push_back({0.0, i});
  Work looked_at = static_cast<Work>(frames_.size()) / 8;
  while (!open_.empty() && left > 0) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const auto [path, k] = open_.back();
    open_.pop_back();
    if (path > paths_[static_cast<std::size_t>(k)]) continue;
    left -= asked_[static_cast<std::size_t>(k)] != 0 ? 1U : 0U;
    looked_at += kWorkPerVisit;
    for (int l = newest_link_[static_cast<std::size_t>(k)]; l >= 0;) {
      const Link& link = links_[static_cast<std::size_t>(l)];
      l = link.next;
      looked_at += kWorkPerLink;
      double& known = paths_[static_cast<std::size_t>(link.to)];
      if (path + link.length >= known || path + link.length > most) continue;
      known = path + link.length;
      open_.push_back({known, link.to});
      std::push_heap(open_.begin(), open_.end(), std::greater<>());
    }
  }
  if (work != nullptr) *work += looked_at;
  for (std::size_t n = 0; n < wanted.size(); ++n) lengths[n] = paths_[static_cast<std::size_t>(wanted[n])];
  return lengths;
}

KeyFrames::Agreement KeyFrames::agreement(const std::vector<OrientedPoint>& points, const TPose2D& T_origin_points,
                                          const TPose2D& origin, const std::vector<int>& frames,
                                          SightFan::Slack slack) const {
  Agreement agreement;
  for (const int k : frames) {
    const Cloud& cloud = (*this)[k].cloud;
    const PlanarTransform to_frame((origin + T_origin_points) - pose(k));
    const SightFan::Judged judged = cloud.sight.judge(points, to_frame, cloud.laser, slack);
    agreement.contradicted += judged.in_front;
    agreement.supported += judged.agrees;
  }
  return agreement;
}

}  // namespace rubble::slam
