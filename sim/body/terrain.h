#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstdint>
#include <vector>

#include "arenas/model/arena.h"
#include "base/grid.h"

namespace rubble::sim {

/// The floor at one place, as a wheel feels it.
struct Ground {
  double height = 0.0;    ///< [m]
  double gx = 0.0;        ///< dz/dx
  double gy = 0.0;        ///< dz/dy
  double friction = 0.0;  ///< coefficient between wheel and what lies there
  bool on_sheet = false;  ///< loose paper lies between wheel and floor

  bool is_level() const { return gx == 0.0 && gy == 0.0; }
};

/// Height, slope and friction at x, y in constant time: uniform buckets over floor patches, sheets and steps.
/// Where patches overlap the higher one carries; beyond all patches is the ground at z = 0, as `arenas::risers` has it.
class Terrain {
 public:
  /// `climbable_step` [m]: a wheel takes steps up to this height, as a chamfer of 45 deg in front of the edge.
  Terrain(const arenas::Arena& arena, double climbable_step);

  /// The floor itself.
  Ground at(const mrpt::math::TPoint2D& p) const;
  /// What carries the foot of a wheel that stands at p: the floor, or the chamfer of a step next to it.
  Ground under_wheel(const mrpt::math::TPoint2D& p) const;

 private:
  struct HalfPlane {
    double nx, ny, c;  ///< inside: nx x + ny y <= c
  };
  struct Area {  ///< convex
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  struct Patch {
    double c, gx, gy;  ///< z = c + gx x + gy y
    double friction;
    Area area;
  };
  struct Sheet {
    double friction;
    Area area;
  };
  struct Chamfer {
    double ax, ay, ux, uy;  ///< lower edge's start and unit direction; the low side is to the right of it
    double length;          ///< [m]
    double high, slope;     ///< height of the edge at its start [m] and its rise along the edge
  };
  /// What may touch one bucket; ranges into the index lists.
  struct Bucket {
    std::uint32_t patches = 0, patches_end = 0;
    std::uint32_t sheets = 0, sheets_end = 0;
    std::uint32_t chamfers = 0, chamfers_end = 0;
    bool one_patch = false;  ///< the only patch covers the whole bucket
  };

  Area add_area(const arenas::Outline& outline);
  bool contains(const Area& area, const mrpt::math::TPoint2D& p) const;
  bool covers(const Area& area, double x0, double y0, double x1, double y1) const;
  const Bucket* bucket(const mrpt::math::TPoint2D& p) const;
  Ground floor(const Bucket& bucket, const mrpt::math::TPoint2D& p) const;
  void build_buckets(const arenas::Arena& arena);

  double floor_friction_;
  double reach_;  ///< how far a chamfer extends before its edge [m]
  std::vector<HalfPlane> half_planes_;
  std::vector<Patch> patches_;
  std::vector<Sheet> sheets_;
  std::vector<Chamfer> chamfers_;
  std::vector<std::uint32_t> patch_lists_, sheet_lists_, chamfer_lists_;
  Grid<Bucket> buckets_;
};

}  // namespace rubble::sim
