#pragma once

#include <mrpt/math/TPose2D.h>

#include <memory>

#include "base/angle.h"
#include "slam/count_map.h"

namespace rubble::slam {

struct ScanMatcherConfig {
  double first_distance = 0.30;        ///< farthest a correspondence may reach at the start [m]
  double last_distance = 0.05;         ///< and at the end [m]
  double min_goodness = 0.4;           ///< least share of points that found a partner
  double max_correction = 0.2;         ///< a larger one is not believed [m]
  double max_turn = deg_to_rad(10.0);  ///< a larger one is not believed [rad]
  double point_spacing = 0.05;         ///< of the current scan's points along the surfaces [m]
  double surface_spacing = 0.02;       ///< of the last scan's points; gaps are filled to this [m]
  double max_gap = 0.3;                ///< neighbouring beams farther apart do not see one surface [m]
};

struct ScanMatch {
  mrpt::math::TPose2D T_last_now;  ///< the refined motion when accepted, else the prior
  bool accepted = false;
  double goodness = 0.0;  ///< share of the current scan's points that found a partner
};

/// Point-to-point ICP (mrpt::slam::CICP) of the last scan and the current one, section III.B.
class ScanMatcher {
 public:
  explicit ScanMatcher(const ScanMatcherConfig& config);
  ~ScanMatcher();

  /// Makes `scan` the one that later scans are matched with.
  void set_last(const ScanPoints& scan);
  /// Refines the motion from the last scan to this one. Draws no random numbers.
  ScanMatch match(const ScanPoints& scan, const mrpt::math::TPose2D& T_last_now_prior);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::slam
