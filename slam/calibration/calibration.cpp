#include "slam/calibration/calibration.h"

#include <cmath>
#include <cstdio>

#include "base/angle.h"
#include "slam/calibration/laser_motions.h"
#include "slam/calibration/setup_fit.h"

namespace rubble::slam {
namespace {

constexpr int kPasses = 4;         ///< matching and fitting in turn: sweeps are straightened by the setup found before
constexpr double kLeastWay = 2.0;  ///< [m]
constexpr double kLeastTurn = deg_to_rad(360.0);  ///< to and fro [rad]
constexpr int kLeastScans = 100;
constexpr double kMostPositionError = 0.03;         ///< [m]
constexpr double kMostTurnError = deg_to_rad(1.0);  ///< [rad]
/// Greater standard deviations are no calibration.
const RobotSetup kMostSigma{0.01, 0.01, {0.01, 0.01, deg_to_rad(0.5)}, 0.01};

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[300];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

/// Before anything is estimated.
std::string too_little(const WheelTrack& wheels, std::size_t scans) {
  if (wheels.reports().empty()) return "there is no odometry in it; a calibration needs wheels and scanner together";
  if (scans < static_cast<std::size_t>(kLeastScans))
    return text("there are only %zu scans in it; a calibration needs %d or more", scans, kLeastScans);
  if (wheels.distance() < kLeastWay)
    return text("the robot drove only %.1f m; a calibration needs %.0f m or more, to and fro", wheels.distance(),
                kLeastWay);
  if (wheels.turn() < kLeastTurn)
    return text("the robot turned only %.0f deg in all; a calibration needs %.0f or more, on the spot and both ways",
                rad_to_deg(wheels.turn()), rad_to_deg(kLeastTurn));
  return "";
}

/// What came out but cannot be relied on.
std::string doubtful(const SetupFit& fit) {
  if (fit.scans < kLeastScans)
    return text(
        "only %d scans could be laid on others; drive where walls stand within the scanner's range on all sides",
        fit.scans);
  if (!(fit.position_error < kMostPositionError) || !(fit.turn_error < kMostTurnError))
    return text(
        "scans and wheels disagree by %.0f mm and %.1f deg; drive slowly on firm, flat ground and let nothing move "
        "around the robot",
        1e3 * fit.position_error, rad_to_deg(fit.turn_error));
  const RobotSetup& s = fit.sigma;
  const auto unknown = [](const char* what, double sigma, const char* unit, const char* remedy) {
    return text("%s is only known to +- %.3g %s; %s", what, sigma, unit, remedy);
  };
  if (!(s.distance_scale < kMostSigma.distance_scale))
    return unknown("the wheels' distance", 100.0 * s.distance_scale, "%", "drive longer straight stretches");
  if (!(s.turn_scale < kMostSigma.turn_scale))
    return unknown("the wheels' turn", 100.0 * s.turn_scale, "%", "turn more");
  if (!(s.T_base_laser.x < kMostSigma.T_base_laser.x) || !(s.T_base_laser.y < kMostSigma.T_base_laser.y))
    return unknown("the laser's place", 1e3 * std::max(s.T_base_laser.x, s.T_base_laser.y), "mm",
                   "turn more on the spot, with walls near by on all sides");
  if (!(s.T_base_laser.phi < kMostSigma.T_base_laser.phi))
    return unknown("the laser's direction", rad_to_deg(s.T_base_laser.phi), "deg", "drive longer straight stretches");
  if (!(s.delay < kMostSigma.delay))
    return unknown("the laser's delay", 1e3 * s.delay, "ms", "begin to turn and stop more often");
  return "";
}

}  // namespace

void Calibrator::add(const robot::Inputs& inputs) {
  for (const robot::Odometry& odometry : inputs.odometry) wheels_.add(odometry);
  scans_.insert(scans_.end(), inputs.scans.begin(), inputs.scans.end());
  accelerations_.insert(accelerations_.end(), inputs.accelerations.begin(), inputs.accelerations.end());
  aims_.insert(aims_.end(), inputs.aims.begin(), inputs.aims.end());
}

Calibration Calibrator::calibrate(const RobotSetup& taken_for, robot::AccelerometerMount mount) const {
  Calibration calibration;
  calibration.refusal = too_little(wheels_, scans_.size());
  if (!calibration.refusal.empty()) return calibration;
  WheelTrack wheels = wheels_;
  SetupFit fit;
  fit.setup = taken_for;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<LaserStretch> stretches = laser_motions(scans_, wheels, fit.setup, LaserMotionsConfig{});
    fit = fit_setup(stretches, wheels, fit.setup);
    calibration.stretches = static_cast<int>(stretches.size());
  }
  calibration.refusal = doubtful(fit);
  calibration.setup = fit.setup;
  calibration.sigma = fit.sigma;
  calibration.scans = fit.scans;
  calibration.position_error = fit.position_error;
  calibration.turn_error = fit.turn_error;
  calibration.driven = wheels.distance();
  calibration.turned = wheels.turn();
  calibration.level = level_zero(accelerations_, aims_, wheels, mount);
  return calibration;
}

}  // namespace rubble::slam
