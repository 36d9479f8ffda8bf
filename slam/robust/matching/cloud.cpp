#include "slam/robust/matching/cloud.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;

namespace {

constexpr double kSightSlack = 0.15;       ///< a surface this much before what was seen is not yet a contradiction [m]
constexpr double kSightSlackShare = 0.02;  ///< and so much of the range
constexpr double kSameSurface = 0.10;      ///< neighbouring hits so close lie on one surface [m]
constexpr double kSameSurfaceSteps = 6.0;  ///< or closer than so many beam steps at their range
constexpr double kNormalReach = 0.15;      ///< hits so close tell the normal [m]
constexpr double kNormalReachSteps = 2.5;  ///< or so many beam steps
constexpr std::size_t kNormalNeighbours = 8;   ///< on each side, at most
constexpr std::size_t kLeastNeighbours = 2;    ///< in all
constexpr std::size_t kGrazingNeighbours = 2;  ///< on each side where there are fewer: then these, however far ...
constexpr double kGrazingRoughness = 0.03;     ///< ... if they lie on a line but for the scanner's noise (RMS) [m]
constexpr double kShortGap = 0.15;             ///< gaps up to here need no filling [m]
constexpr double kLongGap = 1.5;               ///< and from here are no surface [m]
constexpr double kEndJump = 0.3;               ///< beside a wall's end the scanner sees so much farther [m]
constexpr int kBesideEnd = 3;                  ///< so many hits there may be mixed pixels
constexpr int kSilentBeams = 3;                ///< or where more beams than these return nothing ...
constexpr double kWithinSight = 0.8;           ///< ... well within the range that other beams return from
constexpr double kEndLength = 0.20;            ///< a wall that tells its end is straight for so long [m] ...
constexpr double kEndRoughness = 0.03;         ///< ... within this [m]
constexpr double kEndSpacing = 0.06;           ///< hits on it lie no farther apart, for the end is known no better [m]
constexpr long kMostEnds = 6;                  ///< an end known best counts as so many points
constexpr double kLooseSize = 0.35;            ///< wider things are none that a robot pushes along [m] ...
constexpr double kPushedSize = 0.46;           ///< ... but for a large ball right ahead [m],
constexpr double kPushedAhead = 0.7;           ///< so near to the middle of the base [m]
constexpr double kPushedAside = 0.45;          ///< and to its way: half a body and the ball's radius [m]
constexpr float kSameDirection = 0.9F;         ///< cosine between normals of one straight surface

int bin_of(double bearing) {
  const int bin = static_cast<int>(std::floor(rad_to_deg(bearing)));
  return ((bin % SightFan::kBins) + SightFan::kBins) % SightFan::kBins;
}

/// Of a direction [deg], 0 to 360, but for an error below 1e-5 rad: a polynomial (Abramowitz and Stegun, Handbook of
/// mathematical functions, 4.4.49). Free of branches, so that compilers use vector code for many.
inline double about_angle(double x, double y) {
  const double ax = std::abs(x), ay = std::abs(y);
  const double t = std::min(ax, ay) / std::max(ax, ay);
  const double tt = t * t;
  const double flat = t * (0.9998660 + tt * (-0.3302995 + tt * (0.1801410 + tt * (-0.0851330 + tt * 0.0208351))));
  const double steep = 0.5 * kPi - flat;
  const double right = rad_to_deg(ay > ax ? steep : flat);
  const double left = 180.0 - right;
  const double upper = x < 0.0 ? left : right;
  const double lower = 360.0 - upper;
  return y < 0.0 ? lower : upper;
}

/// The bin of a direction, of which the angle is known about: that is well enough, but close to where bins meet.
int bin_of(double about, double x, double y) {
  constexpr double kUnsure = 1e-3;  // [deg]
  const double within = about - std::floor(about);
  if (!(within > kUnsure && within < 1.0 - kUnsure)) return bin_of(std::atan2(y, x));  // also where it is no number
  return static_cast<int>(about);
}

/// Hits of a scan in the order of their beams.
class Hits {
 public:
  Hits(const ScanPoints& scan) : step_(scan.beam_width), floor_beams_(scan.floor_beams) {
    p_.reserve(scan.rays.size());
    range_.reserve(scan.rays.size());
    beam_.reserve(scan.rays.size());
    for (const ScanRay& ray : scan.rays) {
      if (!ray.hit) continue;
      p_.push_back(ray.end);
      range_.push_back(distance(ray.end, scan.origin));
      beam_.push_back(ray.beam);
    }
    drop_mixed_pixels();
    for (const double range : range_) farthest_ = std::max(farthest_, range);
    join();
  }

  std::size_t size() const { return p_.size(); }
  const TPoint2D& p(std::size_t i) const { return p_[i]; }
  double range(std::size_t i) const { return range_[i]; }
  double farthest() const { return farthest_; }
  double step() const { return step_; }
  int beams_between(std::size_t i, std::size_t j) const { return std::abs(beam_[j] - beam_[i]); }
  bool floor_between(std::size_t i, std::size_t j) const {
    const auto [first, last] = std::minmax(beam_[i], beam_[j]);
    const auto floor = std::upper_bound(floor_beams_.begin(), floor_beams_.end(), first);
    return floor != floor_beams_.end() && *floor < last;
  }
  /// Whether two neighbours, at most one missing beam apart, lie on one surface, as judged by the range of the first.
  bool joined(std::size_t i, std::size_t j) const { return (j > i ? joined_to_next_ : joined_to_last_)[i] != 0; }

 private:
  double gap(std::size_t i) const { return std::max(kSameSurface, kSameSurfaceSteps * range_[i] * step_); }

  bool hangs_between(std::size_t i) const {
    if (std::abs(beam_[i] - beam_[i - 1]) != 1 || std::abs(beam_[i + 1] - beam_[i]) != 1) return false;
    const double far = gap(i);
    return (range_[i - 1] - range_[i]) * (range_[i + 1] - range_[i]) < 0.0 && distance(p_[i], p_[i - 1]) > far &&
           distance(p_[i], p_[i + 1]) > far;
  }

  /// Once for all: each pair of neighbours is asked for some ten times.
  void join() {
    joined_to_next_.assign(size(), 0);
    joined_to_last_.assign(size(), 0);
    for (std::size_t i = 0; i + 1 < size(); ++i) {
      const int apart = std::abs(beam_[i + 1] - beam_[i]);
      const double away = distance(p_[i], p_[i + 1]);
      joined_to_next_[i] = apart <= 2 && away < gap(i) * apart ? 1 : 0;
      joined_to_last_[i + 1] = apart <= 2 && away < gap(i + 1) * apart ? 1 : 0;
    }
  }

  void drop_mixed_pixels() {
    std::vector<std::size_t> dropped;
    for (std::size_t i = 1; i + 1 < p_.size(); ++i)
      if (hangs_between(i)) dropped.push_back(i);
    if (dropped.empty()) return;
    std::size_t kept = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < p_.size(); ++i) {
      if (next < dropped.size() && dropped[next] == i) {
        ++next;
        continue;
      }
      p_[kept] = p_[i];
      range_[kept] = range_[i];
      beam_[kept++] = beam_[i];
    }
    p_.resize(kept);
    range_.resize(kept);
    beam_.resize(kept);
  }

  double step_;
  const std::vector<int>& floor_beams_;
  double farthest_ = 0.0;
  std::vector<TPoint2D> p_;
  std::vector<double> range_;
  std::vector<int> beam_;
  std::vector<char> joined_to_next_;
  std::vector<char> joined_to_last_;
};

/// Hits that may lie on one line with a hit: first and last.
using Stretch = std::pair<std::size_t, std::size_t>;

/// Those joined with hit `i` that lie within `reach` [m] of it; so many on each side however far.
Stretch beside(const Hits& hits, std::size_t i, double reach, std::size_t however_far) {
  const auto belongs = [&](std::size_t from, std::size_t to, std::size_t apart) {
    return apart < kNormalNeighbours && hits.joined(from, to) &&
           (apart < however_far || distance(hits.p(to), hits.p(i)) <= reach);
  };
  std::size_t first = i;
  std::size_t last = i;
  while (first > 0 && belongs(first, first - 1, i - first)) --first;
  while (last + 1 < hits.size() && belongs(last, last + 1, last - i)) ++last;
  return {first, last};
}

/// The point `i` with the normal of a line through it and its neighbours, where they lie on one.
OrientedPoint oriented(const Hits& hits, std::size_t i, const TPoint2D& laser) {
  const TPoint2D& p = hits.p(i);
  OrientedPoint out{static_cast<float>(p.x), static_cast<float>(p.y), 0.0F, 0.0F};
  const double reach = std::max(kNormalReach, kNormalReachSteps * hits.range(i) * hits.step());
  auto [first, last] = beside(hits, i, reach, 0);
  // Where a wall is seen at a grazing angle its hits lie far apart; but these far walls along the way tell the heading.
  const bool grazing = last - first < kLeastNeighbours;
  if (grazing) std::tie(first, last) = beside(hits, i, reach, kGrazingNeighbours);
  if (last - first < kLeastNeighbours) return out;
  const double count = static_cast<double>(last - first + 1);

  TPoint2D mean(0, 0);
  for (std::size_t k = first; k <= last; ++k) mean += hits.p(k);
  mean *= 1.0 / count;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const TPoint2D d = hits.p(k) - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double half_trace = 0.5 * (xx + yy);
  const double root = std::sqrt(std::max(0.0, half_trace * half_trace - (xx * yy - xy * xy)));
  const double along = half_trace + root;
  const double across = half_trace - root;
  const bool line = across < 0.15 * along || (across / count < 1e-4 && across < 0.4 * along);
  if (!line || (grazing && across > count * kGrazingRoughness * kGrazingRoughness)) return out;
  // The eigenvector of `across`: (xy, across - xx) or (across - yy, xy), whichever is longer.
  TPoint2D n = std::abs(across - xx) > std::abs(across - yy) ? TPoint2D(xy, across - xx) : TPoint2D(across - yy, xy);
  const double norm = length(n);
  if (!(norm > 0.0)) return out;
  const double towards = n.x * (p.x - laser.x) + n.y * (p.y - laser.y) > 0.0 ? -1.0 : 1.0;
  out.nx = static_cast<float>(towards * n.x / norm);
  out.ny = static_cast<float>(towards * n.y / norm);
  return out;
}

/// Points between two neighbouring hits of one straight surface, `spacing` apart.
void fill_between(const TPoint2D& from, const TPoint2D& to, const OrientedPoint& a, const OrientedPoint& b,
                  const TPoint2D& laser, double spacing, std::vector<OrientedPoint>& out) {
  const double gap = distance(from, to);
  if (gap <= kShortGap || gap >= kLongGap) return;
  TPoint2D n(-(to.y - from.y) / gap, (to.x - from.x) / gap);
  if (n.x * (to.x - laser.x) + n.y * (to.y - laser.y) > 0.0) n = n * -1.0;
  const float nx = static_cast<float>(n.x);
  const float ny = static_cast<float>(n.y);
  if (nx * a.nx + ny * a.ny < kSameDirection || nx * b.nx + ny * b.ny < kSameDirection) return;
  const int more = static_cast<int>(gap / spacing);
  for (int k = 1; k <= more; ++k) {
    const TPoint2D p = from + (to - from) * (static_cast<double>(k) / (more + 1));
    out.push_back({static_cast<float>(p.x), static_cast<float>(p.y), nx, ny});
  }
}

/// Where a wall ends, and how far apart its last hits lie.
struct WallEnd {
  OrientedPoint point;  ///< its normal points along the wall, out of it
  double spacing;       ///< [m]
};

/// The end of a wall at hit `i`, from where it goes on by `inwards` (-1 or 1) in the list. Only where more is seen
/// beside it, or nothing up to where the scanner sees: where less is seen, the wall is hidden by something nearer, and
/// its end is nowhere; and where the scan plane dips into the floor the wall goes on behind.
std::optional<WallEnd> wall_end(const Hits& hits, std::size_t i, int inwards) {
  const auto at = [&](int steps) { return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + steps); };
  const auto exists = [&](int steps) { return at(steps) < hits.size(); };  // below the first wraps to a large number
  if (!exists(-inwards) || hits.joined(i, at(-inwards))) return std::nullopt;
  bool open = hits.beams_between(i, at(-inwards)) > kSilentBeams && !hits.floor_between(i, at(-inwards)) &&
              hits.range(i) < kWithinSight * hits.farthest();
  for (int k = 1; k <= kBesideEnd && exists(-k * inwards) && !open; ++k)
    open = hits.beams_between(i, at(-k * inwards)) <= kBesideEnd + 1 &&
           hits.range(at(-k * inwards)) > hits.range(i) + kEndJump;
  if (!open) return std::nullopt;
  const TPoint2D& p = hits.p(i);
  int last = 0;
  while (exists(last + inwards) && hits.joined(at(last), at(last + inwards)) &&
         distance(hits.p(at(last)), p) < kEndLength)
    last += inwards;
  const double along = distance(hits.p(at(last)), p);
  const double spacing = along / std::max(1, std::abs(last));
  if (along < kEndLength || spacing > kEndSpacing) return std::nullopt;
  const TPoint2D out = (p - hits.p(at(last))) * (1.0 / along);
  for (int k = inwards; k != last; k += inwards) {
    const TPoint2D d = hits.p(at(k)) - p;
    if (std::abs(out.x * d.y - out.y * d.x) > kEndRoughness) return std::nullopt;
  }
  const TPoint2D end = p + out * (0.5 * spacing);  // it lies between this beam and the next
  return WallEnd{
      {static_cast<float>(end.x), static_cast<float>(end.y), static_cast<float>(out.x), static_cast<float>(out.y)},
      spacing};
}

/// Which hits are on small things that stand free, so near [m] that the robot may push them: a ball that rolls before
/// it between two bare walls is all that tells how far along it is, and says that it stands.
std::vector<bool> on_loose_things(const Hits& hits, double near) {
  std::vector<bool> loose(hits.size(), false);
  const auto seen_past = [&](std::size_t i, std::size_t beside) {
    return hits.beams_between(i, beside) > kSilentBeams || hits.range(beside) > hits.range(i) + kEndJump;
  };
  const auto right_ahead = [&](std::size_t first, std::size_t last) {
    const TPoint2D middle = (hits.p(first) + hits.p(last)) * 0.5;
    double nearest = middle.x;
    for (std::size_t i = first; i <= last; ++i) nearest = std::min(nearest, hits.p(i).x);
    return nearest > 0.0 && nearest < kPushedAhead && std::abs(middle.y) < kPushedAside;
  };
  for (std::size_t first = 0, last; first < hits.size(); first = last + 1) {
    for (last = first; last + 1 < hits.size() && hits.joined(last, last + 1);) ++last;
    if (first == 0 || last + 1 == hits.size() || length(hits.p(first)) > near) continue;
    const double size = distance(hits.p(first), hits.p(last));
    if (size > kPushedSize || (size > kLooseSize && !right_ahead(first, last))) continue;
    if (seen_past(first, first - 1) && seen_past(last, last + 1))
      for (std::size_t i = first; i <= last; ++i) loose[i] = true;
  }
  return loose;
}

/// Of walls, not of loose things: the edge of a large ball is as straight as the end of a wall.
void add_ends(const Hits& hits, const std::vector<bool>& loose, Cloud& cloud) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (loose[i]) continue;
    for (const int inwards : {-1, 1}) {
      const std::optional<WallEnd> end = wall_end(hits, i, inwards);
      if (!end) continue;
      const long weight = std::clamp(std::lround(kEndSpacing / end->spacing), 1L, kMostEnds);
      cloud.ends.insert(cloud.ends.end(), static_cast<std::size_t>(weight), end->point);
      cloud.filled.push_back(end->point);
    }
  }
}

}  // namespace

void SightFan::add(double bearing, double range) {
  const auto cm = static_cast<std::uint16_t>(std::clamp(std::lround(100.0 * range), 0L, 65534L));
  const auto bin = static_cast<std::size_t>(bin_of(bearing));
  nearest_[bin] = std::min(nearest_[bin], cm);
  farthest_[bin] = std::max(farthest_[bin], cm);
}

SightFan::Verdict SightFan::judge(const TPoint2D& p) const {
  return judge(bin_of(about_angle(p.x, p.y), p.x, p.y), length(p), 1.0);
}

SightFan::Judged SightFan::judge(const std::vector<OrientedPoint>& points, const PlanarTransform& T_base_points,
                                 const TPoint2D& laser, Slack slack) const {
  constexpr std::size_t kBlock = 64;
  std::array<double, kBlock> x, y, about, range, across;
  across.fill(1.0);
  const double c = T_base_points.cosine(), s = T_base_points.sine();
  const double x0 = T_base_points.pose().x, y0 = T_base_points.pose().y;
  Judged judged;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - begin);
    const OrientedPoint* const p = points.data() + begin;
    for (std::size_t i = 0; i < count; ++i) {
      const double px = static_cast<double>(p[i].x), py = static_cast<double>(p[i].y);
      x[i] = x0 + c * px - s * py - laser.x;
      y[i] = y0 + s * px + c * py - laser.y;
    }
    for (std::size_t i = 0; i < count; ++i) {
      about[i] = about_angle(x[i], y[i]);
      range[i] = length(x[i], y[i]);
    }
    if (slack == Slack::AcrossSurface) {
      for (std::size_t i = 0; i < count; ++i) {
        const double nx = static_cast<double>(p[i].nx), ny = static_cast<double>(p[i].ny);
        const bool known = p[i].has_normal() && range[i] > 0.0;
        across[i] = known ? std::abs(x[i] * (c * nx - s * ny) + y[i] * (s * nx + c * ny)) / range[i] : 1.0;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Verdict verdict = judge(bin_of(about[i], x[i], y[i]), range[i], across[i]);
      judged.in_front += verdict == Verdict::InFront ? 1 : 0;
      judged.agrees += verdict == Verdict::Agrees ? 1 : 0;
    }
  }
  return judged;
}

/// across: of a metre along the beam, how much of it is at right angles to the surface.
SightFan::Verdict SightFan::judge(int bin, double range, double across) const {
  const auto left = static_cast<std::size_t>(bin + 1 < kBins ? bin + 1 : 0);
  const auto right = static_cast<std::size_t>(bin > 0 ? bin - 1 : kBins - 1);
  const auto middle = static_cast<std::size_t>(bin);
  const auto [nearest, least_near] = std::minmax({nearest_[left], nearest_[middle], nearest_[right]});
  const std::uint16_t farthest = std::max({farthest_[left], farthest_[middle], farthest_[right]});
  const double slack = kSightSlack + kSightSlackShare * range;
  // All asked at once: which of them it is no branch prediction could tell.
  const bool in_front = range < 0.01 * nearest - slack / across;
  const bool agrees = range <= 0.01 * farthest + slack;
  const Verdict seen = in_front ? Verdict::InFront : agrees ? Verdict::Agrees : Verdict::Behind;
  return least_near == kNothing ? Verdict::Nothing : seen;
}

Cloud cloud_of(const ScanPoints& scan, const CloudConfig& config) {
  Cloud cloud;
  cloud.laser = scan.origin;
  const Hits hits(scan);
  const std::vector<bool> loose = on_loose_things(hits, config.loose_within);
  std::size_t kept = 0;  // hit of the last point
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (loose[i]) continue;
    const TPoint2D& p = hits.p(i);
    const bool goes_on = i > 0 && hits.joined(i - 1, i);
    if (goes_on && distance(p, hits.p(kept)) < config.spacing) continue;
    const OrientedPoint point = oriented(hits, i, scan.origin);
    if (goes_on && !cloud.points.empty())
      fill_between(hits.p(i - 1), p, cloud.points.back(), point, scan.origin, config.wide_spacing, cloud.filled);
    cloud.points.push_back(point);
    kept = i;
  }
  add_ends(hits, loose, cloud);
  return cloud;
}

SightFan sight_of(const ScanPoints& scan) {
  SightFan sight;
  const Hits hits(scan);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const TPoint2D d = hits.p(i) - scan.origin;
    sight.add(std::atan2(d.y, d.x), hits.range(i));
  }
  return sight;
}

}  // namespace rubble::slam
