#include "sim/body/terrain.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/risers.h"

namespace rubble::sim {
namespace {

using mrpt::math::TPoint2D;

constexpr double kBucket = 0.3;  ///< a quarter of a pallet, so that pallets fill whole buckets [m]
constexpr double kTouch = 1e-6;  ///< a patch that only touches a bucket's border does not belong to it [m]
constexpr double kEdge = 1e-9;   ///< a point on an outline belongs to it [m]

struct Box {
  double x0, y0, x1, y1;
};

Box box_of(const arenas::Outline& outline) {
  Box box{outline[0].x, outline[0].y, outline[0].x, outline[0].y};
  for (const TPoint2D& p : outline) {
    box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x), std::max(box.y1, p.y)};
  }
  return box;
}

/// Per bucket, the indices of the boxes that overlap it, flattened: list[start[b]] .. list[start[b + 1]].
struct Lists {
  std::vector<std::uint32_t> start;
  std::vector<std::uint32_t> list;
};

Lists distribute(const std::vector<Box>& boxes, const GridFrame& frame) {
  std::vector<std::vector<std::uint32_t>> cells(frame.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Cell low = frame.cell({boxes[i].x0 + kTouch, boxes[i].y0 + kTouch});
    const Cell high = frame.cell({boxes[i].x1 - kTouch, boxes[i].y1 - kTouch});
    for (int y = std::max(0, low.y); y <= std::min(frame.height - 1, high.y); ++y) {
      for (int x = std::max(0, low.x); x <= std::min(frame.width - 1, high.x); ++x) {
        cells[frame.index({x, y})].push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  Lists lists;
  for (const auto& cell : cells) {
    lists.start.push_back(static_cast<std::uint32_t>(lists.list.size()));
    lists.list.insert(lists.list.end(), cell.begin(), cell.end());
  }
  lists.start.push_back(static_cast<std::uint32_t>(lists.list.size()));
  return lists;
}

}  // namespace

Terrain::Terrain(const arenas::Arena& arena, double climbable_step)
    : floor_friction_(arena.floor_friction), reach_(climbable_step) {
  for (const arenas::FloorPatch& patch : arena.floor) {
    const TPoint2D& o = patch.outline[0];
    patches_.push_back({patch.z - patch.gx * o.x - patch.gy * o.y, patch.gx, patch.gy,
                        patch.friction.value_or(floor_friction_), add_area(patch.outline)});
  }
  for (const arenas::PaperSheet& sheet : arena.sheets) sheets_.push_back({sheet.friction, add_area(sheet.outline)});
  for (const arenas::Riser& riser : arenas::risers(arena)) {
    const double gap_a = riser.high_a - riser.low_a;
    const double gap_b = riser.high_b - riser.low_b;
    if (std::min(gap_a, gap_b) > climbable_step) continue;  // no wheel gets up anywhere along it
    const double length = std::hypot(riser.b.x - riser.a.x, riser.b.y - riser.a.y);
    chamfers_.push_back({riser.a.x, riser.a.y, (riser.b.x - riser.a.x) / length, (riser.b.y - riser.a.y) / length,
                         length, riser.high_a, (riser.high_b - riser.high_a) / length});
  }
  build_buckets(arena);
}

Terrain::Area Terrain::add_area(const arenas::Outline& outline) {
  Area area{static_cast<std::uint32_t>(half_planes_.size()), static_cast<std::uint32_t>(outline.size())};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TPoint2D& a = outline[i];
    const TPoint2D& b = outline[(i + 1) % outline.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double nx = (b.y - a.y) / length;
    const double ny = -(b.x - a.x) / length;
    half_planes_.push_back({nx, ny, nx * a.x + ny * a.y + kEdge});
  }
  return area;
}

bool Terrain::contains(const Area& area, const TPoint2D& p) const {
  for (std::uint32_t i = area.first; i < area.first + area.count; ++i) {
    const HalfPlane& h = half_planes_[i];
    if (h.nx * p.x + h.ny * p.y > h.c) return false;
  }
  return true;
}

bool Terrain::covers(const Area& area, double x0, double y0, double x1, double y1) const {
  return contains(area, {x0, y0}) && contains(area, {x1, y0}) && contains(area, {x1, y1}) && contains(area, {x0, y1});
}

void Terrain::build_buckets(const arenas::Arena& arena) {
  std::vector<Box> patches, sheets, chamfers;
  Box all{0.0, 0.0, 0.0, 0.0};
  for (const arenas::FloorPatch& patch : arena.floor) {
    const Box box = box_of(patch.outline);
    if (patches.empty()) all = box;
    all = {std::min(all.x0, box.x0), std::min(all.y0, box.y0), std::max(all.x1, box.x1), std::max(all.y1, box.y1)};
    patches.push_back(box);
  }
  for (const arenas::PaperSheet& sheet : arena.sheets) sheets.push_back(box_of(sheet.outline));
  for (const Chamfer& c : chamfers_) {
    const double bx = c.ax + c.ux * c.length;
    const double by = c.ay + c.uy * c.length;
    chamfers.push_back({std::min(c.ax, bx) - reach_, std::min(c.ay, by) - reach_, std::max(c.ax, bx) + reach_,
                        std::max(c.ay, by) + reach_});
  }

  GridFrame frame;
  frame.resolution = kBucket;
  frame.x0 = all.x0 - kBucket;
  frame.y0 = all.y0 - kBucket;
  frame.width = static_cast<int>(std::ceil((all.x1 - frame.x0) / kBucket)) + 1;
  frame.height = static_cast<int>(std::ceil((all.y1 - frame.y0) / kBucket)) + 1;
  buckets_ = Grid<Bucket>(frame);
  const Lists by_patch = distribute(patches, frame);
  const Lists by_sheet = distribute(sheets, frame);
  const Lists by_chamfer = distribute(chamfers, frame);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    Bucket& b = buckets_.cells()[i];
    b = {by_patch.start[i],
         by_patch.start[i + 1],
         by_sheet.start[i],
         by_sheet.start[i + 1],
         by_chamfer.start[i],
         by_chamfer.start[i + 1],
         false};
    if (b.patches_end != b.patches + 1) continue;
    const Cell cell{static_cast<int>(i) % frame.width, static_cast<int>(i) / frame.width};
    const TPoint2D c = frame.centre(cell);
    const double half = 0.5 * kBucket - kTouch;
    b.one_patch = covers(patches_[by_patch.list[b.patches]].area, c.x - half, c.y - half, c.x + half, c.y + half);
  }
  patch_lists_ = by_patch.list;
  sheet_lists_ = by_sheet.list;
  chamfer_lists_ = by_chamfer.list;
}

const Terrain::Bucket* Terrain::bucket(const TPoint2D& p) const {
  const Cell cell = buckets_.cell(p);
  return buckets_.inside(cell) ? &buckets_[cell] : nullptr;
}

Ground Terrain::floor(const Bucket& bucket, const TPoint2D& p) const {
  Ground ground{0.0, 0.0, 0.0, floor_friction_, false};
  bool found = false;
  for (std::uint32_t i = bucket.patches; i < bucket.patches_end; ++i) {
    const Patch& patch = patches_[patch_lists_[i]];
    const double z = patch.c + patch.gx * p.x + patch.gy * p.y;
    if (found && z <= ground.height) continue;
    if (!bucket.one_patch && !contains(patch.area, p)) continue;
    ground.height = z;
    ground.gx = patch.gx;
    ground.gy = patch.gy;
    ground.friction = patch.friction;
    found = true;
  }
  for (std::uint32_t i = bucket.sheets; i < bucket.sheets_end; ++i) {
    const Sheet& sheet = sheets_[sheet_lists_[i]];
    if (!contains(sheet.area, p)) continue;
    ground.friction = ground.on_sheet ? std::min(ground.friction, sheet.friction) : sheet.friction;
    ground.on_sheet = true;
  }
  return ground;
}

Ground Terrain::at(const TPoint2D& p) const {
  const Bucket* b = bucket(p);
  return b != nullptr ? floor(*b, p) : Ground{0.0, 0.0, 0.0, floor_friction_, false};
}

Ground Terrain::under_wheel(const TPoint2D& p) const {
  const Bucket* b = bucket(p);
  if (b == nullptr) return Ground{0.0, 0.0, 0.0, floor_friction_, false};
  Ground ground = floor(*b, p);
  const double floor_height = ground.height;
  for (std::uint32_t i = b->chamfers; i < b->chamfers_end; ++i) {
    const Chamfer& c = chamfers_[chamfer_lists_[i]];
    const double along = c.ux * (p.x - c.ax) + c.uy * (p.y - c.ay);
    const double s = std::clamp(along, 0.0, c.length);
    const double edge = c.high + c.slope * s;
    if (edge - floor_height > reach_) continue;  // this part of the step is too high: a barrier
    const double dx = c.ax + c.ux * s - p.x;     // towards the edge
    const double dy = c.ay + c.uy * s - p.y;
    if (c.ux * dy - c.uy * dx < 0.0) continue;  // on the high side
    const double distance = std::hypot(dx, dy);
    const double z = edge - distance;
    if (z <= ground.height || distance < kEdge) continue;
    ground.height = z;
    ground.gx = dx / distance + (along == s ? c.slope * c.ux : 0.0);
    ground.gy = dy / distance + (along == s ? c.slope * c.uy : 0.0);
  }
  return ground;
}

}  // namespace rubble::sim
