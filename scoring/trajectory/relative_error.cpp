#include "scoring/trajectory/relative_error.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "base/text/words.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPose2D;

constexpr double kFalseFrom = 0.3;      ///< [m]
constexpr double kFalseTurnFrom = 0.2;  ///< [rad]

double length_of(const TPose2D& pose) { return std::hypot(pose.x, pose.y); }

/// b seen from a.
TPose2D between(const TPose2D& a, const TPose2D& b) { return b - a; }

RelativeError rmse(const std::vector<PosePair>& poses, const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  RelativeError out;
  out.pairs = pairs.size();
  if (pairs.empty()) return out;
  double metres = 0.0;
  double radians = 0.0;
  for (const auto& [i, j] : pairs) {
    const TPose2D error =
        between(between(poses[i].truth, poses[j].truth), between(poses[i].estimate, poses[j].estimate));
    metres += error.x * error.x + error.y * error.y;
    radians += wrap_angle(error.phi) * wrap_angle(error.phi);
  }
  const double n = static_cast<double>(pairs.size());
  out.rmse_m = std::sqrt(metres / n);
  out.rmse_rad = std::sqrt(radians / n);
  return out;
}

/// Indices at which the path since the last of them, at first since the start, reaches `length`.
template <class Poses, class PoseOf>
std::vector<std::size_t> milestones(const Poses& poses, double length, const PoseOf& pose_of) {
  std::vector<std::size_t> out;
  double path = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) path += length_of(between(pose_of(poses[i - 1]), pose_of(poses[i])));
    if (path < length) continue;
    out.push_back(i);
    path = 0.0;
  }
  return out;
}

/// Poses in the order of their time, in boxes of twice as many from level to level: a robot moves on, so what follows
/// in time lies together, and a search of the earliest one near a place leaves out nearly all.
class PlacesInTime {
 public:
  explicit PlacesInTime(std::vector<TPose2D> poses) : poses_(std::move(poses)) {
    while (leaves_ < poses_.size()) leaves_ *= 2;
    boxes_.resize(2 * leaves_);
    for (std::size_t i = 0; i < poses_.size(); ++i)
      boxes_[leaves_ + i] = {poses_[i].x, poses_[i].x, poses_[i].y, poses_[i].y};
    for (std::size_t node = leaves_; node-- > 1;) boxes_[node] = around(boxes_[2 * node], boxes_[2 * node + 1]);
  }

  /// Index of the earliest pose before `end` within `near` [m] of `place`.
  std::optional<std::size_t> earliest(const TPose2D& place, double near, std::size_t end) const {
    return earliest(1, 0, leaves_, place, near, end);
  }

 private:
  struct Box {
    double x_min = std::numeric_limits<double>::infinity();
    double x_max = -std::numeric_limits<double>::infinity();
    double y_min = std::numeric_limits<double>::infinity();
    double y_max = -std::numeric_limits<double>::infinity();
  };

  static Box around(const Box& a, const Box& b) {
    return {std::min(a.x_min, b.x_min), std::max(a.x_max, b.x_max), std::min(a.y_min, b.y_min),
            std::max(a.y_max, b.y_max)};
  }

  /// Never true of a box that holds a pose within `near`, however the last bits are rounded.
  static bool is_far(const Box& box, const TPose2D& place, double near) {
    constexpr double kRounding = 1.0 + 1e-9;
    const double x = std::max({0.0, box.x_min - place.x, place.x - box.x_max});
    const double y = std::max({0.0, box.y_min - place.y, place.y - box.y_max});
    return std::hypot(x, y) > near * kRounding;
  }

  /// Node over the `size` poses from `first` on.
  std::optional<std::size_t> earliest(std::size_t node, std::size_t first, std::size_t size, const TPose2D& place,
                                      double near, std::size_t end) const {
    if (first >= std::min(end, poses_.size()) || is_far(boxes_[node], place, near)) return std::nullopt;
    if (size == 1) {
      if (length_of(between(poses_[first], place)) > near) return std::nullopt;
      return first;
    }
    const std::size_t half = size / 2;
    if (const auto found = earliest(2 * node, first, half, place, near, end)) return found;
    return earliest(2 * node + 1, first + half, half, place, near, end);
  }

  std::vector<TPose2D> poses_;
  std::size_t leaves_ = 1;  ///< a power of two; leaf i is box leaves_ + i
  std::vector<Box> boxes_;  ///< node n is around nodes 2 n and 2 n + 1, from 1 on
};

/// Mean, standard deviation and mean square of positive numbers.
struct Moments {
  double sum = 0.0;
  double squares = 0.0;
  void add(double value) {
    sum += value;
    squares += value * value;
  }
  void store(double n, double& mean, double& deviation, double& mean_square) const {
    mean = sum / n;
    mean_square = squares / n;
    deviation = std::sqrt(std::max(0.0, mean_square - mean * mean));
  }
};

/// How far the trajectory is from a relation; nothing where one of its stamps lies outside.
std::optional<TPose2D> difference(const Trajectory& trajectory, const Relation& relation) {
  const auto from = pose_at(trajectory, relation.from);
  const auto to = pose_at(trajectory, relation.to);
  if (!from || !to) return std::nullopt;
  return between(relation.delta, between(*from, *to));
}

}  // namespace

RelativeError rpe_frames(const Trajectory& estimate, const Trajectory& truth) {
  const std::vector<PosePair> poses = associate(estimate, truth);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 1; i < poses.size(); ++i) pairs.emplace_back(i - 1, i);
  return rmse(poses, pairs);
}

RelativeError rpe_path(const Trajectory& estimate, const Trajectory& truth, double length) {
  const std::vector<PosePair> poses = associate(estimate, truth);
  const std::vector<std::size_t> taken = milestones(poses, length, [](const PosePair& p) { return p.estimate; });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 1; i < taken.size(); ++i) pairs.emplace_back(taken[i - 1], taken[i]);
  return rmse(poses, pairs);
}

RelationError relation_error(const Trajectory& estimate, const std::vector<Relation>& relations) {
  RelationError out;
  Moments metres;
  Moments radians;
  for (const Relation& relation : relations) {
    const std::optional<TPose2D> error = difference(estimate, relation);
    if (!error) {
      ++out.missing;
      continue;
    }
    ++out.relations;
    metres.add(length_of(*error));
    radians.add(std::abs(wrap_angle(error->phi)));
  }
  if (out.relations == 0) return out;
  const double n = static_cast<double>(out.relations);
  metres.store(n, out.mean_m, out.std_m, out.mean_m2);
  radians.store(n, out.mean_rad, out.std_rad, out.mean_rad2);
  return out;
}

RelationsAtScans relations_at_scans(const Trajectory& scans, const std::vector<Relation>& relations) {
  constexpr double kSame = 1e-3;  // [s]
  RelationsAtScans out;
  if (scans.empty()) return out;
  const auto is_inside = [&](Stamp stamp) { return stamp >= scans.front().stamp && stamp <= scans.back().stamp; };
  const auto is_scan = [&](Stamp stamp) {
    const auto after = std::lower_bound(scans.begin(), scans.end(), stamp,
                                        [](const StampedPose& scan, Stamp s) { return scan.stamp < s; });
    return (after != scans.end() && after->stamp - stamp <= kSame) ||
           (after != scans.begin() && stamp - std::prev(after)->stamp <= kSame);
  };
  for (const Relation& relation : relations) {
    if (!is_inside(relation.from) || !is_inside(relation.to)) continue;
    ++out.relations;
    if (!is_scan(relation.from) || !is_scan(relation.to)) ++out.between;
  }
  return out;
}

std::optional<std::string> between_scans(const Trajectory& scans, const std::vector<Relation>& relations,
                                         const std::string& path, const std::string& log) {
  const RelationsAtScans at_scans = relations_at_scans(scans, relations);
  if (!at_scans.doubtful()) return std::nullopt;
  return path + ": of " + std::to_string(at_scans.relations) + " relations " + std::to_string(at_scans.between) +
         " name a moment at which " + log +
         " has no scan (within 1 ms), and are judged by poses in between; are both of one log, by one clock?";
}

std::size_t false_relations(const std::vector<Relation>& claimed, const Trajectory& truth) {
  return static_cast<std::size_t>(std::count_if(claimed.begin(), claimed.end(), [&](const Relation& relation) {
    const std::optional<TPose2D> error = difference(truth, relation);
    return error && (length_of(*error) > kFalseFrom || std::abs(wrap_angle(error->phi)) > kFalseTurnFrom);
  }));
}

std::vector<Relation> relations_of(const Trajectory& truth, double length, double near, double loop) {
  const std::vector<std::size_t> taken = milestones(truth, length, [](const StampedPose& p) { return p.pose; });
  const auto back = static_cast<std::size_t>(std::ceil(loop / length));
  const auto relation = [&](std::size_t i, std::size_t j) {
    return Relation{truth[i].stamp, truth[j].stamp, between(truth[i].pose, truth[j].pose)};
  };
  std::vector<TPose2D> places;
  places.reserve(taken.size());
  for (const std::size_t i : taken) places.push_back(truth[i].pose);
  const PlacesInTime earlier(std::move(places));
  std::vector<Relation> out;
  for (std::size_t k = 1; k < taken.size(); ++k) {
    out.push_back(relation(taken[k - 1], taken[k]));
    if (k < back) continue;
    if (const auto m = earlier.earliest(truth[taken[k]].pose, near, k - back + 1))
      out.push_back(relation(taken[*m], taken[k]));
  }
  return out;
}

std::vector<Relation> read_relations(const std::string& path) {
  constexpr std::size_t kFields = 8;
  const auto fail = [&](int line, const std::string& trouble, bool is_first) {
    throw InputError(at(path, line, 1,
                        (is_first ? "is no file of relations: " : "") + trouble +
                            "; a line of them is 'stamp stamp x y z roll pitch yaw', in s, m and rad"));
  };
  std::vector<Relation> out;
  std::stringstream lines(read_text_file(path));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::stringstream fields(line.substr(0, line.find('#')));
    std::vector<double> values;
    for (std::string field; fields >> field;) {
      const auto value = parse_number(field);
      if (!value) fail(number, in_quotes(field) + " is no number", out.empty());
      values.push_back(*value);
    }
    if (values.empty()) continue;
    if (values.size() != kFields)
      fail(number, "8 numbers are needed, and here are " + std::to_string(values.size()), out.empty());
    out.push_back(
        {Stamp::from_seconds(values[0]), Stamp::from_seconds(values[1]), TPose2D(values[2], values[3], values[7])});
  }
  if (out.empty()) throw InputError(path + ": holds no relations");
  return out;
}

}  // namespace rubble::scoring
