#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/trajectory.h"

namespace rubble::scoring {

/// Relative pose error over many pairs of poses: E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q the truth, P the estimate.
struct RelativeError {
  std::size_t pairs = 0;
  double rmse_m = 0.0;    ///< of the length of E's translation
  double rmse_rad = 0.0;  ///< of the absolute value of E's rotation
};

/// RPE between consecutive poses of the estimate (evo: delta of one frame). Truth interpolated at the estimate's
/// stamps, poses outside its time left out. No alignment: E does not depend on one.
RelativeError rpe_frames(const Trajectory& estimate, const Trajectory& truth);

/// RPE over pieces of path (evo: delta in metres, pairs not overlapping): a pose is taken each time the estimate's path
/// since the last taken one (at first since the start) reaches `length` [m]; each taken pose is paired with the next.
RelativeError rpe_path(const Trajectory& estimate, const Trajectory& truth, double length);

/// What is known about two moments of a run: the pose at `to` seen from the pose at `from`. The two are not
/// interchangeable: swapping them changes the translation error.
struct Relation {
  Stamp from;
  Stamp to;
  mrpt::math::TPose2D delta;
};

/// Kuemmerle et al. 2009: errors (delta_true)^-1 composed with delta, so relations at loop closures count like others.
struct RelationError {
  std::size_t relations = 0;  ///< compared
  std::size_t missing = 0;    ///< at least one stamp lies outside the estimate's time
  double mean_m = 0.0;        ///< mean absolute translation
  double std_m = 0.0;         ///< standard deviation of it (over n)
  double mean_m2 = 0.0;       ///< mean squared translation
  double mean_rad = 0.0;
  double std_rad = 0.0;
  double mean_rad2 = 0.0;
};

/// The estimate is interpolated at the stamps of the relations.
RelationError relation_error(const Trajectory& estimate, const std::vector<Relation>& relations);

/// How far relations name moments that a log has scans of. A few are between them where a log lost scans; many are of
/// another clock, or of another log.
struct RelationsAtScans {
  std::size_t relations = 0;  ///< both stamps lie in the time of the scans
  std::size_t between = 0;    ///< of these, a stamp of theirs is farther than 1 ms from that of any scan

  bool doubtful() const { return 20 * between > relations; }
};
RelationsAtScans relations_at_scans(const Trajectory& scans, const std::vector<Relation>& relations);

/// What to tell, in one line, of relations many of which name moments without a scan: poses between two scans are
/// guessed, and the error of such relations is worth little. Nothing: they are of these scans. `path`, `log`: where
/// both are from.
std::optional<std::string> between_scans(const Trajectory& scans, const std::vector<Relation>& relations,
                                         const std::string& path, const std::string& log);

/// Of relations that somebody claims, those that the truth contradicts by more than 0.3 m or 0.2 rad: a loop so far off
/// leads to another place. Nothing is said of those with a stamp outside the time of the truth.
std::size_t false_relations(const std::vector<Relation>& claimed, const Trajectory& truth);

/// Relations a true trajectory implies: from each pose taken every `length` [m] of path to the next, and to the
/// earliest taken one that lies within `near` [m] and at least `loop` [m] of path back.
std::vector<Relation> relations_of(const Trajectory& truth, double length = 1.0, double near = 1.0, double loop = 10.0);

/// Reads relations: lines `stamp stamp x y z roll pitch yaw` in seconds, metres, radians; '#' starts a comment; z, roll
/// and pitch are dropped. Throws InputError with file and line.
std::vector<Relation> read_relations(const std::string& path);

}  // namespace rubble::scoring
