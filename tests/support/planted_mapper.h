#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "slam/mapper.h"

namespace rubble::test {

/// A mapper whose poses are planted by the test, loop closures included.
class PlantedMapper : public slam::Mapper {
 public:
  void update(const robot::Inputs&) override {}
  const slam::CountMap& map() const override { return map_; }
  mrpt::math::TPose2D pose() const override { return poses_.empty() ? mrpt::math::TPose2D{} : poses_.back().pose; }
  PoseCovariance covariance() const override { return {}; }
  std::uint64_t revision() const override { return revision_; }
  std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const override {
    for (const StampedPose& entry : poses_)
      if (entry.stamp == stamp) return entry.pose;
    return std::nullopt;
  }
  const Trajectory& trajectory() const override { return poses_; }
  const Trajectory& live_trajectory() const override { return poses_; }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override { return hits_; }
  const slam::MapperCounts& counts() const override { return counts_; }

  void plant(Stamp stamp, const mrpt::math::TPose2D& pose) { poses_.push_back({stamp, pose}); }
  void show(slam::CountMap map) { map_ = std::move(map); }
  /// Closes a loop: what was before `until` moves by `correction`, on the left.
  void correct(Stamp until, const mrpt::math::TPose2D& correction) {
    for (StampedPose& entry : poses_)
      if (entry.stamp < until) entry.pose = correction + entry.pose;
    ++revision_;
  }

 private:
  Trajectory poses_;
  slam::CountMap map_{10, 10, 0.05};
  std::vector<mrpt::math::TPoint2D> hits_;
  slam::MapperCounts counts_;
  std::uint64_t revision_ = 0;
};

}  // namespace rubble::test
