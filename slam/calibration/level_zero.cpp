#include "slam/calibration/level_zero.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "robot/hardware_units.h"

namespace rubble::slam {
namespace {

constexpr double kStill = 0.002;             ///< less way between two reports is none [m]
constexpr double kStillTurn = 0.003;         ///< [rad]
constexpr double kSettled = 0.5;             ///< after braking the body still rocks [s]
constexpr double kShortest = 0.5;            ///< of what is left of a stand [s]
constexpr double kTurned = 2.0 / 3.0 * kPi;  ///< headings so far apart tell the floor's slope from the sensor's zero

/// The robot stood still from `from` to `to`.
struct Stand {
  Stamp from;
  Stamp to;
  double heading = 0.0;  ///< [rad]
  double pitch = 0.0;    ///< felt, in the mean [rad]
  double roll = 0.0;
  double count = 0.0;  ///< of samples
};

std::vector<Stand> stands_of(const WheelTrack& wheels) {
  std::vector<Stand> stands;
  const auto& reports = wheels.reports();
  for (std::size_t i = 0; i < reports.size();) {
    std::size_t j = i;
    while (j + 1 < reports.size()) {
      const mrpt::math::TPose2D step = reports[j + 1].pose - reports[j].pose;
      if (length(step.x, step.y) > kStill || std::abs(wrap_angle(step.phi)) > kStillTurn) break;
      ++j;
    }
    const Stamp from = reports[i].stamp + kSettled;
    if (reports[j].stamp - from >= kShortest)
      stands.push_back({from, reports[j].stamp, wheels.pose_at(reports[j].stamp).phi, 0.0, 0.0, 0.0});
    i = j + 1;
  }
  return stands;
}

/// The angle that a share of gravity means.
double inclination(double acceleration) { return std::asin(std::clamp(acceleration / robot::kGravity, -1.0, 1.0)); }

void feel(std::vector<Stand>& stands, const std::vector<robot::Acceleration>& accelerations,
          const std::vector<robot::AimState>& aims, bool on_platform) {
  std::size_t aim = 0;
  std::size_t s = 0;
  for (const robot::Acceleration& a : accelerations) {
    while (aim + 1 < aims.size() && aims[aim + 1].stamp <= a.stamp) ++aim;
    while (s < stands.size() && stands[s].to < a.stamp) ++s;
    if (s == stands.size()) break;
    if (a.stamp < stands[s].from) continue;
    const bool aimed = on_platform && aim < aims.size();
    stands[s].pitch += inclination(a.x) - (aimed ? aims[aim].pitch : 0.0);
    stands[s].roll += inclination(a.y) - (aimed ? aims[aim].roll : 0.0);
    stands[s].count += 1.0;
  }
  for (Stand& stand : stands) {
    stand.pitch /= std::max(1.0, stand.count);
    stand.roll /= std::max(1.0, stand.count);
  }
  stands.erase(std::remove_if(stands.begin(), stands.end(), [](const Stand& stand) { return stand.count < 10.0; }),
               stands.end());
}

/// Whether the headings cover more than `kTurned`.
bool looks_round(const std::vector<Stand>& stands) {
  double widest = 0.0;
  for (const Stand& a : stands)
    for (const Stand& b : stands) widest = std::max(widest, std::abs(wrap_angle(a.heading - b.heading)));
  return widest > kTurned;
}

}  // namespace

std::optional<LevelZero> level_zero(const std::vector<robot::Acceleration>& accelerations,
                                    const std::vector<robot::AimState>& aims, const WheelTrack& wheels,
                                    robot::AccelerometerMount mount) {
  std::vector<Stand> stands = stands_of(wheels);
  feel(stands, accelerations, aims, mount == robot::AccelerometerMount::Platform);
  if (stands.empty()) return std::nullopt;

  // Felt pitch = zero + slope ahead, felt roll = zero + slope to the left; the floor's slope (u, v) does not turn
  // along: ahead = u cos h + v sin h, to the left = v cos h - u sin h.
  LevelZero zero;
  zero.slope_known = looks_round(stands);
  const int unknowns = zero.slope_known ? 4 : 2;
  const auto rows = static_cast<Eigen::Index>(2 * stands.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, unknowns);
  Eigen::VectorXd felt(rows);
  Eigen::Index row = 0;
  for (const Stand& stand : stands) {
    const double c = std::cos(stand.heading);
    const double s = std::sin(stand.heading);
    A(row, 0) = 1.0;
    A(row + 1, 1) = 1.0;
    if (zero.slope_known) {
      A(row, 2) = c;
      A(row, 3) = s;
      A(row + 1, 2) = -s;
      A(row + 1, 3) = c;
    }
    felt[row] = stand.pitch;
    felt[row + 1] = stand.roll;
    row += 2;
  }
  const Eigen::MatrixXd N = A.transpose() * A;
  const Eigen::VectorXd x = N.ldlt().solve(A.transpose() * felt);
  const Eigen::MatrixXd spread = N.ldlt().solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
  const double freedom = static_cast<double>(rows - unknowns);
  constexpr double kOneStand = 0.002;  // where nothing is left over to tell it [rad]
  const double sigma = freedom > 0.0 ? (A * x - felt).norm() / std::sqrt(freedom) : kOneStand;
  zero.pitch = x[0];
  zero.roll = x[1];
  zero.pitch_sigma = sigma * std::sqrt(spread(0, 0));
  zero.roll_sigma = sigma * std::sqrt(spread(1, 1));
  if (zero.slope_known) zero.slope = length(x[2], x[3]);
  zero.stands = static_cast<int>(stands.size());
  return zero;
}

}  // namespace rubble::slam
