#include "scoring/alignment/feature_score.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <iterator>
#include <utility>

#include "base/angle.h"
#include "base/rigid.h"
#include "scoring/proposals/correlation.h"
#include "scoring/rooms/room_floor.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_contours.h"
#include "scoring/walls/wall_match.h"
#include "scoring/walls/warp_fit.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr std::size_t kStrangers = 4;     // poses of the mirror image
constexpr std::size_t kLeastPoints = 12;  // features of the truth below which a kind says nothing
constexpr std::size_t kLeastRooms = 2;
constexpr double kRedrawnTurn = deg_to_rad(17.0);  // like no angle that walls have to each other
constexpr double kRedrawnMargin = 1.0;             // [m]
constexpr double kLeastSpan = 0.1;                 // of C: a kind that tells less apart says nothing

constexpr EvidenceKind kKinds[] = {EvidenceKind::Surf, EvidenceKind::Corners, EvidenceKind::Rooms};

/// c_ij of eq. (7) less the squared distance, lambda d(f_i, g_j) [m^2]. SURF: lambda = 0.5 m^2, d the distance of the
/// descriptors. Corners: 0.3 m^2 a radian between their directions, 0.2 between their turns. Rooms: 1 m^2.
std::function<double(std::size_t, std::size_t)> difference_of(const MapFeatures& map, const MapFeatures& truth,
                                                              EvidenceKind kind, double turned) {
  switch (kind) {
    case EvidenceKind::Surf:
      return [&](std::size_t i, std::size_t j) { return 0.5 * descriptor_distance(map.surf, i, truth.surf, j); };
    case EvidenceKind::Corners:
      return [&, turned](std::size_t i, std::size_t j) {
        const CornerFeature& a = map.corners[i];
        const CornerFeature& b = truth.corners[j];
        return 0.3 * std::abs(wrap_angle(a.into + turned - b.into)) + 0.2 * std::abs(a.turn - b.turn);
      };
    case EvidenceKind::Rooms:
      break;
  }
  return [&](std::size_t i, std::size_t j) { return room_difference(map.rooms[i], truth.rooms[j]); };
}

std::vector<CornerFeature> corners_of(const GridFrame& frame, const RoomFloor& floor, const RoomConfig& config) {
  const int scale = std::max(2, static_cast<int>(std::lround(config.turn_scale / floor.resolution)));
  const std::vector<WallContour> contours = wall_contours(floor.cleared);
  std::vector<CornerFeature> out;
  for (const WallCorner& corner : wall_corners(contours, scale, config.least_turn)) {
    const WallContour& contour = contours[corner.contour];
    const std::size_t n = contour.size();
    const cv::Point back = contour[(corner.index + n - static_cast<std::size_t>(scale)) % n] - corner.at;
    const cv::Point on = contour[(corner.index + static_cast<std::size_t>(scale)) % n] - corner.at;
    // Both legs run along the wall's faces: the wall lies between them.
    const cv::Point2d middle =
        cv::Point2d(back) / std::max(1e-9, cv::norm(back)) + cv::Point2d(on) / std::max(1e-9, cv::norm(on));
    CornerFeature feature;
    feature.p = {frame.x0 + (corner.at.x + 0.5) * floor.resolution, frame.y0 + (corner.at.y + 0.5) * floor.resolution};
    feature.into = std::atan2(middle.y, middle.x);
    const double between = std::abs(wrap_angle(std::atan2(static_cast<double>(back.y), static_cast<double>(back.x)) -
                                               std::atan2(static_cast<double>(on.y), static_cast<double>(on.x))));
    feature.turn = kPi - between;
    out.push_back(feature);
  }
  return out;
}

/// Poses at which the walls of a map that is none of the truth's meet them best.
std::vector<TPose2D> poses_of_stranger(const OccupancyGrid& stranger, const OccupancyGrid& truth) {
  const WallMatch match(stranger, truth, 2.0, 800);
  std::vector<TPose2D> out;
  if (!match.usable()) return out;
  for (const PoseGuess& guess : correlate(stranger, truth)) {
    out.push_back(match.refine(match.refine(guess.T_truth_map, 1.0, 10), 0.3, 10));
    if (out.size() == kStrangers) break;
  }
  return out;
}

/// Of mirror_image(map): corners and rooms are those of the map seen in a mirror, SURF descriptors are not.
MapFeatures features_of_image(const OccupancyGrid& image, const MapFeatures& of_map) {
  const GridFrame& f = image.frame();
  const auto flip = [&](TPoint2D& p) { p.x = 2.0 * f.x0 + f.width * f.resolution - p.x; };
  MapFeatures out = of_map;
  out.surf = find_features(image, FeatureKind::Surf);
  for (CornerFeature& corner : out.corners) {
    flip(corner.p);
    corner.into = wrap_angle(kPi - corner.into);
  }
  for (Room& room : out.rooms) {
    flip(room.centre);
    flip(room.box_min);
    flip(room.box_max);
    std::swap(room.box_min.x, room.box_max.x);
    room.direction = -room.direction;
  }
  return out;
}

/// E of each kind between the truth and itself, drawn on another raster.
std::vector<double> errors_of_redrawn(const OccupancyGrid& truth, const MapFeatures& of_truth) {
  const TPose2D turn(0.0, 0.0, kRedrawnTurn);
  const MapFeatures anew = features_of(resample(truth, turn, common_frame(truth, truth, turn, kRedrawnMargin)));
  std::vector<double> out;
  for (const EvidenceKind kind : kKinds)
    out.push_back(feature_error(anew, of_truth, kind, TPose2D(0.0, 0.0, 0.0) - turn).error);
  return out;
}

/// Corners, which a damaged map still has, tell how far it is off (Spearman with the trajectory error 0.85 by
/// themselves); SURF descriptors (0.56) and rooms (0.15), of which a gap in a wall makes one, tell strangers.
double weight_of(EvidenceKind kind) { return kind == EvidenceKind::Corners ? 0.8 : 0.1; }

/// Enough in the truth; a map that lacks them all is wrong about them.
bool says_something(const MapFeatures& truth, EvidenceKind kind) {
  return truth.places(kind).size() >= (kind == EvidenceKind::Rooms ? kLeastRooms : kLeastPoints);
}

/// Features of both kinds that are points: their partners at a pose behind a displacement, and E.
struct Pairing {
  std::vector<TPoint2D> from;  ///< of the map, before the displacement
  std::vector<TPoint2D> to;
  double error = 0.0;  ///< mean over both kinds of E / C
};

template <class Displace>
Pairing associated(const MapFeatures& map, const MapFeatures& truth, const Displace& displaced, const TPose2D& pose) {
  Pairing out;
  for (const EvidenceKind kind : {EvidenceKind::Surf, EvidenceKind::Corners}) {
    const std::vector<TPoint2D> of_map = map.places(kind);
    const std::vector<TPoint2D> of_truth = truth.places(kind);
    std::vector<TPoint2D> moved;
    for (const TPoint2D& p : of_map) moved.push_back(displaced(p));
    const MatchError match =
        match_error(moved, of_truth, pose, difference_of(map, truth, kind, pose.phi), feature_cap(kind));
    out.error += 0.5 * match.error / feature_cap(kind);
    for (const auto& [i, j] : match.pairs) {
      out.from.push_back(of_map[i]);
      out.to.push_back(of_truth[j]);
    }
  }
  return out;
}

/// Section IV.F: given W, the coefficients b solve a linear set of equations; the pose is that of the remaining rigid
/// part. Ridge as in fit_warp(): it grows with the degree.
void solve_for_b(Warp& warp, const Pairing& found, double stiffer) {
  constexpr double kStiffness = 0.0005;
  using Matrix = Eigen::Matrix<double, Warp::kMaxTerms, Warp::kMaxTerms>;
  using Vector = Eigen::Matrix<double, Warp::kMaxTerms, 1>;
  const auto n = static_cast<double>(found.from.size());
  std::vector<TPoint2D> bent;
  for (const TPoint2D& p : found.from) bent.push_back(p + warp.displacement(p));
  warp.T_truth_map = PlanarTransform(fit_rigid(bent, found.to));
  Matrix a = Matrix::Zero();
  Vector bx = Vector::Zero();
  Vector by = Vector::Zero();
  for (std::size_t i = 0; i < found.from.size(); ++i) {
    const Warp::Terms terms = warp.terms_at(found.from[i]);
    const Vector phi = Eigen::Map<const Vector>(terms.data());
    const TPoint2D wanted = warp.T_truth_map.inverse(found.to[i]) - found.from[i];
    a.noalias() += phi * phi.transpose();
    bx += wanted.x * phi;
    by += wanted.y * phi;
  }
  for (int i = 0; i < Warp::kMaxTerms; ++i)
    a(i, i) += n * stiffer * kStiffness * static_cast<double>(1 << (Warp::degree_of(i) - 1));
  const Eigen::LDLT<Matrix> solver(a);
  const Vector dx = solver.solve(bx);
  const Vector dy = solver.solve(by);
  for (std::size_t i = 0; i < Warp::kMaxTerms; ++i) {
    warp.dx[i] = dx(static_cast<Eigen::Index>(i));
    warp.dy[i] = dy(static_cast<Eigen::Index>(i));
  }
}

/// RMS displacement of the map's features that no rigid transform explains.
double bend_over(const Warp& warp, const MapFeatures& map) {
  std::vector<TPoint2D> from = map.places(EvidenceKind::Surf);
  const std::vector<TPoint2D> corners = map.places(EvidenceKind::Corners);
  from.insert(from.end(), corners.begin(), corners.end());
  if (from.empty()) return 0.0;
  std::vector<TPoint2D> to;
  for (const TPoint2D& p : from) to.push_back(warp(p));
  const PlanarTransform T(fit_rigid(from, to));
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - T(from[i])).sqrNorm();
  return std::sqrt(sum / static_cast<double>(from.size()));
}

}  // namespace

const char* name_of(EvidenceKind kind) {
  switch (kind) {
    case EvidenceKind::Surf:
      return "SURF";
    case EvidenceKind::Corners:
      return "corners";
    case EvidenceKind::Rooms:
      return "rooms";
  }
  return "";
}

std::vector<TPoint2D> MapFeatures::places(EvidenceKind kind) const {
  std::vector<TPoint2D> out;
  if (kind == EvidenceKind::Surf)
    for (const Feature& f : surf.features) out.push_back(f.p);
  else if (kind == EvidenceKind::Corners)
    for (const CornerFeature& f : corners) out.push_back(f.p);
  else
    for (const Room& f : rooms) out.push_back(f.centre);
  return out;
}

MapFeatures features_of(const OccupancyGrid& map) {
  MapFeatures out;
  out.surf = find_features(map, FeatureKind::Surf);
  if (map.cells().empty()) return out;
  const RoomConfig config;
  const RoomFloor floor = room_floor(map, config);
  out.corners = corners_of(map.frame(), floor, config);
  out.rooms = extract_rooms(map, floor, config).rooms;
  return out;
}

double feature_cap(EvidenceKind kind) { return kind == EvidenceKind::Rooms ? 2.0 : 1.0; }

MatchError feature_error(const MapFeatures& map, const MapFeatures& truth, EvidenceKind kind,
                         const TPose2D& T_truth_map) {
  return match_error(map.places(kind), truth.places(kind), T_truth_map,
                     difference_of(map, truth, kind, T_truth_map.phi), feature_cap(kind));
}

TruthFeatures truth_features(const OccupancyGrid& truth) {
  TruthFeatures out{features_of(truth), {}};
  out.redrawn = errors_of_redrawn(truth, out.features);
  return out;
}

FeatureVerdict judge_features(const OccupancyGrid& map, const MapFeatures& of_map, const OccupancyGrid& truth,
                              const TruthFeatures& truth_once, const TPose2D& T_truth_map) {
  FeatureVerdict out;
  const MapFeatures& of_truth = truth_once.features;
  const OccupancyGrid image = mirror_image(map);
  auto wrong_poses = std::async([&] { return poses_of_stranger(image, truth); });  // beside the features
  const MapFeatures of_image = features_of_image(image, of_map);
  const std::vector<TPose2D> wrong = wrong_poses.get();
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    const EvidenceKind kind = kKinds[k];
    KindScore score;
    score.kind = kind;
    score.map = of_map.places(kind);
    score.truth = of_truth.places(kind);
    score.match = feature_error(of_map, of_truth, kind, T_truth_map);
    for (const TPose2D& T : wrong) score.stranger += feature_error(of_image, of_truth, kind, T).error;
    score.stranger = wrong.empty() ? feature_cap(kind) : score.stranger / static_cast<double>(wrong.size());
    score.redrawn = truth_once.redrawn[k];
    const double span = score.stranger - score.redrawn;
    score.usable = says_something(of_truth, kind) && span >= kLeastSpan * feature_cap(kind);
    if (score.usable) {
      score.score = std::clamp((score.stranger - score.match.error) / span, 0.0, 1.0);
      const double weight = weight_of(kind);
      sum += weight * score.score;
      weights += weight;
    }
    out.kinds.push_back(score);
  }
  out.score = weights > 0.0 ? sum / weights : 0.0;
  return out;
}

FeaturePose minimise_feature_error(const MapFeatures& map, const MapFeatures& truth, const TPose2D& start) {
  constexpr int kRounds = 8;
  FeaturePose best{start, 2.0};
  TPose2D pose = start;
  for (int round = 0; round < kRounds; ++round) {
    const Pairing found = associated(
        map, truth, [](const TPoint2D& p) { return p; }, pose);
    if (found.error >= best.error - 1e-6) break;
    best = {pose, found.error};
    if (found.from.size() < 3) break;
    pose = fit_rigid(found.from, found.to);  // section IV.F, step 2
  }
  return best;
}

FeatureWarp fit_feature_warp(const MapFeatures& map, const MapFeatures& truth, const TPose2D& T_truth_map,
                             const GridFrame& frame) {
  constexpr int kRounds = 5;
  FeatureWarp best;
  for (const double stiffer : {1.0, 10.0, 100.0}) {
    Warp warp;
    warp.T_truth_map = PlanarTransform(T_truth_map);
    warp.terms = Warp::terms_of(3);
    warp.centre = {frame.x0 + 0.5 * frame.width * frame.resolution, frame.y0 + 0.5 * frame.height * frame.resolution};
    warp.extent = std::max(1.0, 0.5 * std::max(frame.width, frame.height) * frame.resolution);
    const auto bent = [&](const TPoint2D& p) { return p + warp.displacement(p); };
    Pairing found;
    for (int round = 0; round <= kRounds; ++round) {
      found = associated(map, truth, bent, warp.T_truth_map.pose());
      if (found.from.size() < 12 || round == kRounds) break;
      solve_for_b(warp, found, stiffer);
    }
    best.warp = warp;
    best.error = found.error;
    best.matched = found.from.size();
    if (keeps_order(warp, frame)) break;
  }
  best.size = bend_over(best.warp, map);
  return best;
}

}  // namespace rubble::scoring
