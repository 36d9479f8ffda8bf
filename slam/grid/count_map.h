#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "base/angle.h"
#include "base/grid.h"
#include "base/large_pages.h"
#include "slam/grid/bit_raster.h"
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
  std::uint16_t seen(Cell c) const { return seen_[frame_.index(c)]; }
  std::uint16_t occupied(Cell c) const { return occupied_[frame_.index(c)]; }
  /// Row `y` of the planes: frame().width counts, for code that reads many cells.
  const std::uint16_t* seen_row(int y) const { return seen_.data() + frame_.index({0, y}); }
  const std::uint16_t* occupied_row(int y) const { return occupied_.data() + frame_.index({0, y}); }
  /// p_occ = occupied / seen (eq. 1); 0 for unseen cells and outside.
  double p_occ(Cell c) const;
  /// p_occ in 1/255, 0 where unseen: the plane the particle weights read.
  const std::uint8_t* p_occ_plane() const { return p_occ_.data(); }

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
  /// Calls `count` with the first cell and the end of each run of passed cells.
  template <class Count>
  void each_pass(const Count& count);
  void make_room(std::size_t cell);
  void rate(std::size_t cell);

  GridFrame frame_;
  int max_cells_;
  LargeVector<std::uint16_t> seen_;  // each time the map grows these are new memory
  LargeVector<std::uint16_t> occupied_;
  LargeVector<std::uint8_t> p_occ_;
  std::uint64_t version_ = 0;
  std::uint64_t dropped_hits_ = 0;
  BitRaster passed_;           ///< work space of stamp(); windows begin at whole words, so that two can be compared
  BitRaster hit_;              ///< work space of stamp()
  BitRaster passed_later_;     ///< work space of restamp()
  BitRaster hit_later_;        ///< work space of restamp()
  std::vector<ScanRay> rays_;  ///< work space of stamp()
};

}  // namespace rubble::slam
