#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/angle.h"
#include "base/grid.h"
#include "slam/grid/bit_raster.h"
#include "slam/grid/count_tiles.h"
#include "slam/grid/scan_polygon.h"

namespace rubble::slam {

/// The end points of one scan, in the frame of its stamping pose (usually T_map_base).
struct ScanPoints {
  std::vector<mrpt::math::TPoint2D> hits;    ///< returns [m]
  std::vector<mrpt::math::TPoint2D> passes;  ///< ends of rays that met nothing: free up to there, no hit
  mrpt::math::TPoint2D origin;               ///< where the rays start (the laser)
  double beam_width = deg_to_rad(1.0);       ///< angle between neighbouring beams [rad]
  /// Hits and passes together, counter-clockwise around the origin, one turn at most. May be left empty by who does not
  /// know the beams: the ends are then sorted by bearing and joined where they lie closer than 1.5 beam widths.
  std::vector<ScanRay> rays;
  std::vector<int> floor_beams;  ///< numbers of beams left out because they met the floor, ascending
};

/// The paper's occupancy map, section III.B: one plane counts how often a cell was seen, one how often it was occupied.
/// Grows in whole blocks when a scan reaches over its edge, up to `max_cells` a side; what lies farther is dropped.
class CountMap {
 public:
  /// Centred on the origin of the map frame. Throws std::invalid_argument when a size or the resolution is not
  /// positive.
  CountMap(int width, int height, double resolution, int max_cells = 8000);

  const GridFrame& frame() const { return frame_; }
  std::uint16_t seen(Cell c) const { return tiles_.of(c).seen[CountTiles::place(c)]; }
  std::uint16_t occupied(Cell c) const { return tiles_.of(c).occupied[CountTiles::place(c)]; }
  /// Calls `use(x, count, seen, occupied)` with each stretch of `count` cells from column `x` on, west to east, of row
  /// `y` between columns `from` and `to` where anything may have been seen, and with their counts.
  template <class Use>
  void for_seen(int y, int from, int to, const Use& use) const;
  /// p_occ = occupied / seen (eq. 1); 0 for unseen cells and outside.
  double p_occ(Cell c) const;
  /// p_occ in 1/255, 0 where unseen.
  std::uint8_t p_occ_255(Cell c) const { return tiles_.of(c).p_occ[CountTiles::place(c)]; }
  /// Where the particle weights read it.
  const CountTiles& tiles() const { return tiles_; }

  /// Stamps a scan taken at T_map_base: each touched cell counts once; a cell hit in this scan is not freed by its
  /// other beams. A cell is touched when it holds a hit, or when its centre lies inside the scan polygon and no surface
  /// runs through it between two neighbouring hits (scan_polygon.h). Counts that would overflow are halved, both planes
  /// alike.
  void stamp(const mrpt::math::TPose2D& T_map_base, const ScanPoints& scan);
  /// Takes back what stamp() at one pose counted (but for counts that were halved since) and stamps at another, for the
  /// price of the cells that differ.
  void restamp(const mrpt::math::TPose2D& T_map_before, const mrpt::math::TPose2D& T_map_base, const ScanPoints& scan);
  /// Cells of the window that the last of these two drew in: what it cost, beside the beams.
  std::size_t drawn_cells() const;

  /// Takes over a whole map that was counted elsewhere; both planes are frame.size() counts, row-major. Throws
  /// std::invalid_argument when a plane has another size, the frame is empty, or a cell was occupied more often than
  /// seen.
  void assign(const GridFrame& frame, const std::vector<std::uint16_t>& seen,
              const std::vector<std::uint16_t>& occupied);

  /// Makes cells free that were hit: their hits no longer count.
  void clear_hits(const std::vector<Cell>& cells);

  /// Unknown where never seen; occupied where p_occ >= threshold, free elsewhere.
  OccupancyGrid classify(double threshold = 0.5) const;

  /// Forgets all; the raster then lies (dx, dy) metres further.
  void begin_anew(double dx, double dy);

  /// Rises with every stamp or assignment; tells readers that cached results are old.
  std::uint64_t version() const { return version_; }
  /// Hits that lay beyond `max_cells` and were not mapped, since the start.
  std::uint64_t dropped_hits() const { return dropped_hits_; }

 private:
  /// Draws the scan into `rays_` (in cells) and `passed_`; false when all of it lies beyond the largest map.
  bool draw(const mrpt::math::TPose2D& T_map_base, const ScanPoints& scan);
  void grow_to_hold(const mrpt::math::TPoint2D& low, const mrpt::math::TPoint2D& high);
  /// Calls `count` with each hit cell once, and takes these out of `passed_`; returns the hits beyond the map.
  template <class Count>
  std::uint64_t each_hit(const Count& count);
  /// Calls `count` with each word of passed cells: their tile, where its first cell lies in it, and the bits.
  template <class Count>
  void each_pass(const Count& count);

  GridFrame frame_;
  int max_cells_;
  CountTiles tiles_;
  std::uint64_t version_ = 0;
  std::uint64_t dropped_hits_ = 0;
  BitRaster passed_;           ///< work space of stamp(); windows begin at whole words, so that two can be compared
  BitRaster hit_;              ///< work space of stamp()
  BitRaster passed_later_;     ///< work space of restamp()
  BitRaster hit_later_;        ///< work space of restamp()
  std::vector<ScanRay> rays_;  ///< work space of stamp()
};

template <class Use>
void CountMap::for_seen(int y, int from, int to, const Use& use) const {
  for (int x = from; x < to;) {
    const int end = std::min(to, (x / CountTiles::kSide + 1) * CountTiles::kSide);
    if (const CountTiles::Tile* const tile = tiles_.counted({x, y})) {
      const std::size_t first = CountTiles::place({x, y});
      use(x, end - x, &tile->seen[first], &tile->occupied[first]);
    }
    x = end;
  }
}

}  // namespace rubble::slam
