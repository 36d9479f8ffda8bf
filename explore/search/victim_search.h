#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <functional>
#include <vector>

#include "base/angle.h"
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
  double memory = 40.0;                  ///< only cues younger than this confirm a victim together [s]
  double other_side = deg_to_rad(90.0);  ///< looked at from so different bearings, it may be another victim [rad]
  double back_to_back = 0.25;            ///< which lies at least so far from the first: box, wall, box [m]
};

/// Whether nothing stands between two places of the map.
using SightFn = std::function<bool(const mrpt::math::TPoint2D&, const mrpt::math::TPoint2D&)>;

/// Collects victim cues in the map frame into victims. Cues from the two sides of a wall are about two victims, back to
/// back.
class VictimSearch {
 public:
  explicit VictimSearch(const VictimSearchConfig& config = {}) : config_(config) {}

  /// Takes a cue that was sensed from `anchor`.
  void add(const robot::VictimCue& cue, const Anchor& anchor, const SightFn& in_sight);
  /// The same in a place without walls.
  void add(const robot::VictimCue& cue, const mrpt::math::TPose2D& T_map_base);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  /// True when a cue younger than `age` [s] belongs to a victim that is not confirmed yet: worth another look.
  bool undecided(Stamp now, double age) const;

  /// The confirmed victims by id. Of two that turn out to be one, the older id stays.
  const std::vector<VictimReport>& reports() const { return reports_; }

 private:
  struct Sighting {
    mrpt::math::TPoint2D p_map;
    robot::CueKind kind;
    double confidence;
    Anchor anchor;                ///< where it was sensed
    mrpt::math::TPoint2D p_base;  ///< the same place as p_map
  };
  struct Cluster {
    std::vector<Sighting> sightings;
    mrpt::math::TPoint2D p_map;
    int id = 0;  ///< 0: not confirmed
    Stamp confirmed;
    Stamp newest = Stamp::never();
  };

  std::size_t cluster_near(const Sighting& sighting, const SightFn& in_sight) const;
  std::size_t merge_into_neighbour(std::size_t index, const SightFn& in_sight);
  bool back_to_back(double d, const Sighting& a, const Sighting& b, const SightFn& in_sight) const;
  void locate(Cluster& cluster) const;
  void confirm(Cluster& cluster, Stamp stamp);
  void rebuild_reports();

  VictimSearchConfig config_;
  std::vector<Cluster> clusters_;
  std::vector<VictimReport> reports_;
  int next_id_ = 1;
};

/// The point with the least sum of weighted distances to all others (geometric median, Weiszfeld 1937): half of the
/// points may be anywhere without moving it far.
mrpt::math::TPoint2D geometric_median(const std::vector<mrpt::math::TPoint2D>& points,
                                      const std::vector<double>& weights);

}  // namespace rubble::explore
