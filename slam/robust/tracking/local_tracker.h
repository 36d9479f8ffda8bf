#pragma once

#include <cstdint>

#include "robot/slope_creep.h"
#include "slam/robust/graph/key_frames.h"
#include "slam/robust/matching/correlator.h"
#include "slam/robust/matching/scan_fit.h"

namespace rubble::slam {

struct TrackerConfig {
  double cell = 0.0;  ///< of the surfels [m]; 0, here and below: by the reach of the scanner, see suited_to()
  int frames = 30;    ///< key frames of the local map
  double path = 0.0;  ///< but no older than so much path [m]
  // Sigmas of the odometry, as the prior of the fit.
  double distance_error = 0.15;    ///< share of the distance
  double least_distance = 0.01;    ///< [m]
  double turn_error = 0.20;        ///< share of the turn
  double least_turn = 0.02;        ///< [rad]
  double turn_error_per_m = 0.10;  ///< [rad/m]
  double vain_error = 1.0;         ///< share of the way that wheels rolled in vain; 0: they are always believed
  double wheel_friction =
      robot::kRubberOnWood;     ///< of a skid-steered robot, which slides down a slope as it turns; 0: does not
  double creep_error = 0.5;     ///< share of what it is expected to slide
  double large_step = 0.35;     ///< longer steps between scans are searched first [m]
  double large_turn = 0.2;      ///< and larger turns [rad]
  double slip_chi2 = 16.0;      ///< odometry off by more (squared sigmas) is doubted
  double most_speed = 0.8;      ///< of a robot whose odometry is of no use [m/s] ...
  double most_turn_rate = 1.8;  ///< ... [rad/s]
  bool hold_leaps = true;       ///< a match farther off than a robot can move waits for the next ones to agree
  double lost_inliers = 0.35;   ///< share below which the place counts as lost
  double search_cell = 0.05;    ///< raster of the search [m]
  double search_blur = 0.0;     ///< [m]
};

/// What is known of the motion since the last scan before the scan is looked at.
struct ExpectedMotion {
  mrpt::math::TPose2D T_last_now;  ///< as odometry says, and down the slope that the robot turns on
  /// As the last scans' motion would go on; nothing when they are too long ago to say.
  std::optional<mrpt::math::TPose2D> carried;
  mrpt::math::TPoint2D crept{0.0, 0.0};  ///< how much of it that is [m]
  double in_vain = 0.0;  ///< share of their way that the wheels roll in vain, as of the turns of the last moments
  double time = 0.0;     ///< since the last scan [s]
  double doubt = 0.0;    ///< of the odometry, 0: as good as wheels are, 1: it says nothing
  bool told = false;     ///< it has spoken; what may be doubted is what it says
  bool ramps = false;    ///< the tilt is known, so there may be ramps: leaps are held
  bool level = true;     ///< the scan was taken level, by a scan plane that held still
  bool again = false;    ///< the same scan once more, straightened by a better motion

  /// What is believed of `T_last_now`: wheels that turn the robot in vain roll in vain as well. Down the slope it
  /// slides all the same.
  mrpt::math::TPose2D believed() const {
    return {T_last_now.x - in_vain * (T_last_now.x - crept.x), T_last_now.y - in_vain * (T_last_now.y - crept.y),
            T_last_now.phi};
  }
};

/// How a scan lies on the local map.
struct Tracked {
  ScanFit fit;                 ///< pose relative to the key frame of the local map
  bool found = false;          ///< false: too little to see, the odometry stands
  bool slipped = false;        ///< the odometry was doubted
  bool relocated = false;      ///< found again after being lost
  double odometry_chi2 = 0.0;  ///< squared sigmas between the pose found and what undoubted odometry expects
  bool lost = false;           ///< neither odometry nor the scan tell where the robot is
  bool held = false;           ///< the match was farther off than a robot can move: it is not believed yet
};

/// Follows the robot from scan to scan on a local map of key frames, in the frame of the one it hangs on.
class LocalTracker {
 public:
  explicit LocalTracker(const TrackerConfig& config) : config_(config) {}

  /// Takes the key frames that lead to `here` as the local map; those around it where `here` is an old one.
  void redraw(const KeyFrames& frames, int here, Work* work);
  /// Takes these as the local map, in the frame of the first.
  void redraw(const KeyFrames& frames, std::vector<int> local, Work* work);
  /// Finds the scan; `T_frame_last`: the last one, relative to that key frame.
  Tracked track(const KeyFrames& frames, const Cloud& cloud, const ExpectedMotion& motion,
                const mrpt::math::TPose2D& T_frame_last, Work* work);
  /// How far odometry says that the robot came since a scan last told how far it came, as between two walls that look
  /// the same all along [m].
  double blind_way() const { return blind_way_; }

 private:
  /// How far a robot may be from where it is expected.
  struct Reach {
    double distance;  ///< [m]
    double turn;      ///< [rad]
  };
  Reach reach(const ExpectedMotion& motion) const;
  Eigen::Matrix3d prior_information(const ExpectedMotion& motion) const;
  std::optional<CorrelativeSearch::Found> look_around(const Cloud& cloud, const SearchWindow& window, double floor,
                                                      double later_floor, Work* work);
  std::optional<CorrelativeSearch::Found> look_elsewhere(double floor, const SearchExclusion& exclusion, Work* work);
  std::optional<CorrelativeSearch::Found> found(Work* work);
  ScanFit best_of_several(const Cloud& cloud, const PosePrior& prior, double distance, double turn, ScanFit fit,
                          Work* work);
  ScanFit without_odometry(const Cloud& cloud, const ExpectedMotion& motion, const PosePrior& prior,
                           const std::optional<mrpt::math::TPose2D>& carried, ScanFit fit, Work* work);
  void doubt_odometry(const KeyFrames& frames, const Cloud& cloud, const PosePrior& prior,
                      const std::optional<mrpt::math::TPose2D>& carried, const Reach& reach, Tracked& tracked,
                      Work* work);
  bool leaps(const mrpt::math::TPose2D& step, const ExpectedMotion& motion) const;
  void hold_leap(const ExpectedMotion& motion, const PosePrior& odometry,
                 const std::optional<mrpt::math::TPose2D>& carried, const mrpt::math::TPose2D& T_frame_last,
                 Tracked& tracked, Work* work);
  void believe_again(const PosePrior& odometry, ScanFit& fit, Work* work) const;
  bool overrules(const KeyFrames& frames, const Cloud& cloud, const ScanFit& found, const ScanFit& expected,
                 Work* work) const;
  std::optional<ScanFit> any_heading(const Cloud& cloud, const PosePrior& prior, double distance, Work* work);

  /// A correction that matches ask for, in the frame of the local map.
  struct Leap {
    mrpt::math::TPose2D correction;
    int asked = 0;           ///< by so many scans on end
    int held = 0;            ///< scans on end in which some leap was held
    double asked_for = 0.0;  ///< the time of these scans [s]
    double held_for = 0.0;   ///< [s]
  };

  const TrackerConfig config_;
  Leap leap_;
  double blind_way_ = 0.0;             ///< [m]
  std::vector<OrientedPoint> points_;  ///< of the scan that is looked for, ends of walls among them
  std::vector<int> local_;             ///< key frames of the local map, the one whose frame it is in first
  SurfelGrid surfels_;
  Correlator correlator_;
  CorrelativeSearch search_;
  bool correlator_ready_ = false;
};

}  // namespace rubble::slam
