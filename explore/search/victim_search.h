#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <functional>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/pose_covariance.h"
#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/victim_report.h"
#include "robot/measurements.h"

namespace rubble::explore {

struct VictimSearchConfig {
  int min_cues = 3;                      ///< consistent cues that confirm a victim
  double min_evidence = 1.5;             ///< and their confidences together
  double consistency = 0.5;              ///< a cue supports its cluster when this close to its position [m]
  double merge_distance = 0.8;           ///< closer together: the same victim [m]
  int max_cues = 200;                    ///< per cluster; older ones are forgotten
  double memory = 12.0;                  ///< only cues younger than this confirm a victim together [s]
  double other_side = deg_to_rad(90.0);  ///< looked at from so different bearings, it may be another victim [rad]
  double back_to_back = 0.25;            ///< which lies at least so far from the first: box, wall, box [m]
  double side_by_side = 0.45;            ///< seen through holes in walls, so far apart: two boxes, of 0.5 m each [m]
};

/// Whether nothing stands between two places of the map.
using SightFn = std::function<bool(const mrpt::math::TPoint2D&, const mrpt::math::TPoint2D&)>;

/// What the map says of the line between two of its places.
struct Sightlines {
  SightFn open;          ///< nothing stands between
  SightFn hidden;        ///< a wall stands before the second
  SightFn through = {};  ///< the second is seen through a hole in a wall; none: nothing is
  bool holes = false;    ///< it is known that walls have holes
};

/// Collects victim cues in the map frame into victims. Two that lie nearer than `merge_distance` are told apart by what
/// no error of a pose can do: they were seen from the two sides of a wall, or both in one look of a camera, or one
/// where the map has a wall before the other. Seen through holes in walls their boxes tell them apart.
class VictimSearch {
 public:
  explicit VictimSearch(const VictimSearchConfig& config = {}) : config_(config) {}

  /// Takes a cue that was sensed from `anchor`; `covariance`: of that pose.
  void add(const robot::VictimCue& cue, const Anchor& anchor, const Sightlines& sight,
           const PoseCovariance& covariance = {});
  /// The same in a place without walls.
  void add(const robot::VictimCue& cue, const mrpt::math::TPose2D& T_map_base);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  /// Where cues younger than `age` [s] put victims that are not confirmed yet: worth another look [map frame, m].
  std::vector<mrpt::math::TPoint2D> undecided(Stamp now, double age) const;

  /// From where cameras saw a confirmed victim [map frame, m].
  std::vector<mrpt::math::TPoint2D> seen_from(int id) const;

  /// The confirmed victims by id. Of two that turn out to be one, the older id stays.
  const std::vector<VictimReport>& reports() const { return reports_; }

  /// The id of a victim that was found otherwise.
  int take_id() { return next_id_++; }
  /// One that nobody was told of.
  void give_id_back(int id) { next_id_ -= id == next_id_ - 1 ? 1 : 0; }
  /// The victim `id` turned out to be the one that was found otherwise before, as `older`.
  void rename(int id, int older, Stamp confirmed);

 private:
  struct Sighting {
    mrpt::math::TPoint2D p_map;
    robot::CueKind kind;
    double confidence;
    Anchor anchor;                ///< where it was sensed
    mrpt::math::TPoint2D p_base;  ///< the same place as p_map
    bool sure = false;            ///< it cannot be of another cluster nearby
    bool through = false;         ///< a hole in a wall
    PlaceCovariance pose{};       ///< of p_map, by the pose alone
  };
  struct Cluster {
    std::vector<Sighting> sightings;
    mrpt::math::TPoint2D p_map;
    int id = 0;  ///< 0: not confirmed
    Stamp confirmed;
    Stamp newest = Stamp::never();
  };

  /// Where a cue belongs; clusters_.size(): to none of them.
  struct Home {
    std::size_t index;
    bool sure;  ///< another one nearby cannot have been meant
  };

  void put(Sighting sighting, const Sightlines& sight);
  void put_into(std::size_t index, const Sighting& sighting, const Sightlines& sight);
  Home home_of(const Sighting& sighting, const Sightlines& sight);
  Sighting* of_same_look(Cluster& cluster, const Sighting& sighting) const;
  std::size_t merge_into_neighbour(std::size_t index, const Sightlines& sight);
  bool is_other(Cluster& cluster, const Sighting& sighting, const Sightlines& sight) const;
  bool are_two(Cluster& a, Cluster& b, const Sightlines& sight);
  bool side_by_side(double d, const Cluster& cluster, bool through, const Sightlines& sight) const;
  static bool seen_through(const Cluster& cluster);
  bool back_to_back(double d, const Sighting& a, const Sighting& b, const Sightlines& sight) const;
  void locate(Cluster& cluster) const;
  void confirm(Cluster& cluster, Stamp stamp);
  void rebuild_reports();
  PlaceCovariance covariance_of(const Cluster& cluster) const;

  VictimSearchConfig config_;
  std::vector<Cluster> clusters_;
  std::vector<VictimReport> reports_;
  int next_id_ = 1;
};

/// Covariance of a place that is rigidly attached to a pose, which has that covariance.
PlaceCovariance covariance_at(const mrpt::math::TPoint2D& place, const mrpt::math::TPose2D& T_map_base,
                              const PoseCovariance& covariance);

/// The point with the least sum of weighted distances to all others (geometric median, Weiszfeld 1937): half of the
/// points may be anywhere without moving it far.
mrpt::math::TPoint2D geometric_median(const std::vector<mrpt::math::TPoint2D>& points,
                                      const std::vector<double>& weights);

}  // namespace rubble::explore
