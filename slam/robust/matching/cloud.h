#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "base/planar.h"
#include "slam/grid/count_map.h"

namespace rubble::slam {

/// A point on a surface, with the surface's normal where its neighbours tell it. Floats: there are millions of them.
struct OrientedPoint {
  float x = 0.0F, y = 0.0F;    ///< [m]
  float nx = 0.0F, ny = 0.0F;  ///< unit normal towards the laser; both zero: unknown

  bool has_normal() const { return nx != 0.0F || ny != 0.0F; }
};

/// How far a scan saw, in a fan of one-degree bins around the laser: nearest and farthest return of each.
class SightFan {
 public:
  static constexpr int kBins = 360;
  /// Nearest and farthest return of each [cm]; the largest number and zero where there is none.
  using Bins = std::array<std::pair<std::uint16_t, std::uint16_t>, kBins>;

  explicit SightFan(const Bins& bins) {
    for (std::size_t k = 0; k < bins.size(); ++k) std::tie(nearest_[k], farthest_[k]) = bins[k];
  }
  Bins bins() const {
    Bins bins;
    for (std::size_t k = 0; k < bins.size(); ++k) bins[k] = {nearest_[k], farthest_[k]};
    return bins;
  }
  SightFan() {
    nearest_.fill(kNothing);
    farthest_.fill(0);
  }
  void add(double bearing, double range);

  enum class Verdict { Nothing, InFront, Agrees, Behind };
  /// Where a surface at `p` [m, from the laser, along the base's axes] would lie in what was seen: in front of it (then
  /// the scan should have met it and did not), with it, or hidden behind. Nothing where a neighbouring bin is empty.
  Verdict judge(const mrpt::math::TPoint2D& p) const;
  /// How far before what was seen a surface may lie and agree with it: along the beam, or at right angles to the
  /// surface, where its normal is known. From the next lane both faces of one wall are looked at along it: there a few
  /// centimetres of the pose are metres of the beam.
  enum class Slack { AlongBeam, AcrossSurface };
  /// How many of some points lie in front of what was seen, and with it.
  struct Judged {
    int in_front = 0;
    int agrees = 0;
  };
  /// Of points moved into the base frame; `laser`: where it saw from, there.
  Judged judge(const std::vector<OrientedPoint>& points, const PlanarTransform& T_base_points,
               const mrpt::math::TPoint2D& laser, Slack slack = Slack::AlongBeam) const;

 private:
  Verdict judge(int bin, double range, double across) const;

  static constexpr std::uint16_t kNothing = std::numeric_limits<std::uint16_t>::max();
  std::array<std::uint16_t, kBins> nearest_;   ///< [cm]
  std::array<std::uint16_t, kBins> farthest_;  ///< [cm]
};

struct CloudConfig {
  double spacing = 0.08;       ///< between matched points [m]
  double wide_spacing = 0.10;  ///< between points filled in where beams are far apart [m]
  double loose_within = 1.2;   ///< small free things so near may be pushed along, and are not matched with [m]
};

/// A scan as the matching sees it, in the base frame.
struct Cloud {
  std::vector<OrientedPoint> points;  ///< thinned
  std::vector<OrientedPoint> filled;  ///< between neighbouring points of one far surface, and ends of walls; only to be
                                      ///< matched with
  /// Ends of walls, as points whose normals point along the wall, out of it: in a corridor they alone tell how far
  /// along the robot is. Each stands here as often as it is better known than a point of a wall. Empty in a cloud that
  /// was kept.
  std::vector<OrientedPoint> ends;
  mrpt::math::TPoint2D laser;
  SightFan sight;  ///< empty until sight_of() is put here: only clouds that are kept need it
};

/// Thins the hits of a scan and finds their normals. Mixed pixels - single beams that hang between two depths because
/// their spot lies on an edge - are left out, and small things that the robot may push along.
Cloud cloud_of(const ScanPoints& scan, const CloudConfig& config);
/// How far the scan saw, by the same hits.
SightFan sight_of(const ScanPoints& scan);

}  // namespace rubble::slam
