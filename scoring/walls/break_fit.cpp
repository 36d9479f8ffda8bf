#include "scoring/walls/break_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/angle.h"
#include "base/planar.h"
#include "base/rigid.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr std::size_t kMaxPoints = 900;  // walls of the map that pull
constexpr double kSameWall = 1.5;        // [m]
constexpr double kTau = 0.2;             // k(d) that tells a seam from the next [m]
constexpr double kLeastPart = 0.15;      // of the walls
constexpr double kLeastGain = 0.02;      // of the walls that meet, over one pose for all
constexpr double kLeastApart = 0.08;     // [m]
constexpr double kLeastTurn = 0.014;     // [rad]
constexpr int kDirections = 12;
constexpr double kStep = 0.6;  // between seams of one direction [m]

/// Walls of the map, and the truth's, prepared for trying many seams.
class Parts {
 public:
  Parts(const OccupancyGrid& map, const OccupancyGrid& truth) : field_(truth, kSameWall) {
    const std::vector<TPoint2D> all = wall_points(map);
    const std::size_t step = std::max<std::size_t>(1, all.size() / kMaxPoints);
    for (std::size_t i = step / 2; i < all.size(); i += step) walls_.push_back(all[i]);
  }
  const std::vector<TPoint2D>& walls() const { return walls_; }

  /// How many walls of `part` meet the truth's, weighted by k(d).
  double met(const std::vector<TPoint2D>& part, const TPose2D& pose) const {
    const PlanarTransform T(pose);
    double sum = 0.0;
    for (const TPoint2D& p : part) sum += std::max(0.0, 1.0 - field_.distance(T(p)) / kTau);
    return sum;
  }

  /// Gauss-Newton on the truth's distance field, walls far off pulling less and less (Geman-McClure).
  TPose2D fitted(const std::vector<TPoint2D>& part, TPose2D pose) const {
    const TPoint2D middle = middle_of(part);
    for (const double sigma : {1.0, 0.5, 0.25, 0.1})
      for (int i = 0; i < 6; ++i) {
        const PlanarTransform T(pose);
        const TPoint2D centre = T(middle);
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        for (const TPoint2D& p : part) {
          const TPoint2D q = T(p);
          const WallField::Slope f = field_.slope(q);
          if (f.distance >= field_.cap()) continue;
          const double root = sigma * sigma / (sigma * sigma + f.distance * f.distance);
          const Eigen::Vector3d j(f.gx, f.gy, f.gy * (q.x - centre.x) - f.gx * (q.y - centre.y));
          a.noalias() += (root * root * j) * j.transpose();
          b -= root * root * f.distance * j;
        }
        a.diagonal().array() += 1.0;  // a ridge of one wall point where walls leave a direction free
        const Eigen::Vector3d step = a.ldlt().solve(b);
        if (!step.allFinite()) return pose;
        pose = turned_onto(middle, {centre.x + step.x(), centre.y + step.y()}, pose.phi + step.z());
        if (step.norm() < 1e-4) break;
      }
    return pose;
  }

 private:
  std::vector<TPoint2D> walls_;
  WallField field_;
};

struct Seam {
  double normal = 0.0;
  double offset = 0.0;  ///< of the seam along the normal from the map's origin [m]
  TPose2D T_first;
  TPose2D T_second;
  double met = -1.0;
};

double along(const TPoint2D& p, double normal) { return p.x * std::cos(normal) + p.y * std::sin(normal); }

/// Both parts fitted by themselves, from the pose of the whole and from each other's.
std::optional<Seam> tried(const Parts& parts, double normal, double offset, const TPose2D& start) {
  std::vector<TPoint2D> first;
  std::vector<TPoint2D> second;
  for (const TPoint2D& p : parts.walls()) (along(p, normal) < offset ? first : second).push_back(p);
  const auto least = kLeastPart * static_cast<double>(parts.walls().size());
  if (static_cast<double>(std::min(first.size(), second.size())) < std::max(10.0, least)) return std::nullopt;
  const auto best_of = [&](const std::vector<TPoint2D>& part, const TPose2D& a, const TPose2D& b) {
    return parts.met(part, a) >= parts.met(part, b) ? a : b;
  };
  Seam out{normal, offset, parts.fitted(first, start), parts.fitted(second, start), 0.0};
  out.T_second = best_of(second, out.T_second, parts.fitted(second, out.T_first));
  out.T_first = best_of(first, out.T_first, parts.fitted(first, out.T_second));
  out.met = parts.met(first, out.T_first) + parts.met(second, out.T_second);
  return out;
}

Seam best_seam(const Parts& parts, const TPose2D& start) {
  Seam best;
  const auto consider = [&](double normal, double offset) {
    const std::optional<Seam> seam = tried(parts, normal, offset, start);
    if (seam && seam->met > best.met) best = *seam;
  };
  for (int i = 0; i < kDirections; ++i) {
    const double normal = kPi * i / kDirections;
    double low = 1e9;
    double high = -1e9;
    for (const TPoint2D& p : parts.walls()) {
      low = std::min(low, along(p, normal));
      high = std::max(high, along(p, normal));
    }
    const double step = std::max(kStep, (high - low) / 24.0);
    for (double offset = low + step; offset < high; offset += step) consider(normal, offset);
  }
  if (best.met < 0.0) return best;
  for (const double share : {0.5, 0.25}) {
    const Seam at = best;
    for (const double turn : {-1.0, 0.0, 1.0})
      for (const double shift : {-1.0, 0.0, 1.0})
        consider(at.normal + turn * share * kPi / kDirections, at.offset + shift * share * kStep);
  }
  return best;
}

/// The known part of the seam. Parts that moved away from each other leave a crack of unknown cells along it, so cells
/// up to half a metre beside it count.
void find_ends(const OccupancyGrid& map, const Seam& seam, TPoint2D& from, TPoint2D& to) {
  constexpr double kBeside = 0.5;  // [m]
  const TPoint2D n(std::cos(seam.normal), std::sin(seam.normal));
  double low = 1e9;
  double high = -1e9;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] == Occupancy::Unknown) continue;
      const TPoint2D p = map.centre({x, y});
      if (std::abs(along(p, seam.normal) - seam.offset) > kBeside) continue;
      const double t = p.y * n.x - p.x * n.y;
      low = std::min(low, t);
      high = std::max(high, t);
    }
  if (low > high) low = high = 0.0;
  from = {seam.offset * n.x - low * n.y, seam.offset * n.y + low * n.x};
  to = {seam.offset * n.x - high * n.y, seam.offset * n.y + high * n.x};
}

bool is_in_second(const MapBreak& seam, const TPoint2D& p_map) {
  return along(p_map, seam.normal) >= along(seam.p_seam, seam.normal);
}

}  // namespace

MapBreak find_break(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map) {
  MapBreak out;
  const Parts parts(map, truth);
  if (parts.walls().size() < 40) return out;
  const TPose2D whole = parts.fitted(parts.walls(), T_truth_map);
  const Seam seam = best_seam(parts, T_truth_map);
  if (seam.met < 0.0) return out;
  const auto all = static_cast<double>(parts.walls().size());
  const double one_pose = std::max({parts.met(parts.walls(), whole), parts.met(parts.walls(), seam.T_first),
                                    parts.met(parts.walls(), seam.T_second), parts.met(parts.walls(), T_truth_map)});
  out.normal = seam.normal;
  out.T_truth_first = seam.T_first;
  out.T_truth_second = seam.T_second;
  TPoint2D from;
  TPoint2D to;
  find_ends(map, seam, from, to);
  out.p_seam = (from + to) * 0.5;
  out.turned_rad = wrap_angle(seam.T_second.phi - seam.T_first.phi);
  out.apart_m = (seam.T_second.composePoint(out.p_seam) - seam.T_first.composePoint(out.p_seam)).norm();
  std::size_t in_second = 0;
  for (const TPoint2D& p : parts.walls()) in_second += is_in_second(out, p) ? 1 : 0;
  const TPose2D& larger = 2 * in_second > parts.walls().size() ? seam.T_second : seam.T_first;
  out.from = larger.composePoint(from);
  out.to = larger.composePoint(to);
  out.found =
      seam.met - one_pose >= kLeastGain * all && (out.apart_m >= kLeastApart || std::abs(out.turned_rad) >= kLeastTurn);
  return out;
}

OccupancyGrid mended(const OccupancyGrid& map, const OccupancyGrid& truth, const MapBreak& seam) {
  OccupancyGrid first = map;
  OccupancyGrid second = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      (is_in_second(seam, map.centre({x, y})) ? first : second)[{x, y}] = Occupancy::Unknown;
  // Of the map's own fineness, so that its walls do not become fatter.
  GridFrame frame = common_frame(second, truth, seam.T_truth_second, 0.5);
  const GridFrame other = common_frame(first, truth, seam.T_truth_first, 0.5);
  const double x1 = std::max(frame.x0 + frame.width * frame.resolution, other.x0 + other.width * other.resolution);
  const double y1 = std::max(frame.y0 + frame.height * frame.resolution, other.y0 + other.height * other.resolution);
  frame.x0 = std::min(frame.x0, other.x0);
  frame.y0 = std::min(frame.y0, other.y0);
  frame.resolution = map.resolution();
  frame.width = static_cast<int>(std::ceil((x1 - frame.x0) / frame.resolution));
  frame.height = static_cast<int>(std::ceil((y1 - frame.y0) / frame.resolution));
  OccupancyGrid out = resample(first, seam.T_truth_first, frame);
  const OccupancyGrid more = resample(second, seam.T_truth_second, frame);
  for (std::size_t i = 0; i < out.cells().size(); ++i)
    if (more.cells()[i] == Occupancy::Occupied || out.cells()[i] == Occupancy::Unknown)
      out.cells()[i] = more.cells()[i];
  return crop_to_known(out, 0.0);
}

}  // namespace rubble::scoring
