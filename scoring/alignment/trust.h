#pragma once

#include <optional>
#include <string>

#include "scoring/walls/wall_match.h"

namespace rubble::scoring {

constexpr double kBendCosts = 0.03;   ///< a bent map must agree by this much more than the straight one
constexpr double kTightEnough = 0.8;  ///< tight agreement from which it is the measure of a pose
constexpr double kNoOdds = -99.0;     ///< log odds where there is no pose

/// Walls of both maps that meet within the wider tau, less what chance and contradiction take away. At most 1.2.
double wide_agreement(const PoseEvidence& wide);
/// Chance-corrected agreement of both maps' walls within the tighter tau. At most 2.
double tight_agreement(const PoseEvidence& tight);
/// Agreement within a metre, contradictions counted in full: of the map as a whole.
double whole_agreement(const PoseEvidence& metre);
/// Log odds of a pose being right: logistic regression on poses of public maps, docs/scoring.md.
double log_odds(const PoseEvidence& wide, const PoseEvidence& tight);

/// The most that poses reach which cannot be the right one if the best is: other poses, and all of the mirrored map.
struct Rivals {
  double log_odds = kNoOdds;
  double tight = 0.0;
  double map_tight = 0.0;    ///< of `tight`, what the map's walls contribute
  double truth_tight = 0.0;  ///< the same for the truth's walls
  void meet(const PoseEvidence& wide, const PoseEvidence& tight_evidence);
  void join(const Rivals& others);
};

struct Trust {
  bool trusted = false;
  bool tight = false;     ///< the maps agree to the decimetre, not only to the metre
  bool fragment = false;  ///< tight, and too little is common to rule out chance by walls alone
  bool rivalled = false;  ///< not trusted because a rival comes so near; nothing else speaks against it
  bool open = false;  ///< not trusted, but rather right than wrong, and no rival is better: other witnesses may decide
  std::string note;   ///< why not trusted; or what speaks for a pose of which walls alone leave a doubt
};

/// Which rivals come so near the best pose that a map is refused for them.
struct NearRivals {
  bool another_pose = false;  ///< of the map itself
  bool mirrored = false;      ///< of its mirror image
  bool any() const { return another_pose || mirrored; }
};

/// Why a map is refused for its rivals. On a lattice of pallets strangers have such rivals, too, and so has an arena
/// that repeats itself: `beyond_luck`, how right the map is at its best pose about those lines of sight of the truth
/// that it knows (1 wholly, 0 like another arena), tells the two apart; nothing where nobody asked or could.
std::string why_rivalled(const NearRivals& rivals, const std::optional<double>& beyond_luck);

/// Two poses of walls that agree to the decimetre: whether the rival comes so near that trust is refused.
bool is_near(const PoseEvidence& tight, const PoseEvidence& rival_tight);
/// Where a rival is near: of the walls that tell the two apart, so many more meet at ours that no luck explains it.
bool is_won(const WallDuel& duel);
/// The same of walls that must meet within `kSharp`: fewer of those that differ meet at both, and shares that are less
/// lopsided tell as much.
constexpr double kSharp = 0.15;  ///< [m]
bool is_won_sharply(const WallDuel& duel);

/// Decides whether the best pose is the right one. Rules and how they were calibrated: docs/scoring.md.
Trust judge(const PoseEvidence& wide, const PoseEvidence& tight, const Rivals& rivals);

}  // namespace rubble::scoring
