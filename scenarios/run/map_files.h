#pragma once

#include <mrpt/math/TPose2D.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/trajectory.h"
#include "scenarios/run/run_folder.h"
#include "slam/map_base.h"
#include "slam/map_exports.h"
#include "slam/mapper.h"

namespace rubble::scenarios {

/// Stamps stay what they are.
slam::StampName as_measured();

/// Writes what a mapper keeps beside the pictures of its map: map.rmap, the map with its graph; scans.csv, what it made
/// of each scan; scans.png, a picture of that; loops.csv, and loops.png where any was found. A mapper that keeps none
/// leaves none. `name`: what both tables call a scan's stamp.
void save_map_files(const RunFolder& folder, const slam::Mapper& mapper, const slam::StampName& name = as_measured());

/// Reads the map of a run folder, or a map file. Throws InputError.
std::shared_ptr<const slam::MapBase> load_map_base(const std::string& path, bool grows,
                                                   const std::optional<mrpt::math::TPose2D>& start);

/// Writes a map's graph for g2o (`.g2o`), or its scans with their poses for MRPT (`.simplemap`): raw scans as they were
/// measured, without the motion and tilt that our own map takes out. Throws InputError for another ending, RunError
/// when the file cannot be written.
void export_map(const std::string& path, const std::string& out);

/// How the maps of two runs were laid on each other.
struct MergeReport {
  mrpt::math::TPose2D T_first_start;  ///< where the second run began
  double common_m = 0.0;              ///< of the second one's way, within 1 m of where the first one was [m]
  double second_m = 0.0;              ///< all of it [m]
  bool same = false;                  ///< both maps are the same bytes
  bool has_way = false;               ///< the folder has the way of both runs (merged_way)
};

/// The key frames of two maps in the order of their time, with `of_first` scans of the first one before those of the
/// second; nothing where the one drive went on while the other one did: what lies between two poses is then no way.
std::optional<Trajectory> merged_way(const std::vector<slam::MapScan>& both, std::size_t of_first);

/// Makes one map of those of two runs, in the frame of the first, and writes it into a folder of its own: map.rmap and
/// the pictures; estimate.tum holds the merged_way(), or only says why not. `out`, `replace`: as of RunFolder, which is
/// made when the maps are one. `progress`: what is done, and how far it is. Throws InputError when one of them is
/// damaged, they have too little in common, are of two arenas, or their lasers were mounted differently.
MergeReport merge_maps(const std::string& first, const std::string& second, const Scenario& scenario,
                       const std::string& out, bool replace, const slam::MergeProgress& progress = {});

/// Whether export_map() knows the ending of that name.
bool is_map_export(const std::string& out);

}  // namespace rubble::scenarios
