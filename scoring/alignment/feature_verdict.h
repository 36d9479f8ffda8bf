#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "scoring/alignment/match_error.h"

namespace rubble::scoring {

/// What eq. (7) is taken over.
enum class EvidenceKind { Surf, Corners, Rooms };
const char* name_of(EvidenceKind kind);

/// Eq. (7) held against what strangers reach. Even a good map repeats only a part of the truth's features, and some
/// meet by chance wherever the map lies: E alone says little.
struct KindScore {
  EvidenceKind kind = EvidenceKind::Surf;
  std::vector<mrpt::math::TPoint2D> map;    ///< the map's features, own frame [m]
  std::vector<mrpt::math::TPoint2D> truth;  ///< the truth's
  MatchError match;                         ///< at the pose
  double stranger = 0.0;  ///< mean E of the map's mirror image at its best poses, all of which are wrong [m^2]
  bool usable = false;    ///< enough features of this kind in the truth to say anything
  double score = 0.0;     ///< 1 - E / `stranger`, not below 0
};

struct FeatureVerdict {
  std::vector<KindScore> kinds;
  double score = 0.0;  ///< mean over the usable kinds: 1 for the truth, about 0 for strangers
};

}  // namespace rubble::scoring
