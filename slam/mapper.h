#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "base/trajectory.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/grid/count_map.h"
#include "slam/paper/particle_filter.h"
#include "slam/scan/scan_matcher.h"

namespace rubble::slam {

/// Parameters of the paper-mode mapper (section III.B; where the paper is silent the origin is named in docs/slam.md).
struct MapperConfig {
  int map_cells = 800;       ///< cells a side at the start; the map grows when needed
  double resolution = 0.05;  ///< cell edge [m]
  int particles = 300;
  double top_share = 0.05;                       ///< share of heaviest particles whose mean is the pose
  double rotation_error = 0.05;                  ///< initial rotation error, share of the turn
  double heading_error_per_m = deg_to_rad(5.0);  ///< rotation error while driving [rad/m]
  double distance_error = 0.15;                  ///< translation error, share of the distance
  double gate_distance = 0.15;          ///< mapping step after this much motion [m]; at least 0.02 in the paper
  double gate_turn = deg_to_rad(10.0);  ///< or this much turn [rad]; at least 5 deg in the paper
  bool icp = true;                      ///< refine the odometry by ICP of the last and the current scan
  bool carve_misses = false;            ///< beams without a return free cells up to the range limit
  double max_range = 0.0;               ///< returns beyond are dropped [m]; 0: the scanner's own limit
  bool deskew = true;                   ///< place each beam by its own time; the paper does not, and pays for it
  int first_scans = 5;                  ///< so many scans are mapped at the start although the robot stands
  int max_map_cells = 8000;             ///< the map grows up to so many cells a side
  double coverage_margin = 0.1;         ///< ICP pairs what both scans saw, and saw go on for so much to either side [m]
  double rim_margin = 0.1;    ///< eq. (2) leaves out beams so close to where a surface goes out of sight [m]; 0: none
  SurfaceConfig surface;      ///< how scans are thinned for the ICP
  ScanMatcherConfig matcher;  ///< thresholds of the ICP
};

struct MapperCounts {
  std::uint64_t scans = 0;         ///< received
  std::uint64_t mapped = 0;        ///< stamped into the map
  std::uint64_t icp_accepted = 0;  ///< ICP refined the a-priori pose
  std::uint64_t icp_rejected = 0;  ///< odometry was kept
  std::uint64_t out_of_order = 0;  ///< scans dropped: empty, or not younger than the one before
};

/// Online SLAM as Robbie X does it: odometry interpolated at the scan stamp, ICP, particle filter, two-plane map.
/// The map frame is the base frame at the first scan. Deterministic: same config, seed and inputs give the same bits.
class Mapper {
 public:
  Mapper(const robot::RobotModel& model, const MapperConfig& config, std::uint64_t seed);
  ~Mapper();

  void update(const robot::Inputs& inputs);

  const CountMap& map() const;
  /// T_map_base at the newest odometry: the last mapped pose carried on by dead reckoning.
  mrpt::math::TPose2D pose() const;
  /// Estimated T_map_base at the reference time of each scan, in order.
  const Trajectory& trajectory() const;
  const std::vector<Particle>& particles() const;
  /// The newest scan's hits in the map frame, mapped or not (for pictures and for checking a path against fresh
  /// obstacles).
  const std::vector<mrpt::math::TPoint2D>& last_hits() const;
  const MapperCounts& counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::slam
