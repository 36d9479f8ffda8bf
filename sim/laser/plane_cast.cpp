#include "sim/laser/plane_cast.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "sim/laser/simd.h"

namespace rubble::sim {
namespace {

using Eigen::Vector3d;

constexpr float kSeam = 2e-5f;        ///< segments reach so far beyond their ends: no light through seams [m]
constexpr float kBeamsSlack = 1e-3f;  ///< rounding of a bearing counted in beams

/// The two edges of a quadrilateral that cross the plane, by which of its corners lie above it (bit i: corner i). Edge
/// i leads from corner i to the next.
struct Crossing {
  unsigned char edge[2];
};
constexpr Crossing kCrossings[16] = {{{0, 0}}, {{3, 0}}, {{0, 1}}, {{3, 1}}, {{1, 2}}, {{3, 0}}, {{0, 2}}, {{3, 2}},
                                     {{2, 3}}, {{2, 0}}, {{0, 1}}, {{2, 1}}, {{1, 3}}, {{1, 0}}, {{0, 3}}, {{0, 0}}};

}  // namespace

/// Where the polygon crosses the scan plane becomes a segment.
void PlaneCast::cut(const ScanFaces::Corners& corners) {
  const int above = bits4(corners.z > splat(0.0f));
  if (above == 0 || above == 15) return;
  const Float4 share = corners.z / (corners.z - next4(corners.z));  // of the way along each edge
  float x[4], y[4];
  store4(x, corners.x + share * (next4(corners.x) - corners.x));
  store4(y, corners.y + share * (next4(corners.y) - corners.y));
  const Crossing& crossing = kCrossings[above];
  const float ends_x[2] = {x[crossing.edge[0]], x[crossing.edge[1]]};
  const float ends_y[2] = {y[crossing.edge[0]], y[crossing.edge[1]]};
  const bool swap = ends_x[0] * (ends_y[1] - ends_y[0]) < ends_y[0] * (ends_x[1] - ends_x[0]);
  const std::size_t n = segments_.count++;
  segments_.x0[n] = ends_x[swap ? 1 : 0];
  segments_.y0[n] = ends_y[swap ? 1 : 0];
  segments_.x1[n] = ends_x[swap ? 0 : 1];
  segments_.y1[n] = ends_y[swap ? 0 : 1];
}

/// Draws 1/r over the beams from `first` to `last`. Near the ends each beam is tested exactly, whatever the rough
/// bearings say; in between all beams meet the segment.
void PlaneCast::draw(const Stroke& stroke, float first, float last, const BeamTable& table) {
  const float most = static_cast<float>(table.count - 1);
  if (last < 0.0f || first > most) return;
  const std::size_t begin = static_cast<std::size_t>(std::max(0.0f, first)) / 4;
  const std::size_t end = static_cast<std::size_t>(std::min(most, last)) / 4 + 1;
  const float safe_first = 0.25f * (first + stroke.margin);
  const float safe_last = 0.25f * (last - stroke.margin - 3.0f);
  std::size_t safe = safe_first > 0.0f ? static_cast<std::size_t>(safe_first) + 1 : begin;
  std::size_t safe_end = safe_last >= 0.0f ? std::min(end, static_cast<std::size_t>(safe_last) + 1) : 0;
  if (safe >= safe_end) safe = safe_end = end;

  const Float4 a = splat(stroke.a), b = splat(stroke.b);
  const auto tested = [&](std::size_t from, std::size_t to) {
    const Float4 fx0 = splat(stroke.x0), fy0 = splat(stroke.y0), fx1 = splat(stroke.x1), fy1 = splat(stroke.y1);
    const Float4 outside = splat(-kSeam);
    for (std::size_t i = 4 * from; i < 4 * to; i += 4) {
      const Float4 c = load4(&table.cosine[i]), s = load4(&table.sine[i]);
      const Float4 best = load4(&inverse_[i]);
      const Float4 inverse = a * c + b * s;
      const Int4 hit = (fx0 * s - fy0 * c >= outside) & (fy1 * c - fx1 * s >= outside);
      store4(&inverse_[i], hit ? max4(inverse, best) : best);
    }
  };
  tested(begin, safe);
  for (std::size_t i = 4 * safe; i < 4 * safe_end; i += 4) {
    store4(&inverse_[i], max4(a * load4(&table.cosine[i]) + b * load4(&table.sine[i]), load4(&inverse_[i])));
  }
  tested(safe_end, end);
}

void PlaneCast::draw_segments(const BeamTable& table) {
  const Float4 zero = splat(0.0f), turn = splat(2.0 * kPi);
  const Float4 per_beam = splat(1.0 / table.angle_step);
  const Float4 least = splat(table.angle_min);
  const Float4 seam = splat(kSeam), error = splat(kRoughAtan2Error);
  for (std::size_t i = 0; i < segments_.count; i += 4) {
    const Float4 x0 = load4(&segments_.x0[i]), y0 = load4(&segments_.y0[i]);
    const Float4 x1 = load4(&segments_.x1[i]), y1 = load4(&segments_.y1[i]);
    const Float4 dx = x1 - x0, dy = y1 - y0;
    const Float4 spread = x0 * dy - y0 * dx;
    const Float4 margin0 = error + seam / max4(seam, abs4(x0) + abs4(y0));
    const Float4 margin1 = error + seam / max4(seam, abs4(x1) + abs4(y1));
    const Float4 low = rough_atan2(y0, x0) - margin0;
    Float4 high = rough_atan2(y1, x1) + margin1;
    high = high < low ? high + turn : high;
    const Float4 slack = splat(kBeamsSlack);
    float a[4], b[4], margin[4], first[4], last[4];
    store4(a, dy / spread);
    store4(b, zero - dx / spread);
    store4(margin, splat(2.0f) * (max4(margin0, margin1) * per_beam + slack));
    store4(first, (low - least) * per_beam - slack);
    store4(last, (high - least) * per_beam + slack);
    const float round = static_cast<float>(2.0 * kPi / table.angle_step);
    const int drawn = bits4(spread > splat(1e-12f));  // the others are edge on
    for (std::size_t k = 0; k < std::min<std::size_t>(4, segments_.count - i); ++k) {
      if ((drawn >> k & 1) == 0) continue;
      const Stroke stroke{
          a[k], b[k], margin[k], segments_.x0[i + k], segments_.y0[i + k], segments_.x1[i + k], segments_.y1[i + k]};
      draw(stroke, first[k], last[k], table);
      if (last[k] >= round) draw(stroke, first[k] - round, last[k] - round, table);  // across the seam behind
    }
  }
}

void PlaneCast::draw(const Sphere& sphere, const Placement& laser, const BeamTable& table, double max_range) {
  const Vector3d centre = Vector3d(sphere.x, sphere.y, sphere.z) - laser.p;
  const double height = laser.R.col(2).dot(centre);
  const double cut2 = sphere.radius * sphere.radius - height * height;
  if (cut2 <= 0.0) return;
  const double x = laser.R.col(0).dot(centre);
  const double y = laser.R.col(1).dot(centre);
  const double distance2 = x * x + y * y;
  if (distance2 > (max_range + sphere.radius) * (max_range + sphere.radius) || distance2 <= cut2) return;
  const double half = std::min(0.5 * kPi, std::sqrt(cut2 / (distance2 - cut2))) + 2.0 * kRoughAtan2Error;  // tan > asin
  const double bearing = static_cast<double>(rough_atan2(splat(y), splat(x))[0]);
  const Float4 cx = splat(x), cy = splat(y), r2 = splat(cut2);
  const Float4 zero = splat(0.0f);
  const double most = static_cast<double>(table.count - 1);
  for (const double shift : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
    const double first = (bearing + shift - half - table.angle_min) / table.angle_step - 1.0;
    const double last = (bearing + shift + half - table.angle_min) / table.angle_step + 1.0;
    if (last < 0.0 || first > most) continue;
    const std::size_t begin = static_cast<std::size_t>(std::max(0.0, first)) / 4 * 4;
    const std::size_t end = static_cast<std::size_t>(std::min(most, last)) + 1;
    for (std::size_t i = begin; i < end; i += 4) {
      const Float4 c = load4(&table.cosine[i]), s = load4(&table.sine[i]);
      const Float4 along = cx * c + cy * s;
      const Float4 aside = cx * s - cy * c;
      const Float4 half2 = r2 - aside * aside;
      const Float4 best = load4(&inverse_[i]);
      const Float4 range = along - sqrt4(max4(half2, zero));
      const Int4 hit = (half2 >= zero) & (range > zero);
      store4(&inverse_[i], hit ? max4(splat(1.0f) / range, best) : best);
    }
  }
}

void PlaneCast::draw_faces(const ScanFaces& faces, const Placement& laser, const BeamTable& table, double max_range) {
  faces.near({laser, max_range, 0.0, 0.0}, near_);
  if (segments_.x0.size() < near_.size() + 4) {
    for (auto* list : {&segments_.x0, &segments_.y0, &segments_.x1, &segments_.y1}) list->resize(2 * near_.size() + 4);
  }
  segments_.count = 0;
  const ScanFaces::View view(faces, laser);
  for (const NearFace& face : near_) cut(faces.corners(face.polygon, view));
  draw_segments(table);
}

void PlaneCast::cast(const Placement& laser, const BeamTable& table, double max_range,
                     const std::vector<Sphere>& spheres, std::vector<float>& ranges, const ScanFaces* moving) {
  const std::size_t padded = table.cosine.size();
  ranges.assign(padded, 0.0f);
  inverse_ = ranges.data();
  draw_faces(faces_, laser, table, max_range);
  if (moving != nullptr) draw_faces(*moving, laser, table, max_range);
  for (const Sphere& sphere : spheres) draw(sphere, laser, table, max_range);
  const Float4 longest = splat(max_range), miss = splat(kInf), one = splat(1.0f);
  for (std::size_t i = 0; i < padded; i += 4) {
    const Float4 range = one / load4(&inverse_[i]);
    store4(&inverse_[i], range <= longest ? range : miss);
  }
  ranges.resize(table.count);
}

}  // namespace rubble::sim
