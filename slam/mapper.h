#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/pose_covariance.h"
#include "base/trajectory.h"
#include "robot/measurements.h"
#include "slam/grid/count_map.h"

namespace rubble::slam {

/// A mapper cannot go on (its process died, hangs or talks nonsense); what() is one line. The run fails, with its
/// folder complete up to there.
class MapperLost : public RunError {
 public:
  using RunError::RunError;
};

/// What every mapper counts.
struct MapperCounts {
  std::uint64_t scans = 0;         ///< received
  std::uint64_t mapped = 0;        ///< in the map
  std::uint64_t out_of_order = 0;  ///< dropped: empty, or not younger than the one before
};

/// A number of one mapper's own, for score.json ("icp_accepted", "loops_closed").
struct MapperFigure {
  // Those that others than people read.
  static constexpr const char* kPlaceKnown = "place_known";  ///< 1: it knows where it is on an earlier run's map
  static constexpr const char* kLoopsClosed = "loops_closed";
  static constexpr const char* kLoopsRemoved = "loops_removed";
  static constexpr const char* kMapDoubted = "map_doubted";      ///< 1: the mapper does not believe its map
  static constexpr const char* kTurnsAgainst = "turns_against";  ///< 1: scans turn the other way than the wheels
  static constexpr const char* kMostWork = "most_work_ms";       ///< of a scan, in millions of counted units, not time

  std::string key;
  double value = 0.0;
};

/// A place that a search for loops found: the base at `to` seen from the base at `from`, long before.
struct FoundLoop {
  static constexpr const char* kClosed = "closed";

  Stamp from;
  Stamp to;
  mrpt::math::TPose2D T_from_to;
  std::optional<mrpt::math::TPose2D> T_map_from;  ///< in the map as it is now; nothing where that is not known
  std::string end;                                ///< what became of it, in the words of loops.csv (docs/slam.md)
  // The tests, shares of the points; nothing where it was not asked.
  std::optional<double> inliers;
  std::optional<double> contradiction;           ///< seen through walls there
  std::optional<double> expected_contradiction;  ///< where the robot was expected

  /// It holds: it closes a loop, and was not removed again.
  bool closed() const { return end == kClosed; }
};

/// What files call the scan of that stamp, where it has another name outside.
using StampName = std::function<Stamp(Stamp)>;

/// Numbers about each scan, for a file and a picture of it (docs/slam.md says what they mean).
struct ScanRecords {
  std::vector<std::string> columns;  ///< names, with their units
  std::vector<Stamp> stamps;         ///< of the scans
  std::vector<float> values;         ///< scan by scan, one for each column
};

/// Online SLAM: sees a robot's measurements tick by tick, keeps a map and knows where the robot is in it.
///
/// What a mapper promises:
/// - The map frame is the base frame at the reference time of the first scan: x forward, y left, metres and radians.
/// - Everything may be asked at any time, also before the first scan: the pose is then zero, the map all unknown.
///   References stay valid, and what they show unchanged, until the next update.
/// - Deterministic: same parameters, seed and inputs give the same bits, whatever the machine's speed.
///   It reads no clock and knows the robot by its measurements alone; simulated, replayed and real ones
///   look the same.
/// - It accepts anything: scans without odometry, late, doubled or empty ones, silence.
///   Poor data make a poor map, never an exception; those are for what cannot go on (out of memory,
///   MapperLost).
///   After one it can still be asked, and shows what it knew.
class Mapper {
 public:
  virtual ~Mapper() = default;

  /// Digests all that arrived in one tick.
  virtual void update(const robot::Inputs& inputs) = 0;
  /// The measurements are over: work put off is done now, so that map and trajectory are final.
  virtual void finish() {}

  virtual const CountMap& map() const = 0;
  /// T_map_base at the newest odometry (or scan, where there is none).
  virtual mrpt::math::TPose2D pose() const = 0;
  /// Of pose(): x, y [m^2], heading [rad^2], in the map frame, relative to the map's origin. Zero: not estimated.
  virtual PoseCovariance covariance() const = 0;
  /// Rises whenever poses of the past move in the map (a closed loop). What is anchored to stamps by pose_at() is asked
  /// anew then.
  virtual std::uint64_t revision() const = 0;
  /// Where the base was at a past `stamp`, in the map as it is now; interpolated between scans. Nothing for stamps
  /// outside the trajectory and what dead reckoning adds to its end.
  virtual std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const = 0;
  /// T_map_base at the reference time of each scan, in order, as known now.
  virtual const Trajectory& trajectory() const = 0;
  /// The same as known at the scan: nothing of it changes later.
  virtual const Trajectory& live_trajectory() const = 0;
  /// Whether map() shows each scan where pose_at() has it now. After poses of the past moved a map may be drawn anew
  /// bit by bit, over many updates.
  virtual bool settled() const { return true; }
  /// The newest scan's hits in the map frame, mapped or not (for pictures and for checking a path against fresh
  /// obstacles).
  virtual const std::vector<mrpt::math::TPoint2D>& last_hits() const = 0;

  /// How far the robot came, by its odometry alone, since scans last told how far it came [m]. Between walls that look
  /// the same all along nobody can tell a robot that drives from one whose wheels spin. 0 where the mapper does not
  /// say.
  virtual double blind_way() const { return 0.0; }

  virtual const MapperCounts& counts() const = 0;
  virtual std::vector<MapperFigure> figures() const { return {}; }
  /// Null: this kind keeps none.
  virtual const ScanRecords* scan_records() const { return nullptr; }
  /// CSV: a line for each place that a search for loops found, with the tests it stood; empty from mappers that look
  /// for none. `name`: what it calls the key frames.
  virtual std::string loop_table(const StampName& /*name*/) const { return {}; }
  /// The same, line by line. Empty from mappers that look for none or do not tell, and while it is not known where in
  /// the map they lie.
  virtual std::vector<FoundLoop> found_loops() const { return {}; }
  /// The map with all that a mapper needs to go on with it in another run, as bytes (slam/robust/map/saved_map.h).
  /// Empty: this kind cannot, or nothing is mapped.
  virtual std::string saved_map() const { return {}; }
};

}  // namespace rubble::slam
