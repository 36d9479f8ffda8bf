#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>

#include "base/grid.h"
#include "scoring/alignment/pose_search.h"
#include "scoring/alignment/trust.h"
#include "scoring/proposals/correlation.h"
#include "scoring/proposals/feature_kind.h"
#include "scoring/walls/wall_match.h"

namespace rubble::scoring {

/// Where the robot started is known in both maps: it breaks ties between poses that fit about as well.
struct KnownStart {
  mrpt::math::TPose2D T_truth_map;  ///< that lays the start pose of the map on that of the truth
  mrpt::math::TPoint2D p_map;       ///< where it started on the map [m]
};

struct AlignmentConfig {
  AlignBy by = AlignBy::Auto;  ///< Auto: walls, where these leave a doubt features too, then rooms
  FeatureKind feature_kind = FeatureKind::Surf;
  Proposer rooms;  ///< proposes by rooms; where empty, propose_by_rooms()
  std::optional<KnownStart> start;
  CorrelationConfig correlation;
  SearchConfig search;
};

/// How the best pose won.
struct Contest {
  AlignBy tried = AlignBy::Auto;         ///< what proposed poses before it was decided; Auto: nothing did
  double agreement = 0.0;                ///< walls of both maps that meet within 0.3 m beyond chance, at most 2
  bool by_agreement = false;             ///< agreement decides on trust; else the log odds do
  double margin = 0.0;                   ///< of that measure over the best clearly different pose
  AlignBy runner_up_by = AlignBy::Auto;  ///< what proposed that pose; Auto: there is none
  mrpt::math::TPose2D T_runner_up;
};

/// The rigid transform between two maps, found without any initial guess.
struct Alignment {
  bool aligned = false;             ///< the transform can be trusted
  std::string note;                 ///< why not, or what decided where walls alone leave a doubt; one line
  NearRivals near;                  ///< for which it is not trusted; none: it is, or not for them
  std::string aside;                ///< what follows in `note` on why_rivalled()
  AlignBy by = AlignBy::Auto;       ///< what proposed it; Auto: nothing did
  mrpt::math::TPose2D T_truth_map;  ///< the best pose found, also when it cannot be trusted
  mrpt::math::TPose2D T_walls;      ///< the same, drawn to where most walls coincide; equal for undistorted maps
  double log_odds = 0.0;            ///< of the best pose being right
  double runner_up = 0.0;           ///< how near the best clearly different pose comes to the best, 0..1 (1: as good)
  Contest contest;                  ///< by how much the best pose is ahead, and of which
  double mirrored = 0.0;  ///< how near the mirrored map comes, which cannot be right, 0..1; 0 where there was no pose
  PoseEvidence wide_evidence;
  PoseEvidence tight_evidence;
};

/// Why align() does not look at these maps at all: more cells are walls than any building has; empty: it does.
std::string too_many_walls(const OccupancyGrid& map, const OccupancyGrid& truth);

/// Poses proposed by walls, features or rooms; refined on the distance fields and ranked by what the walls of both maps
/// say about each other, after a mild bend of the map where that explains more. The best is trusted if it stands out
/// from all others and from the best of the mirrored map. Scale is fixed at 1. docs/scoring.md gives the rules of
/// trust.
Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config = {});

}  // namespace rubble::scoring
