#pragma once

#include <mrpt/math/TPose3D.h>

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "slam/robust/graph/key_frames.h"
#include "slam/robust/map/packed_scan.h"

namespace rubble::slam {

/// A scan of the map: where it was taken, seen from a key frame, and what it saw.
struct SavedScan {
  int frame = 0;
  mrpt::math::TPose2D T_frame_base;
  PackedScan scan;
};

/// A map of the robust mapper, with all that is needed to go on with it: the key frames with their graph, and the scans
/// from which the counts are made anew.
struct SavedMap {
  mrpt::math::TPose3D T_base_laser;  ///< of the robot that made it
  KeyFrames frames;
  std::vector<SavedScan> scans;
  // Where the robot was at the end.
  int here = 0;  ///< the key frame that it hung on
  mrpt::math::TPose2D T_frame_base;
  double path = 0.0;                                           ///< up to that key frame [m]
  Eigen::Matrix3d frame_covariance = Eigen::Matrix3d::Zero();  ///< of that key frame, in the map
  Eigen::Matrix3d scan_covariance = Eigen::Matrix3d::Zero();   ///< of T_frame_base, along the frame's axes

  mrpt::math::TPose2D end() const { return frames.pose(here) + T_frame_base; }
};

/// The bytes of a map file; docs/slam.md describes them. The same map gives the same bytes.
std::string encode_map(const SavedMap& map);
/// Takes them back. Throws InputError in one line that begins with `name`: not such a file, of another version, cut,
/// or damaged.
SavedMap decode_map(std::string_view bytes, const std::string& name);

}  // namespace rubble::slam
