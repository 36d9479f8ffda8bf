#pragma once

#include <vector>

#include "scoring/alignment/pose_search.h"

namespace rubble::scoring {

/// `examine` for several lists of guesses about the same two maps: what was refined for one list is not refined again
/// for the next, and comes out the same to the bit.
class Examiner {
 public:
  /// `match` must outlive it.
  Examiner(const WallMatch& match, const SearchConfig& config);

  std::vector<Hypothesis> examine(const std::vector<PoseGuess>& guesses);

 private:
  struct Refined {
    mrpt::math::TPose2D guess;
    mrpt::math::TPose2D T_wide;
  };
  struct Tried {
    Hypothesis straight;
    Hypothesis bent;  ///< the better of straight and bent
    bool was_bent = false;
  };
  const mrpt::math::TPose2D& widely_refined(const mrpt::math::TPose2D& guess);
  Tried& tried(const mrpt::math::TPose2D& T_wide);

  const WallMatch& match_;
  const SearchConfig config_;
  WallMatch::Kernel wide_;
  WallMatch::Kernel tight_;
  std::vector<Refined> refined_;
  std::vector<Tried> tried_;
};

}  // namespace rubble::scoring
