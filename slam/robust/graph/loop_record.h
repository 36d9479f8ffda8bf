#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stamp.h"

namespace rubble::slam {

/// A search for a loop that found a place, and what became of it.
struct LoopRecord {
  enum class End { Ambiguous, Unfit, Contradicted, Needless, Waits, Closed, Removed };

  Stamp stamp;                    ///< of the newer key frame
  int old_frame = -1;             ///< its number; -1: not among those that are there now
  Stamp old_stamp;                ///< of the older one; in a map that was gone on with by the clock of its own drive
  double path = 0.0;              ///< from one to the other through the graph [m]
  double window = 0.0;            ///< half width of the search [m]
  double score = 0.0;             ///< of the place found, 0..1
  mrpt::math::TPose2D T_old_new;  ///< the place: the newer key frame as seen from the older one
  double moves = 0.0;             ///< how far it lies from where the robot was expected [m]
  double turns = 0.0;             ///< [rad]
  End end = End::Unfit;
  // Nothing where the tests before were not stood.
  std::optional<double> inliers;                 ///< share of the points
  std::optional<double> contradiction;           ///< share of the points that one would have seen through walls
  std::optional<double> expected_contradiction;  ///< the same, were the robot where it was expected (the null test)
};

/// As the CSV has it.
const char* name_of(LoopRecord::End end);

/// CSV, a line each; `name`: what it calls a scan's stamp.
std::string csv_of(const std::vector<LoopRecord>& records, const std::function<Stamp(Stamp)>& name);

}  // namespace rubble::slam
