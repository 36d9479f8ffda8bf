#include "sim/laser/sweep_cast.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angle.h"
#include "sim/laser/simd.h"

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr float kFaceSeam = 2e-5f;  ///< faces reach so far beyond their edges: no light through seams [m]
constexpr double kStopped = 1e-3;   ///< beams that end so much before a face never reach it, rounding included [m]
constexpr double kBeside = 0.05;    ///< what is nearer may be at any bearing [m]
constexpr std::size_t kFew = 12;    ///< groups of beams that cost less than to see which of them a face really needs
constexpr std::size_t kCorners = ScanFaces::kCorners;
constexpr std::size_t kMostPoints = 2 * kCorners;  ///< of a polygon cut by a slab

/// A linear function of position for four rays at once: value(o + t d) = at_origin + t * along.
struct Plane4 {
  Float4 x, y, z, c;
  Plane4() = default;
  Plane4(const Vector3d& normal, double offset)
      : x(splat(normal.x())), y(splat(normal.y())), z(splat(normal.z())), c(splat(offset)) {}
};

/// An angle in [-2 pi, 2 pi] the short way round.
float half_turn(float a) {
  constexpr float kHalf = static_cast<float>(kPi);
  return a > kHalf ? a - 2.0f * kHalf : (a < -kHalf ? a + 2.0f * kHalf : a);
}

/// Points in a scan's plane, padded so that a group of four and its successors can be loaded.
struct Points {
  float x[kMostPoints + 4], y[kMostPoints + 4];
  std::size_t count = 0;
  void add(float px, float py) {
    x[count] = px;
    y[count] = py;
    ++count;
  }
  /// Repeats the first point at the end.
  void close() {
    for (std::size_t i = count; i < kMostPoints + 4; ++i) {
      x[i] = x[0];
      y[i] = y[0];
    }
  }
};

/// The part of the polygon between the planes z = -slack and z = slack, corner by corner.
Points between(const ScanFaces::Corners& corners, float slack) {
  float x[4], y[4], z[4];
  store4(x, corners.x);
  store4(y, corners.y);
  store4(z, corners.z);
  Points points;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const std::size_t k = (i + 1) % kCorners;
    const float rise = z[k] - z[i];
    float from = 0.0f;
    float to = 1.0f;
    if (z[i] > slack) from = z[k] > slack ? 2.0f : (slack - z[i]) / rise;
    if (z[i] < -slack) from = z[k] < -slack ? 2.0f : (-slack - z[i]) / rise;
    if (from > 1.0f) continue;
    if (z[k] > slack) to = (slack - z[i]) / rise;
    if (z[k] < -slack) to = (-slack - z[i]) / rise;
    points.add(x[i] + from * (x[k] - x[i]), y[i] + from * (y[k] - y[i]));
    if (to < 1.0f || from > 0.0f) points.add(x[i] + to * (x[k] - x[i]), y[i] + to * (y[k] - y[i]));
  }
  points.close();
  return points;
}

/// Distance from the origin to the nearest side of the closed line, squared.
float nearest_side(const Points& points) {
  Float4 nearest = splat(1e18f);
  for (std::size_t i = 0; i < points.count; i += 4) {
    const Float4 x = load4(&points.x[i]), y = load4(&points.y[i]);
    const Float4 dx = load4(&points.x[i + 1]) - x, dy = load4(&points.y[i + 1]) - y;
    const Float4 along = (splat(0.0f) - (x * dx + y * dy)) / max4(dx * dx + dy * dy, splat(1e-12f));
    const Float4 u = min4(max4(along, splat(0.0f)), splat(1.0f));
    const Float4 px = x + u * dx, py = y + u * dy;
    nearest = min4(px * px + py * py, nearest);
  }
  return std::min(std::min(nearest[0], nearest[1]), std::min(nearest[2], nearest[3]));
}

}  // namespace

/// Bearings low .. high with a margin on both sides as groups of beams; what lies beyond pi behind comes round.
SweepCast::Spans SweepCast::spans(double low, double high, double margin, const BeamTable& table) const {
  Spans found;
  const std::size_t groups = table.cosine.size() / 4;
  low -= margin;
  high += margin;
  if (high - low >= 2.0 * kPi) {
    found.span[found.count++] = {0, groups};
    return found;
  }
  const double most = static_cast<double>(table.count);
  // A bearing is one of three turns; each shift that reaches the scanner's sector gives a part.
  for (const double shift : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
    const double first = (low + shift - table.angle_min) * table.beams_per_radian - 1.0;
    const double last = (high + shift - table.angle_min) * table.beams_per_radian + 1.0;
    if (last < 0.0 || first >= most) continue;
    const std::size_t begin = static_cast<std::size_t>(std::max(0.0, first)) / 4;
    const std::size_t end = static_cast<std::size_t>(std::min(last, most - 1.0)) / 4 + 1;
    found.span[found.count++] = {begin, end};
  }
  return found;
}

/// Whether all four beams of a group meet something nearer than `nearest`.
bool SweepCast::is_stopped(std::size_t group, const Float4& nearest) const {
  return bits4(load4(&best_[4 * group]) < nearest) == 15;
}

/// Takes beams that are stopped before `nearest` off both ends of the spans.
void SweepCast::trim(Spans& spans, const Float4& nearest) const {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < spans.count; ++k) {
    Span span = spans.span[k];
    while (span.begin < span.end && is_stopped(span.begin, nearest)) ++span.begin;
    while (span.begin < span.end && is_stopped(span.end - 1, nearest)) --span.end;
    if (span.begin < span.end) spans.span[kept++] = span;
  }
  spans.count = kept;
}

SweepCast::Bearings SweepCast::bearings(const ScanFaces::Corners& corners, double slack) const {
  const Points points = between(corners, static_cast<float>(slack));
  Bearings b;
  if (points.count == 0) return b;
  float angle[kMostPoints];
  for (std::size_t i = 0; i < points.count; i += 4) {
    store4(&angle[i], rough_atan2(load4(&points.y[i]), load4(&points.x[i])));
  }
  float bearing = angle[0];
  float low = bearing;
  float high = bearing;
  for (std::size_t i = 1; i < points.count; ++i) {
    bearing += half_turn(half_turn(angle[i] - bearing));
    low = std::min(low, bearing);
    high = std::max(high, bearing);
  }
  b.low = low;
  b.high = high;
  b.around = std::abs(bearing + half_turn(half_turn(angle[0] - bearing)) - angle[0]) > 1.0f;
  b.nearest = b.around ? 0.0 : std::sqrt(static_cast<double>(nearest_side(points)));
  return b;
}

/// How far the bearing of a point at least `nearest` away can differ between its beam's pose and the middle one.
double SweepCast::sway(const Beams& beams, double nearest) const {
  return beams.turn + beams.tilt * (beams.tilt + slack_ / nearest) + beams.travel / nearest + 2.0 * kRoughAtan2Error;
}

/// Beams that may meet the whole face, not only what of it the scan plane sweeps: quick to find, seldom many more.
/// Seen from outside, a convex outline spans less than half a turn.
SweepCast::Spans SweepCast::rough_spans(const ScanFaces::Corners& corners, double nearest, const Beams& beams,
                                        const BeamTable& table) const {
  const Float4 angle = rough_atan2(corners.y, corners.x);
  double low = 0.0;
  double high = 0.0;
  for (int i = 1; i < 4; ++i) {
    const double turn = static_cast<double>(half_turn(angle[i] - angle[0]));
    low = std::min(low, turn);
    high = std::max(high, turn);
  }
  const bool outside = nearest > kBeside && high - low < kPi - 0.01;
  const double first = static_cast<double>(angle[0]);
  return outside ? spans(first + low, first + high, sway(beams, nearest), table) : spans(0.0, 0.0, kPi, table);
}

void SweepCast::meet(const NearFace& face, const ScanFaces::Polygon& polygon, const ScanFaces::Corners& corners,
                     const Beams& beams, const BeamTable& table, double max_range) {
  // Height over the scan plane at mid sweep; a face all above or all below what that plane sweeps is never met.
  const int above = bits4(corners.z > splat(slack_));
  const int below = bits4(corners.z < splat(-slack_));
  if (above == 15 || below == 15) return;
  // In the scan plane a face is nearer than in space, by its height over the plane at most.
  const double closest = static_cast<double>(face.nearest) - slack_ - kStopped;
  Float4 nearest = splat(closest - beams.travel);
  Spans spans = rough_spans(corners, closest, beams, table);
  trim(spans, nearest);
  if (spans.groups() > kFew) {
    const Bearings b = bearings(corners, slack_);
    if (b.nearest > max_range + beams.travel) return;
    const double margin = b.around || b.nearest < kBeside ? kPi : sway(beams, b.nearest);
    spans = this->spans(b.low, b.high, margin, table);
    nearest = splat(b.nearest - beams.travel - kStopped);
    trim(spans, nearest);
  }
  if (spans.count == 0) return;

  // Only edges that cross the scan plane bound what the beams meet.
  const Plane4 plane(polygon.normal, polygon.offset - polygon.normal.dot(beams.middle.p));
  Plane4 edges[kCorners];
  std::size_t edge_count = 0;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const int ends = 1 << i | 1 << (i + 1) % kCorners;
    if ((above & ends) == ends || (below & ends) == ends) continue;
    const ScanFaces::Edge& edge = polygon.edges[i];
    edges[edge_count++] = Plane4(edge.inward, edge.offset - edge.inward.dot(beams.middle.p) - double{kFaceSeam});
  }
  const Float4 zero = splat(0.0f);
  for (std::size_t k = 0; k < spans.count; ++k) {
    for (std::size_t group = spans.span[k].begin; group < spans.span[k].end; ++group) {
      if (is_stopped(group, nearest)) continue;
      const std::size_t i = 4 * group;
      const Float4 ox = load4(&beams.ox[i]), oy = load4(&beams.oy[i]), oz = load4(&beams.oz[i]);
      const Float4 dx = load4(&beams.dx[i]), dy = load4(&beams.dy[i]), dz = load4(&beams.dz[i]);
      const Float4 gap = plane.c - (plane.x * ox + plane.y * oy + plane.z * oz);
      const Float4 closing = plane.x * dx + plane.y * dy + plane.z * dz;
      const Float4 t = gap / closing;
      const Float4 best = load4(&best_[i]);
      Int4 hit = (closing < zero) & (t > zero) & (t < best);
      if (!any4(hit)) continue;
      const Float4 px = ox + t * dx, py = oy + t * dy, pz = oz + t * dz;
      for (std::size_t e = 0; e < edge_count; ++e) {
        hit &= edges[e].x * px + edges[e].y * py + edges[e].z * pz >= edges[e].c;
      }
      store4(&best_[i], hit ? t : best);
    }
  }
}

void SweepCast::meet(const Sphere& sphere, const Beams& beams, const BeamTable& table, double max_range) {
  const Vector3d centre = Vector3d(sphere.x, sphere.y, sphere.z) - beams.middle.p;
  const double distance2 = centre.squaredNorm();
  const double limit = max_range + sphere.radius + beams.travel;
  if (distance2 > limit * limit) return;
  const double height = beams.middle.R.col(2).dot(centre);
  if (std::abs(height) > sphere.radius + slack_) return;
  const double flat = std::sqrt(std::max(0.0, distance2 - height * height));
  const double clear = flat - sphere.radius - beams.travel;
  double bearing = 0.0;
  double margin = kPi;
  if (clear > 0.05) {
    bearing = static_cast<double>(
        rough_atan2(splat(beams.middle.R.col(1).dot(centre)), splat(beams.middle.R.col(0).dot(centre)))[0]);
    margin = std::asin(sphere.radius / flat) + beams.turn +
             beams.tilt * (beams.tilt + (std::abs(height) + sphere.radius) / clear) + beams.travel / clear +
             2.0 * kRoughAtan2Error;
  }
  const Spans spans = this->spans(bearing, bearing, margin, table);
  const Float4 cx = splat(centre.x()), cy = splat(centre.y()), cz = splat(centre.z());
  const Float4 r2 = splat(sphere.radius * sphere.radius);
  const Float4 zero = splat(0.0f);
  for (std::size_t k = 0; k < spans.count; ++k) {
    for (std::size_t i = 4 * spans.span[k].begin; i < 4 * spans.span[k].end; i += 4) {
      const Float4 dx = load4(&beams.dx[i]), dy = load4(&beams.dy[i]), dz = load4(&beams.dz[i]);
      const Float4 tx = cx - load4(&beams.ox[i]), ty = cy - load4(&beams.oy[i]), tz = cz - load4(&beams.oz[i]);
      const Float4 along = tx * dx + ty * dy + tz * dz;
      // The foot of the perpendicular keeps its digits where |c|^2 - along^2 would lose them.
      const Float4 fx = tx - along * dx, fy = ty - along * dy, fz = tz - along * dz;
      const Float4 half2 = r2 - (fx * fx + fy * fy + fz * fz);
      const Float4 best = load4(&best_[i]);
      const Int4 touched = half2 >= zero;
      if (!any4(touched)) continue;
      const Float4 t = along - sqrt4(max4(half2, zero));
      const Int4 hit = touched & (t > zero) & (t < best);
      store4(&best_[i], hit ? t : best);
    }
  }
}

/// Sorts the faces into shells about the laser, so that most of those behind walls find all their beams stopped.
void SweepCast::near_first() {
  constexpr std::size_t kShells = 16;
  constexpr float kThickness = 0.25f;  // [m]
  const auto shell = [&](const NearFace& face) {
    return std::min(kShells - 1, static_cast<std::size_t>(std::max(0.0f, face.nearest * (1.0f / kThickness))));
  };
  std::array<std::size_t, kShells> next{};
  for (const NearFace& face : near_) ++next[shell(face)];
  std::size_t first = 0;
  for (std::size_t& count : next) first += std::exchange(count, first);
  order_.resize(near_.size());
  for (const NearFace& face : near_) order_[next[shell(face)]++] = face;
}

void SweepCast::meet(const ScanFaces& faces, const Beams& beams, const BeamTable& table, double max_range) {
  faces.near({beams.middle, max_range, beams.travel, slack_}, near_);
  const ScanFaces::View view(faces, beams.middle);
  near_first();
  for (const NearFace& face : order_) {
    meet(face, faces.polygon(face.polygon), faces.corners(face.polygon, view), beams, table, max_range);
  }
}

void SweepCast::cast(const Beams& beams, const BeamTable& table, double max_range, const std::vector<Sphere>& spheres,
                     std::vector<float>& ranges, const ScanFaces* moving) {
  const std::size_t padded = beams.ox.size();
  ranges.assign(padded, kInf);
  best_ = ranges.data();
  slack_ = beams.tilt * (max_range + beams.travel) + beams.lift + 1e-4;
  meet(faces_, beams, table, max_range);
  if (moving != nullptr) meet(*moving, beams, table, max_range);
  for (const Sphere& sphere : spheres) meet(sphere, beams, table, max_range);
  const Float4 longest = splat(max_range), miss = splat(kInf);
  for (std::size_t i = 0; i < padded; i += 4) {
    const Float4 range = load4(&best_[i]);
    store4(&best_[i], range <= longest ? range : miss);
  }
  ranges.resize(beams.count);
}

}  // namespace rubble::sim
