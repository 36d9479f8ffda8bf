#pragma once

#include <string>

#include "scoring/wall_match.h"

namespace rubble::scoring {

constexpr double kBendCosts = 0.03;  ///< a bent map must agree by this much more than the straight one

/// Walls of both maps that meet within the wider tau, less what chance and contradiction take away. At most 1.2.
double wide_agreement(const PoseEvidence& wide);
/// Chance-corrected agreement of both maps' walls within the tighter tau. At most 2.
double tight_agreement(const PoseEvidence& tight);
/// Agreement within a metre, contradictions counted in full: of the map as a whole.
double whole_agreement(const PoseEvidence& metre);

/// The best agreement reached at any clearly different pose.
struct Rivals {
  double wide = 0.0;
  double tight = 0.0;
};

struct Trust {
  bool trusted = false;
  bool tight = false;  ///< the maps agree to the decimetre, not only to the metre
  double runner_up = 0.0;
  std::string note;  ///< why not trusted
};

/// Decides whether the best pose is the right one. Rules and how they were calibrated: docs/scoring.md.
Trust judge(const PoseEvidence& wide, const PoseEvidence& tight, const Rivals& rivals);

}  // namespace rubble::scoring
