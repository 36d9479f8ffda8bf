#pragma once

#include <mrpt/math/TPoint2D.h>

#include <vector>

#include "scoring/alignment/match_error.h"

namespace rubble::scoring {

/// What eq. (7) is taken over.
enum class EvidenceKind { Surf, Corners, Rooms };
const char* name_of(EvidenceKind kind);

/// Eq. (7) between what strangers reach and what the truth itself reaches when it is drawn anew. Even a good map
/// repeats only a part of the truth's features, and some meet by chance wherever the map lies: E alone says little.
struct KindScore {
  EvidenceKind kind = EvidenceKind::Surf;
  std::vector<mrpt::math::TPoint2D> map;    ///< the map's features, own frame [m]
  std::vector<mrpt::math::TPoint2D> truth;  ///< the truth's
  MatchError match;                         ///< at the pose
  double stranger = 0.0;  ///< mean E of the map's mirror image at its best poses, all of which are wrong [m^2]
  double redrawn = 0.0;   ///< E of the truth itself on another raster, turned by 17 deg [m^2]
  bool usable = false;    ///< enough features of this kind in the truth, and they tell it from strangers
  double score = 0.0;     ///< where E lies between `stranger` (0) and `redrawn` (1)
};

struct FeatureVerdict {
  std::vector<KindScore> kinds;
  /// Mean over the usable kinds, corners with 8 of 10 parts: 1 for the truth, about 0 for strangers.
  double score = 0.0;
};

}  // namespace rubble::scoring
