#pragma once

#include <mrpt/math/TPoint2D.h>

#include <array>
#include <cstddef>
#include <vector>

#include "base/grid.h"
#include "base/planar.h"
#include "scoring/measures/sight.h"
#include "scoring/walls/warp.h"

namespace rubble::scoring {

/// What a map says about the lines of sight of the truth.
struct SightAgreement {
  double score = 0.0;  ///< 0..1: what it knows, times how far it agrees beyond a map that knows only the lattice
  double known = 0.0;  ///< share of the lines, by weight, that the map knows
  double kappa = 0.0;  ///< of those: 1 all right, 0 no better than a guess, -1 all wrong
};

/// Lines between two free places of the truth, 0.5 to 1.8 m apart: open, or blocked by one wall. A map agrees where it
/// says the same and has the wall in the same place.
///
/// Chance is taken off line by line. A line that is blocked although, where the truth is laid over itself, such lines
/// are blocked in a share c of cases, weighs 1 - c; one that is open weighs c. So whoever draws walls without knowing
/// the arena earns nothing in the mean, however many he draws; all free and all walls earn 0 exactly; what is unknown
/// earns and costs nothing; and knowing a part without error earns that part: a blocked line lies where its wall is, an
/// open one where walls stand on it at those shifts. What lies in any arena beyond doubt earns nothing. Two arenas on
/// one lattice agree by luck at the best of many poses: each known line costs a fee that outweighs this.
///
/// Where next to nothing stands inside (a hall, a corridor), lines that lead out through the walls around are asked,
/// too: without them two short walls would be all, and any arena is right about those somewhere.
///
/// Walls are compared by their middle, so a fat pencil costs little: only lines clear of the truth's walls by 0.25 m at
/// the ends and 0.12 m beside them count.
class SightLines {
 public:
  /// What of a line a map is asked about. `Located`: where its answer lies, for a score that nobody can fill up.
  /// `Whole`: the line from end to end, in any place, for a judge of whether two maps show the same: its thresholds
  /// were set with that.
  enum class Credit { Located, Whole };

  explicit SightLines(const OccupancyGrid& truth, Credit credit = Credit::Located);

  /// Too few open or blocked lines to say anything: a truth without free space.
  bool usable() const;
  /// So few inner walls that those around are asked about as well: luck is soon right about most.
  bool bare() const { return luck_.bare; }
  SightAgreement at(const SightMap& map, const PlanarTransform& T_truth_map) const;
  SightAgreement at(const SightMap& map, const Warp& warp) const;
  SightAgreement at(const OccupancyGrid& map, const PlanarTransform& T_truth_map) const {
    return at(SightMap(map, ragged(credit_)), T_truth_map);
  }

  struct Line {
    mrpt::math::TPoint2D from;
    mrpt::math::TPoint2D to;
    bool blocked = false;
    double middle = 0.0;             ///< of the wall that blocks it, from `from` [m]
    double thickness = 0.0;          ///< of that wall along the line [m]
    double strength = 1.0;           ///< of that wall: less than 1 if it is a small piece
    double weight = 0.0;             ///< of all blocked (open) lines together 0.5
    std::vector<float> doubts = {};  ///< where walls stand on an open line at other shifts, from `from` [m]
    /// Where the truth knows nothing of a blocked line, from `from` [m]: walls of the map are not judged there.
    Unjudged unjudged = {};
  };
  const std::vector<Line>& lines() const { return lines_; }

  /// What maps of other arenas reach at the best of all poses.
  struct Luck {
    double fee = 0.0;   ///< kappa
    bool bare = false;  ///< so few inner walls that those around are asked about as well
  };

 private:
  /// The thresholds of `Whole` were set with walls that wavered left in pieces.
  static Ragged ragged(Credit credit) { return credit == Credit::Whole ? Ragged::ArePieces : Ragged::AreWalls; }

  /// Fills the lines, with those through the walls around if `outer`. Returns at how many places walls are asked about.
  double ask(const OccupancyGrid& truth, bool outer);

  Credit credit_;
  std::vector<Line> lines_;
  Luck luck_;
  std::array<std::size_t, 2> count_{};  ///< open and blocked
};

}  // namespace rubble::scoring
