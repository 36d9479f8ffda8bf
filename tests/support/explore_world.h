#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.h"
#include "base/rng.h"
#include "robot/commands.h"
#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/paper/paper_mapper.h"

namespace rubble::test {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Maps without any error, so that laws are about exploration alone.
inline slam::PaperConfig exact_mapper() {
  slam::PaperConfig config;
  config.map_cells = 400;
  config.particles = 1;
  config.motion_error.rotation = 0.0;
  config.motion_error.heading_per_m = 0.0;
  config.motion_error.distance = 0.0;
  config.icp = false;
  return config;
}

struct Segment {
  TPoint2D a;
  TPoint2D b;
};

inline double distance_to(const Segment& s, const TPoint2D& p) {
  const double dx = s.b.x - s.a.x;
  const double dy = s.b.y - s.a.y;
  const double length2 = dx * dx + dy * dy;
  const double u = length2 > 0.0 ? std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - s.a.x - u * dx, p.y - s.a.y - u * dy);
}

/// A flat maze of pallets, walls as segments. Cell (0, 0) is the south-west one, its centre the origin.
struct Maze {
  static constexpr double kPallet = 1.2;  ///< [m]
  int columns = 0;
  int rows = 0;
  std::vector<Segment> walls;
  TPose2D start;

  TPoint2D centre(int column, int row) const { return {column * kPallet, row * kPallet}; }

  /// The wall on the east (or north) side of a cell; column or row -1: the arena's own west or south wall.
  void wall_east(int column, int row) {
    const double x = (column + 0.5) * kPallet;
    walls.push_back({{x, (row - 0.5) * kPallet}, {x, (row + 0.5) * kPallet}});
  }
  void wall_north(int column, int row) {
    const double y = (row + 0.5) * kPallet;
    walls.push_back({{(column - 0.5) * kPallet, y}, {(column + 0.5) * kPallet, y}});
  }
  void box(const TPoint2D& centre, double width, double height) {
    const TPoint2D a{centre.x - 0.5 * width, centre.y - 0.5 * height};
    const TPoint2D b{centre.x + 0.5 * width, centre.y + 0.5 * height};
    walls.push_back({a, {b.x, a.y}});
    walls.push_back({{b.x, a.y}, b});
    walls.push_back({b, {a.x, b.y}});
    walls.push_back({{a.x, b.y}, a});
  }
};

/// A maze drawn as text, north up: "+--+" walls, "|" walls, R the start (heading east), b a 0.4 m box at the north
/// wall.
inline Maze maze(const std::vector<std::string>& drawing) {
  Maze m;
  m.rows = (static_cast<int>(drawing.size()) - 1) / 2;
  m.columns = (static_cast<int>(drawing[0].size()) - 1) / 3;
  const auto at = [&](std::size_t line, std::size_t column) {
    return line < drawing.size() && column < drawing[line].size() ? drawing[line][column] : ' ';
  };
  for (int row = 0; row < m.rows; ++row)
    for (int column = 0; column < m.columns; ++column) {
      const std::size_t line = static_cast<std::size_t>(2 * (m.rows - 1 - row) + 1);
      const std::size_t x = static_cast<std::size_t>(3 * column);
      if (at(line - 1, x + 1) == '-') m.wall_north(column, row);
      if (row == 0 && at(line + 1, x + 1) == '-') m.wall_north(column, -1);
      if (at(line, x + 3) == '|') m.wall_east(column, row);
      if (column == 0 && at(line, x) == '|') m.wall_east(-1, row);
      for (std::size_t k = 1; k <= 2; ++k) {
        const TPoint2D c = m.centre(column, row);
        if (at(line, x + k) == 'R') m.start = {c.x, c.y, 0.0};
        if (at(line, x + k) == 'b') m.box({c.x, c.y + 0.4}, 0.4, 0.4);
      }
    }
  return m;
}

/// A random maze by depth-first search in which every cell can be reached; `loops` is the share of inner walls removed.
inline Maze random_maze(int columns, int rows, double loops, std::uint64_t seed) {
  Rng rng(seed, "test maze");
  const auto id = [&](int c, int r) { return static_cast<std::size_t>(r * columns + c); };
  const std::size_t count = static_cast<std::size_t>(columns * rows);
  std::vector<char> east(count, 1), north(count, 1), seen(count, 0);
  std::vector<std::pair<int, int>> stack{{0, 0}};
  seen[0] = 1;
  while (!stack.empty()) {
    const auto [c, r] = stack.back();
    std::vector<std::pair<int, int>> next;
    for (const auto& [dc, dr] : {std::pair<int, int>{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      const int nc = c + dc;
      const int nr = r + dr;
      if (nc >= 0 && nr >= 0 && nc < columns && nr < rows && seen[id(nc, nr)] == 0) next.emplace_back(nc, nr);
    }
    if (next.empty()) {
      stack.pop_back();
      continue;
    }
    const auto [nc, nr] = next[rng.below(static_cast<std::uint32_t>(next.size()))];
    if (nr == r) east[id(std::min(c, nc), r)] = 0;
    if (nc == c) north[id(c, std::min(r, nr))] = 0;
    seen[id(nc, nr)] = 1;
    stack.emplace_back(nc, nr);
  }
  Maze m;
  m.columns = columns;
  m.rows = rows;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double draw_east = rng.uniform();
      const double draw_north = rng.uniform();
      if (c + 1 == columns || (east[id(c, r)] != 0 && draw_east >= loops)) m.wall_east(c, r);
      if (r + 1 == rows || (north[id(c, r)] != 0 && draw_north >= loops)) m.wall_north(c, r);
      if (c == 0) m.wall_east(-1, r);
      if (r == 0) m.wall_north(c, -1);
    }
  const std::uint32_t heading = rng.below(4);
  m.start.phi = wrap_angle(0.5 * kPi * heading);
  return m;
}

/// A kinematic unicycle with the model's acceleration limits, exact odometry and an exact scanner (whole scan at once).
/// It does not collide: tests ask how close it came.
class MazeRobot {
 public:
  MazeRobot(Maze maze, const robot::RobotModel& model) : maze_(std::move(maze)), model_(model), pose_(maze_.start) {}

  const TPose2D& pose() const { return pose_; }
  Stamp now() const { return now_; }
  const Maze& maze() const { return maze_; }
  Maze& maze() { return maze_; }
  /// Nothing moves while held: a robot stuck on something the scanner cannot see.
  bool held = false;
  /// A turn on the spot carries the robot so much to its left, as skid steering on a ramp does [m/rad].
  double wander = 0.0;
  bool scanner_works = true;

  /// One tick: moves, then measures.
  robot::Inputs step(const robot::Commands& commands) {
    const double dt = model_.tick;
    v_ = approach(v_, std::clamp(commands.drive.v, -model_.max_v, model_.max_v), model_.max_accel * dt);
    w_ = approach(w_, std::clamp(commands.drive.w, -model_.max_w, model_.max_w), model_.max_turn_accel * dt);
    if (held || commands.brake) v_ = w_ = 0.0;
    const double middle = pose_.phi + 0.5 * w_ * dt;
    const double left = std::abs(v_) < 0.15 ? wander * std::abs(w_) * dt : 0.0;
    pose_ = {pose_.x + v_ * dt * std::cos(middle) - left * std::sin(middle),
             pose_.y + v_ * dt * std::sin(middle) + left * std::cos(middle), wrap_angle(pose_.phi + w_ * dt)};
    now_ = now_ + dt;
    robot::Inputs inputs;
    inputs.now = now_;
    if (++ticks_ % 5 != 0) return inputs;
    inputs.odometry.push_back({now_, pose_ - maze_.start, v_, w_, false});
    if (scanner_works) inputs.scans.push_back(scan());
    return inputs;
  }

  /// Time passes without a tick while the robot comes to rest: a device was away.
  void wait(double seconds) {
    now_ = now_ + seconds;
    v_ = w_ = 0.0;
  }

  /// Distance from the turn centre to the nearest wall [m].
  double clearance() const {
    double d = std::numeric_limits<double>::infinity();
    for (const Segment& s : maze_.walls) d = std::min(d, distance_to(s, {pose_.x, pose_.y}));
    return d;
  }

  /// Whether a wall reaches into the body's rectangle.
  bool touches() const {
    for (const Segment& s : maze_.walls) {
      double low = 0.0;
      double high = 1.0;
      const TPoint2D a = pose_.inverseComposePoint(s.a);
      const TPoint2D b = pose_.inverseComposePoint(s.b);
      const bool meets =
          clip(a.x, b.x, 0.5 * model_.length, low, high) && clip(a.y, b.y, 0.5 * model_.width, low, high);
      if (meets && low <= high) return true;
    }
    return false;
  }

 private:
  static double approach(double value, double target, double step) {
    return value + std::clamp(target - value, -step, step);
  }

  /// Cuts the part of a..b (parameter low..high) to |coordinate| <= half.
  static bool clip(double a, double b, double half, double& low, double& high) {
    const double d = b - a;
    if (d == 0.0) return std::abs(a) <= half;
    const double u = (-half - a) / d;
    const double v = (half - a) / d;
    low = std::max(low, std::min(u, v));
    high = std::min(high, std::max(u, v));
    return low <= high;
  }

  robot::LaserScan scan() const {
    const robot::LaserModel& laser = model_.laser;
    robot::LaserScan scan;
    scan.stamp = now_;
    robot::set_geometry(scan, laser);
    scan.beam_period = 0.0;  // an instant
    std::vector<double> ranges(static_cast<std::size_t>(laser.beams), std::numeric_limits<double>::infinity());
    const TPoint2D eye = pose_.composePoint({model_.T_base_laser.x, model_.T_base_laser.y});
    for (const Segment& s : maze_.walls) {
      if (distance_to(s, eye) > laser.range_max) continue;
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        const double bearing = pose_.phi + scan.bearing(i);
        ranges[i] = std::min(ranges[i], cast(s, eye, std::cos(bearing), std::sin(bearing)));
      }
    }
    for (const double r : ranges)
      scan.ranges.push_back(r <= laser.range_max ? static_cast<float>(r) : std::numeric_limits<float>::infinity());
    return scan;
  }

  static double cast(const Segment& s, const TPoint2D& eye, double dx, double dy) {
    const double ex = s.b.x - s.a.x;
    const double ey = s.b.y - s.a.y;
    const double det = dx * ey - dy * ex;
    if (std::abs(det) < 1e-12) return std::numeric_limits<double>::infinity();
    const double ox = s.a.x - eye.x;
    const double oy = s.a.y - eye.y;
    const double range = (ox * ey - oy * ex) / det;
    const double along = (ox * dy - oy * dx) / det;
    return range >= 0.0 && along >= 0.0 && along <= 1.0 ? range : std::numeric_limits<double>::infinity();
  }

  Maze maze_;
  robot::RobotModel model_;
  TPose2D pose_;
  double v_ = 0.0;
  double w_ = 0.0;
  Stamp now_;
  int ticks_ = 0;
};

}  // namespace rubble::test
