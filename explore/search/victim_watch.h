#pragma once

#include <mrpt/math/TPose2D.h>

#include <vector>

#include "base/pose_covariance.h"
#include "base/stamp.h"
#include "explore/plan/traversable.h"
#include "explore/search/faint_search.h"
#include "explore/search/floor_search.h"
#include "explore/search/pose_doubt.h"
#include "explore/search/victim_search.h"
#include "explore/victim_report.h"
#include "robot/measurements.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// What the victim sensors tell: cues of victims, and which floor was looked at without any. Both count by the pose, so
/// neither counts while that is in doubt: a cue would put a victim where none is, a look would leave out a place that
/// nobody saw.
class VictimWatch {
 public:
  /// `room`, `tight`: clearance of viewpoints (FloorSearch) [m].
  VictimWatch(const VictimSearchConfig& victims, const SearchConfig& search, double room, double tight,
              const OtherSenses& others = {})
      : victims_(victims), search_(search, room, tight, others) {}

  /// The pose after a tick of `dt` [s], and its covariance in the map frame.
  void moved(const mrpt::math::TPose2D& T_map_base, const PoseCovariance& covariance, double dt) {
    doubt_.update(T_map_base, covariance, dt);
    covariance_ = covariance;
  }
  /// The pose has become doubtful (PoseDoubt).
  bool doubts_pose() const { return doubt_.unsure(); }
  /// Whether scans can be trusted: the pose is in doubt while they cannot.
  void trust_scans(bool trusted) { scans_trusted_ = trusted; }
  /// Takes in a cue, of a robot that is at T_map_base now; `floor` tells the sides of walls. Says whether a victim was
  /// confirmed by it.
  bool hear(const robot::VictimCue& cue, const slam::Mapper& mapper, const mrpt::math::TPose2D& T_map_base,
            const Traversable& floor);
  /// Asks whether holes in walls are to be expected, by where the victims were seen from. `floor` is that of `map`,
  /// which shows all where it is known to be now: one that is still drawn anew after a correction has walls twice.
  void judge_holes(const Traversable& floor, const slam::CountMap& map, Stamp now);
  /// Records what is seen from here of the floor, turning at `turn_rate` [rad/s]. Says whether it did: not more often
  /// than the sensors look.
  bool look(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, double turn_rate, Stamp now);
  /// The robot holds still, for a cue that is worth another look or before the place to face.
  bool holds_still(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, Stamp now);

  /// The mapper corrected its past. True when all looks must be repeated: `search().look_again`.
  bool follow(const slam::Mapper& mapper);

  /// The victims it is sure of, by id.
  const std::vector<VictimReport>& reports() const { return reports_; }
  FloorSearch& search() { return search_; }
  const FloorSearch& search() const { return search_; }

 private:
  bool take_in(const robot::VictimCue& cue, const Anchor& anchor, const Traversable& floor);
  void sort_faint(const Traversable& floor);
  void rebuild_reports();
  void tell_suspects();
  bool unsure() const { return doubt_.unsure() || !scans_trusted_; }

  PoseDoubt doubt_;
  PoseCovariance covariance_;  ///< of the pose
  bool scans_trusted_ = true;
  VictimSearch victims_;
  FaintSearch faint_;
  std::vector<FaintSearch::Seen> seen_;  ///< the victims of victims_
  std::vector<VictimReport> reports_;
  bool stares_ = false;
  Stamp stares_since_ = Stamp::never();
  Stamp smelt_at_ = Stamp::never();  ///< while it stared
  FloorSearch search_;
  Stamp next_judged_ = Stamp::never();
};

}  // namespace rubble::explore
