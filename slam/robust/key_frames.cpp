#include "slam/robust/key_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

void KeyFrames::add(KeyFrame frame, const TPose2D& pose, const GraphEdge& edge) {
  frames_.push_back(std::move(frame));
  graph_.nodes.push_back(pose);
  links_.emplace_back();
  before_.push_back(size() < 2 ? -1 : edge.from);
  if (size() < 2) return;
  graph_.edges.push_back(edge);
  link(edge, length(edge.T_from_to.x, edge.T_from_to.y));
}

void KeyFrames::add_loop(const GraphEdge& edge, double path) {
  graph_.edges.push_back(edge);
  link(edge, path);
}

void KeyFrames::link(const GraphEdge& edge, double length) {
  const std::size_t index = graph_.edges.size() - 1;
  links_[static_cast<std::size_t>(edge.from)].push_back({edge.to, length, index});
  links_[static_cast<std::size_t>(edge.to)].push_back({edge.from, length, index});
}

void KeyFrames::move(const std::vector<TPose2D>& poses) {
  if (poses.empty()) return;
  const std::size_t moved = std::min(poses.size(), graph_.nodes.size());
  const TPose2D before = graph_.nodes[moved - 1];
  const TPose2D after = poses[moved - 1];
  for (std::size_t i = moved; i < graph_.nodes.size(); ++i) graph_.nodes[i] = after + (graph_.nodes[i] - before);
  std::copy(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(moved), graph_.nodes.begin());
}

void KeyFrames::switch_off(std::size_t edge) {
  GraphEdge& off = graph_.edges[edge];
  off.on = false;
  for (const int end : {off.from, off.to}) {
    std::vector<Link>& links = links_[static_cast<std::size_t>(end)];
    links.erase(std::remove_if(links.begin(), links.end(), [&](const Link& l) { return l.edge == edge; }), links.end());
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

std::vector<double> KeyFrames::paths_from(int i, double most) const {
  std::vector<double> paths(frames_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  paths[static_cast<std::size_t>(i)] = 0.0;
  open.push({0.0, i});
  while (!open.empty()) {
    const auto [path, k] = open.top();
    open.pop();
    if (path > paths[static_cast<std::size_t>(k)]) continue;
    for (const Link& link : links_[static_cast<std::size_t>(k)]) {
      double& known = paths[static_cast<std::size_t>(link.to)];
      if (path + link.length >= known || path + link.length > most) continue;
      known = path + link.length;
      open.push({known, link.to});
    }
  }
  return paths;
}

KeyFrames::Agreement KeyFrames::agreement(const std::vector<OrientedPoint>& points, const TPose2D& T_origin_points,
                                          const TPose2D& origin, const std::vector<int>& frames) const {
  Agreement agreement;
  for (const int k : frames) {
    const Cloud& cloud = (*this)[k].cloud;
    const PlanarTransform to_frame((origin + T_origin_points) - pose(k));
    for (const OrientedPoint& point : points) {
      const TPoint2D p = to_frame({static_cast<double>(point.x), static_cast<double>(point.y)}) - cloud.laser;
      const SightFan::Verdict verdict = cloud.sight.judge(std::atan2(p.y, p.x), length(p));
      if (verdict == SightFan::Verdict::InFront) ++agreement.contradicted;
      if (verdict == SightFan::Verdict::Agrees) ++agreement.supported;
    }
  }
  return agreement;
}

}  // namespace rubble::slam
