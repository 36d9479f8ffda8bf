#include "slam/mrpt/module/match_target.h"

#include <mrpt/poses/CPose2D.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rubble::slam {
namespace {

constexpr float kEdge = 0.1f;              ///< of a bucket: a few points each, and most partners in one of nine [m]
constexpr float kMostBuckets = 250000.0f;  ///< a scan of a long-range laser gets larger buckets

}  // namespace

int MatchTarget::column(float x) const {
  return static_cast<int>(std::clamp((x - x0_) * inverse_edge_, -1.0f, static_cast<float>(width_)));
}
int MatchTarget::row(float y) const {
  return static_cast<int>(std::clamp((y - y0_) * inverse_edge_, -1.0f, static_cast<float>(height_)));
}

void MatchTarget::index() {
  const auto& xs = getPointsBufferRef_x();
  const auto& ys = getPointsBufferRef_y();
  points_.clear();
  first_.assign(1, 0);
  width_ = height_ = 0;
  if (xs.empty()) return;
  const auto x_range = std::minmax_element(xs.begin(), xs.end());
  const auto y_range = std::minmax_element(ys.begin(), ys.end());
  x0_ = *x_range.first;
  y0_ = *y_range.first;
  const float wide = *x_range.second - x0_;
  const float high = *y_range.second - y0_;
  edge_ = std::max(
      {kEdge, std::sqrt(wide) * std::sqrt(high) / std::sqrt(kMostBuckets), wide / kMostBuckets, high / kMostBuckets});
  inverse_edge_ = 1.0f / edge_;
  width_ = static_cast<int>(wide * inverse_edge_) + 1;
  height_ = static_cast<int>(high * inverse_edge_) + 1;

  const auto bucket = [&](std::size_t i) {
    return static_cast<std::size_t>(std::min(row(ys[i]), height_ - 1)) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(std::min(column(xs[i]), width_ - 1));
  };
  first_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, 0);
  for (std::size_t i = 0; i < xs.size(); ++i) ++first_[bucket(i) + 1];
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  points_.resize(xs.size());
  for (std::size_t i = xs.size(); i-- > 0;) {  // backwards: a bucket's points stay in their order
    const std::size_t b = bucket(i);
    points_[--first_[b + 1]] = {xs[i], ys[i], static_cast<std::uint32_t>(i)};
  }
  // Each entry b + 1 now holds where bucket b begins.
  first_.erase(first_.begin());
  first_.push_back(static_cast<std::uint32_t>(points_.size()));
}

void MatchTarget::search_row(int y, int first, int last, float px, float py, Nearest& best) const {
  if (y < 0 || y >= height_) return;
  first = std::max(first, 0);
  last = std::min(last, width_ - 1);
  if (first > last) return;
  const std::size_t begin = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  const Point* p = points_.data() + first_[begin + static_cast<std::size_t>(first)];
  const Point* const end = points_.data() + first_[begin + static_cast<std::size_t>(last) + 1];
  for (; p < end; ++p) {
    const float dx = p->x - px;
    const float dy = p->y - py;
    const float square = dx * dx + dy * dy;
    if (square < best.square || (square == best.square && best.point != nullptr && p->index < best.point->index)) {
      best = {square, p};
    }
  }
}

/// Ring by ring around the point's own bucket, until nothing farther out can be nearer than the best or than `reach`.
MatchTarget::Nearest MatchTarget::nearest(float x, float y, float reach) const {
  Nearest best{reach * reach};
  const float u = (x - x0_) * inverse_edge_;
  const float v = (y - y0_) * inverse_edge_;
  const float rings = reach * inverse_edge_ + 1.0f;
  if (!(u > -rings && v > -rings && u < static_cast<float>(width_) + rings &&
        v < static_cast<float>(height_) + rings)) {
    return best;
  }
  const int cx = static_cast<int>(std::floor(u));
  const int cy = static_cast<int>(std::floor(v));
  // How far the nearest side of the own bucket is: ring r then is at least r - 1 edges and this much away.
  const float du = u - static_cast<float>(cx);
  const float dv = v - static_cast<float>(cy);
  const float inner = std::min(std::min(du, 1.0f - du), std::min(dv, 1.0f - dv)) * edge_;
  search_row(cy, cx, cx, x, y, best);
  for (int ring = 1; ring <= std::max(width_, height_) + static_cast<int>(rings); ++ring) {
    const float clear = inner + static_cast<float>(ring - 1) * edge_;
    if (clear * clear > best.square) return best;
    search_row(cy - ring, cx - ring, cx + ring, x, y, best);
    for (int side = cy - ring + 1; side < cy + ring; ++side) {
      search_row(side, cx - ring, cx - ring, x, y, best);
      search_row(side, cx + ring, cx + ring, x, y, best);
    }
    search_row(cy + ring, cx - ring, cx + ring, x, y, best);
  }
  return best;
}

void MatchTarget::determineMatching2D(const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose2D& other_pose,
                                      mrpt::tfest::TMatchingPairList& pairs, const mrpt::maps::TMatchingParams& params,
                                      mrpt::maps::TMatchingExtraResults& result) const {
  const auto* points = dynamic_cast<const mrpt::maps::CPointsMap*>(other);
  if (points == nullptr || params.maxAngularDistForCorrespondence != 0.0f || params.decimation_other_map_points != 1 ||
      params.offset_other_map_points != 0 || params.onlyUniqueRobust) {
    throw std::invalid_argument("MatchTarget: only plain nearest-point matching of points");
  }
  const auto& xs = points->getPointsBufferRef_x();
  const auto& ys = points->getPointsBufferRef_y();
  const float cosine = static_cast<float>(std::cos(other_pose.phi()));
  const float sine = static_cast<float>(std::sin(other_pose.phi()));
  const float x0 = static_cast<float>(other_pose.x());
  const float y0 = static_cast<float>(other_pose.y());
  pairs.clear();
  pairs.reserve(xs.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const float x = x0 + xs[i] * cosine - ys[i] * sine;
    const float y = y0 + xs[i] * sine + ys[i] * cosine;
    const Nearest found = nearest(x, y, params.maxDistForCorrespondence);
    if (found.point == nullptr) continue;
    mrpt::tfest::TMatchingPair pair(found.point->index, static_cast<std::uint32_t>(i), found.point->x, found.point->y,
                                    0.0f, xs[i], ys[i], 0.0f);
    pair.errorSquareAfterTransformation = found.square;
    squares += static_cast<double>(found.square);
    pairs.push_back(pair);
  }
  result.correspondencesRatio = xs.empty() ? 0.0f : static_cast<float>(pairs.size()) / static_cast<float>(xs.size());
  result.sumSqrDist = pairs.empty() ? 0.0f : static_cast<float>(squares / static_cast<double>(pairs.size()));
}

}  // namespace rubble::slam
