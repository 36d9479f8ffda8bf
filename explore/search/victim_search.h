#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/stamp.h"
#include "explore/victim_report.h"
#include "robot/measurements.h"

namespace rubble::explore {

struct VictimSearchConfig {
  int min_cues = 3;             ///< consistent cues that confirm a victim
  double min_evidence = 1.5;    ///< and their confidences together
  double consistency = 0.5;     ///< a cue supports its cluster when this close to its position [m]
  double merge_distance = 0.8;  ///< closer together: the same victim [m]
  int max_cues = 200;           ///< per cluster; older ones are forgotten
};

/// Collects victim cues in the map frame into victims.
class VictimSearch {
 public:
  explicit VictimSearch(const VictimSearchConfig& config = {}) : config_(config) {}

  /// Takes a cue that was sensed from T_map_base.
  void add(const robot::VictimCue& cue, const mrpt::math::TPose2D& T_map_base);

  /// True when a cue younger than `age` [s] belongs to a victim that is not confirmed yet: worth another look.
  bool undecided(Stamp now, double age) const;

  /// The confirmed victims by id. Of two that turn out to be one, the older id stays.
  const std::vector<VictimReport>& reports() const { return reports_; }

 private:
  struct Sighting {
    mrpt::math::TPoint2D p_map;
    robot::CueKind kind;
    double confidence;
  };
  struct Cluster {
    std::vector<Sighting> sightings;
    mrpt::math::TPoint2D p_map;
    int id = 0;  ///< 0: not confirmed
    Stamp confirmed;
    Stamp newest = Stamp::never();
  };

  std::size_t cluster_near(const mrpt::math::TPoint2D& p_map) const;
  std::size_t merge_into_neighbour(std::size_t index);
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
