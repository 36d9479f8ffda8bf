#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "slam/grid/count_map.h"
#include "slam/robust/graph/key_frames.h"
#include "slam/robust/map/packed_scan.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// A count map that can follow its scans: each hangs on a key frame, and is taken out and stamped anew when that moves.
class StampedMap {
 public:
  struct Entry {
    int frame;
    mrpt::math::TPose2D T_frame_base;
    mrpt::math::TPose2D T_map_base;  ///< where it is stamped
    PackedScan scan;
  };

  StampedMap(CountMap map, const mrpt::math::TPose3D& T_base_laser, const LevelScanConfig& config);

  const CountMap& map() const { return map_; }
  std::size_t scans() const { return scans_.size(); }
  const std::vector<Entry>& entries() const { return scans_; }
  /// Stamps a scan taken at T_frame_base from a key frame.
  void add(const KeyFrames& frames, int frame, const mrpt::math::TPose2D& T_frame_base, PackedScan scan, Work* work);
  /// Lays the raster so that walls along its axes fall into the middle of cells, as far as key frames tell where those
  /// are: a wall on the border of two cells fills both. Everything is stamped anew where the raster moves by more than
  /// a tenth of a cell.
  void lay_raster(const KeyFrames& frames);
  /// Thins the walls of the map, once no more scans come.
  void thin();
  /// Takes what is no longer there off the map (gone_things.h), once no more scans come.
  void drop_gone();
  /// Says that key frames have moved.
  void moved() { to_check_ = scans_.size(); }
  /// Stamps scans anew that lie wrong by a good part of a cell, newest first, until the budget is used up.
  void work(const KeyFrames& frames, Work& budget);
  /// The same at once, and to a smaller part of a cell.
  void set_right(const KeyFrames& frames);
  bool settled() const { return to_check_ == 0; }

 private:
  bool lies_wrong(const Entry& entry, const mrpt::math::TPose2D& T_map_base) const;
  ScanPoints raw_points(const PackedScan& scan);
  ScanPoints points_of(const PackedScan& scan);
  Work effort(const Entry& entry) const;

  CountMap map_;
  LevelScan level_scan_;
  std::vector<Entry> scans_;
  double tolerance_;          ///< [cells]
  std::size_t to_check_ = 0;  ///< scans below are still to be looked at
};

}  // namespace rubble::slam
