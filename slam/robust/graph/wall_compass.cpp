#include "slam/robust/graph/wall_compass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace rubble::slam {

namespace {

constexpr double square(double a) { return a * a; }

constexpr double kLeastDirection = square(deg_to_rad(0.1));    ///< no building is known better [rad^2]
constexpr double kLeastVariance = square(deg_to_rad(0.6));     ///< of the walls that one key frame sees [rad^2]
constexpr double kExpectedVariance = square(deg_to_rad(0.7));  ///< of how far walls are off, before any were seen ...
constexpr double kExpectedTimes = 10.0;                        ///< ... which counts as so many key frames
constexpr int kStrangers = 15;                                 ///< key frames on end that raise a doubt
constexpr int kDirections = 90;                                ///< that are told apart at first
constexpr double kSameWalls = square(2.0);  ///< key frames on end see the same walls: each tells less than one alone

/// The mean of what lies within kOtherWalls of the direction with most walls.
double direction_of_walls(const PoseGraph& graph) {
  std::vector<double> angles;
  std::array<int, kDirections> votes{};
  const auto place = [](double angle) {
    return std::clamp(static_cast<int>((angle / (0.5 * kPi) + 0.5) * kDirections), 0, kDirections - 1);
  };
  for (const GraphWalls& walls : graph.walls) {
    angles.push_back(wrap_quarter(graph.nodes[static_cast<std::size_t>(walls.node)].phi + walls.angle));
    ++votes[static_cast<std::size_t>(place(angles.back()))];
  }
  const auto votes_around = [&](int k) {
    int sum = 0;
    for (int step = -2; step <= 2; ++step)
      sum += votes[static_cast<std::size_t>((k + step + kDirections) % kDirections)];
    return sum;
  };
  int best = 0;
  for (int k = 1; k < kDirections; ++k)
    if (votes_around(k) > votes_around(best)) best = k;
  double direction = ((best + 0.5) / kDirections - 0.5) * 0.5 * kPi;
  for (int round = 0; round < 2; ++round) {
    double sum = 0.0;
    double weight = 0.0;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const double off = wrap_quarter(angles[k] - direction);
      if (std::abs(off) > kOtherWalls) continue;
      const double information = 1.0 / (graph.walls_variance + graph.walls[k].variance);
      sum += information * off;
      weight += information;
    }
    if (weight > 0.0) direction = wrap_quarter(direction + sum / weight);
  }
  return direction;
}

}  // namespace

void WallCompass::learn(double off) {
  squares_ += square(off);
  ++seen_;
}

bool WallCompass::doubted() const { return strangers_ >= kStrangers; }

double WallCompass::variance() const {
  const double off = (squares_ + kExpectedTimes * kExpectedVariance) / (seen_ + kExpectedTimes);
  return std::max(kLeastVariance, kSameWalls * off);
}

Eigen::Vector3d WallCompass::look(double heading, const std::optional<WallDirection>& walls,
                                  Eigen::Matrix3d& covariance) {
  if (!walls) return Eigen::Vector3d::Zero();
  if (!direction_) {
    direction_ = wrap_quarter(heading + walls->angle);
    direction_variance_ = covariance(2, 2) + variance() + square(walls->sigma);
    with_pose_ = covariance.col(2);
    return Eigen::Vector3d::Zero();
  }
  const double off = wrap_quarter(*direction_ - heading - walls->angle);
  if (std::abs(off) > kOtherWalls) {
    ++strangers_;
    return Eigen::Vector3d::Zero();
  }
  strangers_ = 0;
  // What is measured is the direction of the walls less the heading.
  const Eigen::Vector3d by_pose = with_pose_ - covariance.col(2);
  const double by_direction = direction_variance_ - with_pose_[2];
  const double spread = by_direction - by_pose[2] + variance() + square(walls->sigma);
  learn(off);
  direction_ = wrap_quarter(*direction_ - by_direction / spread * off);
  covariance -= by_pose * by_pose.transpose() / spread;
  with_pose_ -= by_pose * (by_direction / spread);
  direction_variance_ = std::max(kLeastDirection, direction_variance_ - square(by_direction) / spread);
  return -off / spread * by_pose;
}

void WallCompass::set_right(const PoseGraph& graph) {
  strangers_ = 0;
  if (graph.walls.empty()) return;
  direction_ = direction_of_walls(graph);
  direction_variance_ = kLeastDirection;
  with_pose_.setZero();
  if (seen_ > 0) return;
  for (const GraphWalls& walls : graph.walls) {
    const double off = wrap_quarter(*direction_ - graph.nodes[static_cast<std::size_t>(walls.node)].phi - walls.angle);
    if (std::abs(off) <= kOtherWalls) learn(off);
  }
}

}  // namespace rubble::slam
