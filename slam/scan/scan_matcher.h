#pragma once

#include <mrpt/math/TPose2D.h>

#include <memory>

#include "base/angle.h"
#include "slam/scan/surface.h"

namespace rubble::slam {

struct ScanMatcherConfig {
  double first_distance = 0.30;        ///< farthest a correspondence may reach at the start [m]
  double last_distance = 0.05;         ///< and at the end [m]
  int max_iterations = 40;             ///< of the ICP
  double min_goodness = 0.4;           ///< least share of points that found a partner
  double max_correction = 0.2;         ///< a larger one is not believed [m]
  double max_turn = deg_to_rad(10.0);  ///< a larger one is not believed [rad]
  int min_points = 10;                 ///< with fewer points there is no match
  double dense_spacing = 0.02;         ///< the last scan's surfaces are filled with points to this spacing [m]
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

  /// Makes `surface` the one that later scans are matched with.
  void set_last(const Surface& surface);
  /// Refines the motion from the last scan to this one. Draws no random numbers.
  ScanMatch match(const Surface& now, const mrpt::math::TPose2D& T_last_now_prior);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::slam
