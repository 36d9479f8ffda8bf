#include "explore/caution/trail.h"

#include <limits>

#include "base/planar.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kTrailStep = 0.15;  ///< [m]

}  // namespace

void Trail::add(Stamp now, const TPose2D& T_map_base, double slope) {
  if (!points_.empty() && distance(points_.back(), position(T_map_base)) <= kTrailStep) return;
  anchors_.push_back({now, T_map_base});
  points_.push_back(position(T_map_base));
  slopes_.push_back(slope);
  passed_.add(points_.back(), slope);
}

double Trail::follow(const slam::Mapper& mapper) {
  if (points_.empty()) return std::numeric_limits<double>::infinity();
  const TPoint2D last = points_.back();
  passed_.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    anchors_[i].follow(mapper);
    points_[i] = position(anchors_[i].T_map_base);
    passed_.add(points_[i], slopes_[i]);
  }
  return distance(points_.back(), last);
}

double Trail::length() const {
  double way = 0.0;
  for (std::size_t i = 1; i < points_.size(); ++i) way += distance(points_[i - 1], points_[i]);
  return way;
}

}  // namespace rubble::explore
