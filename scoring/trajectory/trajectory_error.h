#pragma once

#include <cstddef>

#include "base/trajectory.h"

namespace rubble::scoring {

/// Absolute trajectory error, RMSE of positions [m], truth interpolated at the estimate's stamps (evo's conventions).
struct TrajectoryError {
  std::size_t matched = 0;     ///< poses compared
  double ate_first_m = 0.0;    ///< after putting the first poses on each other
  double ate_aligned_m = 0.0;  ///< after the best rigid alignment (Umeyama, scale 1)
  double ate_scaled_m = 0.0;   ///< after the best alignment with scale (Umeyama)
  double scale = 1.0;          ///< how large the estimate is beside the truth, by that; 1 where it does not tell
};

/// matched = 0 when the trajectories do not overlap in time.
TrajectoryError trajectory_error(const Trajectory& estimate, const Trajectory& truth);

}  // namespace rubble::scoring
