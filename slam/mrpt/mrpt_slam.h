#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/angle.h"
#include "base/pose_covariance.h"
#include "robot/measurements.h"
#include "robot/model.h"

/// What of MRPT needs libmrpt-slam, libmrpt-maps and libmrpt-obs, which load two hundred other libraries: it lies in
/// the module rubble_mrpt_slam.so, and only mappers that use it wait for them.
namespace rubble::slam {

struct IcpOptions {
  double first_distance = 0.30;  ///< farthest a correspondence may reach at the start [m]
  double last_distance = 0.05;   ///< and at the end [m]
  int max_iterations = 40;
};

/// Points in the plane, as MRPT keeps them [m].
struct FloatPoint {
  float x;
  float y;
};

/// Point-to-point mrpt::slam::CICP, without its random draws.
class Icp {
 public:
  virtual ~Icp() = default;
  /// Makes these the points that later ones are matched with.
  virtual void set_last(const std::vector<FloatPoint>& points) = 0;
  struct Match {
    mrpt::math::TPose2D T_last_now;
    double goodness = 0.0;  ///< share of the points of `now` that found a partner
  };
  virtual Match align(const std::vector<FloatPoint>& now, const mrpt::math::TPose2D& T_last_now_prior) = 0;
};

/// What a map builder's grid holds, row by row from the south-western corner.
struct BuilderGrid {
  float x0 = 0.0f;  ///< western edge [m]
  float y0 = 0.0f;  ///< southern edge [m]
  int width = 0;
  int height = 0;
  std::vector<float> p_free;
};

/// One of MRPT's map builders.
class MapBuilder {
 public:
  virtual ~MapBuilder() = default;
  /// One pair of action and observation: the way since the last one by odometry, and a scan taken in one instant.
  virtual void process(const mrpt::math::TPose2D& step, const robot::LaserScan& scan) = 0;
  /// T_map_base at each of its steps so far; steps may be fewer than scans.
  virtual std::vector<mrpt::math::TPose2D> path() const = 0;
  virtual PoseCovariance uncertainty() const = 0;
  virtual BuilderGrid grid() const = 0;
  /// Observations in the map: when it changes, so did the map.
  virtual std::size_t inserted() const = 0;
};

/// Parameters of MRPT's icp-slam. Where not said otherwise, those of the file icp-slam_demo_classic.ini that MRPT
/// ships; the distances are made for rooms of a few metres.
struct MrptIcpConfig {
  double resolution = 0.05;                ///< of the grid that is shown [m]
  double localize_distance = 0.1;          ///< ICP after so much motion [m]; shipped 0.2
  double localize_turn = deg_to_rad(5.0);  ///< or turn [rad]
  double insert_distance = 0.3;            ///< a scan enters the map after so much motion [m]; shipped 1.2
  double insert_turn = deg_to_rad(15.0);   ///< or turn [rad]; shipped 45 deg
  double min_goodness = 0.4;               ///< of an ICP that is believed
};

/// Parameters of MRPT's rbpf-slam with its ICP-based proposal. Where not said otherwise, those of the file
/// gridmapping_RBPF_grid_ICPbased_malaga.ini that MRPT ships; the distances are made for rooms of a few metres.
struct MrptRbpfConfig {
  double resolution = 0.05;  ///< cell edge [m]; shipped 0.07
  int particles = 10;
  double localize_distance = 0.2;           ///< the filter steps after so much motion [m]; shipped 1.2
  double localize_turn = deg_to_rad(10.0);  ///< or turn [rad]; shipped 35 deg
  double insert_distance = 0.2;             ///< a scan enters the maps after so much motion [m]; shipped 1.2
  double insert_turn = deg_to_rad(10.0);    ///< or turn [rad]; shipped 35 deg
};

/// What the module makes.
struct MrptSlam {
  std::unique_ptr<Icp> (*icp)(const IcpOptions& options);
  /// mrpt::slam::CMetricMapBuilderICP: each scan is matched to a map of points. Poses of the past stay.
  std::unique_ptr<MapBuilder> (*icp_builder)(const robot::RobotModel& model, const MrptIcpConfig& config);
  /// mrpt::slam::CMetricMapBuilderRBPF: particles that each carry a grid and a path. Shown are grid and path of the
  /// most likely one; when another takes its place, the past moves. Seeds MRPT's one random generator.
  std::unique_ptr<MapBuilder> (*rbpf_builder)(const robot::RobotModel& model, const MrptRbpfConfig& config,
                                              std::uint64_t seed);
};

/// The border between the program and the module: one function, found by its name.
constexpr const char* kMrptSlamSymbol = "rubble_mrpt_slam";
using MrptSlamFunction = const MrptSlam* (*)();

/// The module, loaded when first asked for. Throws RunError where it cannot be.
const MrptSlam& mrpt_slam();

}  // namespace rubble::slam
