#include "slam/scan/sure_misses.h"

#include <mrpt/math/TPoint2D.h>

#include <cmath>
#include <cstddef>
#include <optional>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using robot::LaserScan;

namespace {

constexpr int kFewest = 5;    ///< beams beside each other that met nothing
constexpr int kRim = 2;       ///< beams next to a surface: half of their spot, a cell wide at 4 m, lies on it
constexpr int kBeside = 3;    ///< the surface ends at most so many lost beams before them
constexpr int kAlong = 5;     ///< beams on the surface that tell where it leads
constexpr double kGap = 0.3;  ///< neighbouring hits farther apart do not lie on one surface [m]
const double kGrazing = std::sin(deg_to_rad(12.0));

bool is_miss(float range) { return range == LaserScan::kMiss; }

/// Makes the misses of one scan unknown that a surface beside them may have swallowed.
class Grazing {
 public:
  explicit Grazing(LaserScan& scan) : scan_(scan), beams_(static_cast<int>(scan.ranges.size())) {}

  /// Of the misses first..last, those next to `first` (step 1) or `last` (step -1).
  void forget(int first, int last, int step) {
    const int edge = step > 0 ? first : last;
    const int end = step > 0 ? last + 1 : first - 1;
    const std::optional<int> near = hit_beside(edge, -step);
    if (!near) return;
    const std::optional<int> far = along_surface(*near, -step);
    if (!far) return;
    const TPoint2D p = at(*near);
    const TPoint2D back = at(*far);
    const double span = distance(p, back);
    if (span <= 0.0) return;
    const TPoint2D u{(p.x - back.x) / span, (p.y - back.y) / span};
    for (int beam = edge; beam != end && goes_on_into(p, u, beam); beam += step) range(beam) = LaserScan::kUnknown;
  }

 private:
  float& range(int beam) { return scan_.ranges[static_cast<std::size_t>(beam)]; }
  bool has_hit(int beam) const {
    if (beam < 0 || beam >= beams_) return false;
    const float r = scan_.ranges[static_cast<std::size_t>(beam)];
    return std::isfinite(r) && r > 0.0F && static_cast<double>(r) >= scan_.range_min;
  }
  TPoint2D at(int beam) const {
    const auto i = static_cast<std::size_t>(beam);
    const double r = static_cast<double>(scan_.ranges[i]);
    return {r * std::cos(scan_.bearing(i)), r * std::sin(scan_.bearing(i))};
  }

  std::optional<int> hit_beside(int edge, int step) const {
    for (int k = 1; k <= kBeside + 1; ++k)
      if (has_hit(edge + k * step)) return edge + k * step;
    return std::nullopt;
  }

  /// The last hit of the surface within kAlong beams.
  std::optional<int> along_surface(int near, int step) const {
    std::optional<int> last;
    int before = near;
    for (int k = 1; k <= kAlong; ++k) {
      const int beam = near + k * step;
      if (!has_hit(beam)) continue;
      if (distance(at(beam), at(before)) > kGap) break;
      last = before = beam;
    }
    return last;
  }

  /// Whether the line from p along u comes to meet the beam, at a flat angle and in the scanner's reach.
  bool goes_on_into(const TPoint2D& p, const TPoint2D& u, int beam) const {
    const double bearing = scan_.bearing(static_cast<std::size_t>(beam));
    const TPoint2D d{std::cos(bearing), std::sin(bearing)};
    const double sine = u.x * d.y - u.y * d.x;
    if (std::abs(sine) >= kGrazing || sine == 0.0) return false;
    const double ahead = (d.x * p.y - d.y * p.x) / sine;  // along u
    const double reach = (u.x * p.y - u.y * p.x) / sine;  // along the beam
    return ahead > 0.0 && reach > 0.0 && reach < scan_.range_max;
  }

  LaserScan& scan_;
  int beams_;
};

}  // namespace

void bind_misses(Binder& binder, MissTrust& misses) { binder.choice("misses", misses, {"none", "sure", "all"}); }

LaserScan with_sure_misses(LaserScan scan) {
  const bool tells = scan.codes.size() == scan.ranges.size();
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (is_miss(scan.ranges[i]) && (!tells || scan.codes[i] != 0)) scan.ranges[i] = LaserScan::kUnknown;
  if (!tells) return scan;

  Grazing grazing(scan);
  const auto beams = static_cast<int>(scan.ranges.size());
  const auto miss = [&](int beam) { return is_miss(scan.ranges[static_cast<std::size_t>(beam)]); };
  const auto forget = [&](int from, int to) {
    for (int beam = from; beam <= to; ++beam) scan.ranges[static_cast<std::size_t>(beam)] = LaserScan::kUnknown;
  };
  for (int first = 0; first < beams;) {
    if (!miss(first)) {
      ++first;
      continue;
    }
    int last = first;
    while (last + 1 < beams && miss(last + 1)) ++last;
    if (last - first + 1 < kFewest) {
      forget(first, last);
    } else {
      grazing.forget(first, last, 1);
      grazing.forget(first, last, -1);
      if (first > 0) forget(first, first + kRim - 1);
      if (last + 1 < beams) forget(last - kRim + 1, last);
    }
    first = last + 1;
  }
  return scan;
}

LaserScan with_trusted_misses(LaserScan scan, MissTrust misses) {
  if (misses == MissTrust::Sure) return with_sure_misses(std::move(scan));
  return scan;
}

}  // namespace rubble::slam
