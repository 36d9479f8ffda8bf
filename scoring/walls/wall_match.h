#pragma once

#include <mrpt/math/TPose2D.h>

#include <array>
#include <vector>

#include "base/grid.h"
#include "scoring/walls/wall_field.h"
#include "scoring/walls/warp.h"

namespace rubble::scoring {

/// What the walls of one map find on the other. Shares are 0..1; a side with nothing to say gives 0.
struct WallEvidence {
  double known = 0.0;         ///< share of these walls that lie where the other map knows something
  double met = 0.0;           ///< mean k(d) of those
  double chance = 0.0;        ///< mean k(d) of a random known place of the other map
  double contradicted = 0.0;  ///< share of those that lie deep in free space of the other map
  /// Met, corrected for chance: 0 no better than random, 1 perfect.
  double kappa() const { return chance < 0.95 && met > chance ? (met - chance) / (1.0 - chance) : 0.0; }
};

struct PoseEvidence {
  WallEvidence map;          ///< the map's walls on the truth
  WallEvidence truth;        ///< the truth's walls on the map
  double free_common = 0.0;  ///< share of the smaller free area that is free in both
  double common_area = 0.0;  ///< free in both [m^2]
};

/// Walls of both maps that meet at one of two poses better than at the other [m]: furniture, phantoms and whatever else
/// meets at neither, or at both, has no say.
struct WallDuel {
  double ours = 0.0;
  double theirs = 0.0;
};

/// Two maps prepared for comparing them at many poses: wall points, distance fields, free samples of both.
class WallMatch {
 public:
  static constexpr double kEverywhere = 1e9;

  /// `reach`: distances count up to here [m]. At most `max_points` wall points a map are used (0: all).
  WallMatch(const OccupancyGrid& map, const OccupancyGrid& truth, double reach, std::size_t max_points);

  /// k(d) = clip(1 - d / tau, 0, 1), with what a random place of either map would get.
  struct Kernel {
    double tau = 0.0;
    double truth_chance = 0.0;  ///< on the truth
    double map_chance = 0.0;    ///< on the map
  };
  Kernel kernel(double tau) const;

  PoseEvidence evidence(const Warp& warp, const Kernel& kernel) const;

  /// Where the map is put; `mirrored`: its mirror_image() is.
  struct Placement {
    mrpt::math::TPose2D T_truth_map;
    bool mirrored = false;
  };
  /// Of one place with each of the others, by walls that meet within `tau` [m] and are known at both.
  std::vector<WallDuel> duels(const Placement& ours, const std::vector<Placement>& others, double tau) const;

  /// Moves the pose so that walls meet: Gauss-Newton on both distance fields, walls further apart than about `sigma`
  /// [m] pull less and less (Geman-McClure weights).
  mrpt::math::TPose2D refine(const mrpt::math::TPose2D& T_truth_map, double sigma, int iterations) const;

  /// What holds back the displacement's terms of degree 1, 2, 3 (index 0 unused): the norm of eq. (8).
  using Stiffness = std::array<double, 4>;
  /// The same with a polynomial displacement beside the pose.
  Warp refine(const Warp& warp, double sigma, const Stiffness& stiffness, int iterations) const;

  /// A warp without displacement yet, in the coordinates of this map; `degree` 2 or 3.
  Warp rigid(const mrpt::math::TPose2D& T_truth_map, int degree = 2) const;
  /// The rigid transform closest to the warp over the map's walls; with `met` [m], over those that end up within it of
  /// a wall of the truth, if there are any.
  mrpt::math::TPose2D nearest_rigid(const Warp& warp, double met = kEverywhere) const;
  /// The rigid transform between the two: closest to the mean of their images of the map's walls.
  mrpt::math::TPose2D halfway(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const;
  /// RMS displacement of the map's walls that no rigid transform explains [m].
  double bend(const Warp& warp) const;

  /// Both maps have walls that fix a pose: more than one straight wall or a blob.
  bool usable() const { return map_.breadth >= kLeastBreadth && truth_.breadth >= kLeastBreadth; }
  const mrpt::math::TPoint2D& map_centre() const { return map_.centre; }
  /// Twice the RMS distance of the map's walls from their centre [m].
  double map_extent() const { return map_.extent; }
  double truth_extent() const { return truth_.extent; }

 private:
  static constexpr double kLeastBreadth = 0.4;      // [m]
  static constexpr std::size_t kMaxSamples = 3000;  // of an area: shares good to 1 %

  struct Side {
    Side(const OccupancyGrid& grid, double reach, std::size_t max_points);
    OccupancyGrid grid;
    WallField field;
    std::vector<mrpt::math::TPoint2D> walls;
    std::vector<mrpt::math::TPoint2D> free;   ///< samples of the free area
    std::vector<mrpt::math::TPoint2D> known;  ///< samples of the free and occupied area
    double free_area = 0.0;                   ///< that all free samples stand for [m^2]
    mrpt::math::TPoint2D centre;              ///< of the wall points
    double breadth = 0.0;                     ///< standard deviation of the wall points across their main direction [m]
    double extent = 1.0;                      ///< RMS distance of the wall points from it, twice [m]
  };
  Side map_;
  Side truth_;
};

}  // namespace rubble::scoring
