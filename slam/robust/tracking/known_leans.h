#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "slam/robust/graph/key_frames.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// Of a body; small enough to be turned like a vector.
struct Lean {
  double pitch = 0.0;  ///< nose up [rad]
  double roll = 0.0;   ///< left side up [rad]

  /// Of a body that stands there turned by `angle` [rad].
  Lean turned(double angle) const;
};

/// How the body leant where it drove. It hangs on the key frames, which loops move, and grows with the ground covered
/// and not with the time driven.
class KnownLeans {
 public:
  /// As felt at T_frame_base; in the place of what was felt right there before.
  void add(int frame, const mrpt::math::TPose2D& T_frame_base, const Lean& lean);
  /// As felt nearest to T_map_base, of a body that stands as that one; level where nothing was felt within
  /// `distance` [m].
  Lean nearest(const KeyFrames& frames, const mrpt::math::TPose2D& T_map_base, double distance, Work* work) const;
  /// So many key frames came before those that it hangs on.
  void shift(int by);
  /// The same on the key frames of another map, in which those that it hangs on lie at T_map_drive.
  KnownLeans on(const KeyFrames& map, const KeyFrames& drive, const mrpt::math::TPose2D& T_map_drive) const;
  std::size_t size() const;

 private:
  struct Felt {
    mrpt::math::TPose2D T_frame_base;
    Lean lean;
  };
  /// Around a key frame.
  struct Place {
    std::vector<Felt> felt;
    std::size_t oldest = 0;  ///< of them, once there is no room for more
    double reach = 0.0;      ///< how far from the key frame they were felt at most [m]
  };

  std::vector<Place> places_;  ///< of key frames
};

}  // namespace rubble::slam
