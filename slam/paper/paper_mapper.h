#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/angle.h"
#include "base/yaml/binder.h"
#include "robot/model.h"
#include "slam/mapper.h"
#include "slam/paper/particle_filter.h"
#include "slam/scan/level_scan.h"
#include "slam/scan/scan_matcher.h"

namespace rubble::slam {

/// What the gate of motion keeps back: a whole mapping step, or, as printed, the resampling alone.
enum class GatedPart { Step, Resampling };
/// The scan that the ICP matches with: the last that was mapped, or, as printed, the last one.
enum class IcpTarget { LastMapped, LastScan };
/// The moment that a scan's pose belongs to: the middle of its sweep, or, as printed, its stamp.
enum class SweepReference { Middle, Stamp };

/// Parameters of the paper-mode mapper (section III.B; where the paper is silent the origin is named in docs/slam.md).
struct PaperConfig {
  int map_cells = 800;       ///< cells a side at the start; the map grows when needed
  double resolution = 0.05;  ///< cell edge [m]
  int particles = 300;
  double top_share = 0.05;              ///< share of heaviest particles whose mean is the pose
  MotionError motion_error;             ///< by which the particles drift apart
  double gate_distance = 0.15;          ///< mapping step after this much motion [m]; at least 0.02 in the paper
  double gate_turn = deg_to_rad(10.0);  ///< or this much turn [rad]; at least 5 deg in the paper
  GatedPart gated = GatedPart::Step;
  IcpTarget icp_target = IcpTarget::LastMapped;
  bool icp_trimmed = true;  ///< pair only what the other scan of the ICP saw as well
  SweepReference sweep_reference = SweepReference::Middle;
  bool icp = true;               ///< refine the odometry by ICP of the last and the current scan
  LevelScanConfig scan;          ///< what becomes of beams without a return, and far away
  bool deskew = true;            ///< place each beam by its own time; the paper does not, and pays for it
  int first_scans = 5;           ///< so many scans are mapped at the start although the robot stands
  int max_map_cells = 8000;      ///< the map grows up to so many cells a side
  double coverage_margin = 0.1;  ///< ICP pairs what both scans saw, and saw go on for so much to either side [m]
  double rim_margin = 0.1;    ///< eq. (2) leaves out beams so close to where a surface goes out of sight [m]; 0: none
  SurfaceConfig surface;      ///< how scans are thinned for the ICP
  ScanMatcherConfig matcher;  ///< thresholds of the ICP
};

void bind(Binder& binder, PaperConfig& config);

/// Online SLAM as Robbie X does it: odometry interpolated at the scan stamp, ICP, particle filter, two-plane map.
/// Poses of the past never change. Its covariance is that of the particles.
class PaperMapper : public Mapper {
 public:
  PaperMapper(const robot::RobotModel& model, const PaperConfig& config, std::uint64_t seed);
  ~PaperMapper() override;

  void update(const robot::Inputs& inputs) override;
  const CountMap& map() const override;
  mrpt::math::TPose2D pose() const override;
  PoseCovariance covariance() const override;
  std::uint64_t revision() const override { return 0; }
  std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const override;
  const Trajectory& trajectory() const override;
  const Trajectory& live_trajectory() const override { return trajectory(); }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override;
  const MapperCounts& counts() const override;
  /// icp_accepted: the ICP refined the a-priori pose; icp_rejected: odometry was kept.
  std::vector<MapperFigure> figures() const override;

  const std::vector<Particle>& particles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble::slam
