#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/robust/graph/key_frames.h"
#include "slam/robust/matching/correlator.h"
#include "slam/robust/matching/scan_fit.h"

namespace rubble::slam {

/// What a place must stand before a drive is believed to have been there.
struct PlaceConfig {
  int frames = 40;                   ///< last key frames of the drive that are matched ...
  double path = 6.0;                 ///< ... and the path they cover at most [m]
  double least_score = 0.62;         ///< of the search; true places score 0.74 to 0.92
  double runner_up = 0.90;           ///< another place that scores so much of the best must not stand the tests
  double least_inliers = 0.80;       ///< of the fit
  double most_contradiction = 0.06;  ///< share of points seen through, either way
  double least_supported =
      0.12;  ///< share of points that close key frames of the map saw as well, of all they were asked for
  double least_path = 2.0;         ///< of the drive, but where somebody says where it begins [m]
  int confirmations = 3;           ///< places found that must agree ...
  double apart = 1.0;              ///< ... each after so much more path [m]
  double agree_distance = 0.20;    ///< within this [m]
  double agree_angle = 0.05;       ///< and this [rad]
  double expected_distance = 0.6;  ///< from where the robot is expected, a place is looked for so far [m] ...
  double expected_angle = 0.5;     ///< ... and turned so far [rad] ...
  double expected_path = 5.0;      ///< ... while the drive is no longer than this [m]
};

/// Where a drive lies in a map.
struct FoundPlace {
  mrpt::math::TPose2D T_map_drive;  ///< origin of the drive's own frame
  std::vector<GraphEdge> ties;      ///< from key frames of the map to key frames of the drive
};

struct PlaceCounts {
  std::uint64_t searched = 0;
  std::uint64_t nowhere = 0;       ///< no place scores enough
  std::uint64_t ambiguous = 0;     ///< refused: another place would do as well
  std::uint64_t contradicted = 0;  ///< refused: few inliers, beams through walls, or hardly any overlap
  std::uint64_t believed = 0;      ///< places that passed, before others agreed
};

/// Finds where a drive, mapped for itself, lies in a map made before: its last key frames together are looked for all
/// over the map at any heading (branch and bound, Hess et al. 2016), and a place counts when it has no rival, when
/// neither sees through the other's walls, and when later key frames say the same.
class PlaceFinder {
 public:
  /// `map` must outlive the finder. `surfel_cell`: of the mapper's surfels [m].
  PlaceFinder(const KeyFrames& map, const PlaceConfig& config, double surfel_cell);

  /// Forgets what was found so far, and where the robot was expected.
  void begin();
  /// The same; the drive's origin is expected at T_map_drive. Where somebody says so (`told`), one place found there is
  /// enough.
  void begin_near(const mrpt::math::TPose2D& T_map_drive, bool told);

  /// Asks for a key frame of the drive and those before it, instead of one that waits; `drive` only grows until the
  /// next begin().
  void look(int frame) { newest_ = frame; }
  /// Goes on with the search until it is over or `budget` is used up.
  void work(const KeyFrames& drive, Work& budget);
  /// Once enough places agree; stays until begin().
  const std::optional<FoundPlace>& found() const { return found_; }
  const PlaceCounts& counts() const { return counts_; }

 private:
  void start_search(const KeyFrames& drive, Work& budget);
  void weigh(const KeyFrames& drive, Work& budget);
  std::optional<GraphEdge> judge(const KeyFrames& drive, const mrpt::math::TPose2D& start, Work& budget) const;
  bool contradicted(const KeyFrames& drive, const mrpt::math::TPose2D& T_map_frame,
                    const std::vector<int>& close) const;
  void believe(const KeyFrames& drive, const GraphEdge& tie);
  bool expected(const KeyFrames& drive) const;

  const KeyFrames& map_;
  const PlaceConfig config_;
  const double surfel_cell_;
  SurfelGrid surfels_;  ///< of the whole map
  std::vector<OrientedPoint> map_points_;
  Correlator correlator_;
  mrpt::math::TPose2D middle_;  ///< of the map
  double extent_ = 0.0;         ///< from there to its edges [m]

  RivalSearch search_;
  int newest_ = -1;                    ///< key frame of the drive that waits
  int frame_ = -1;                     ///< that is being looked for
  std::vector<int> frames_;            ///< of the drive, that are matched
  std::vector<OrientedPoint> points_;  ///< theirs, seen from frame_
  std::optional<mrpt::math::TPose2D> T_map_expected_;
  bool told_ = false;
  struct Believed {
    GraphEdge tie;
    mrpt::math::TPose2D T_map_drive;
    double path;  ///< of the drive [m]
  };
  std::vector<Believed> believed_;
  std::optional<FoundPlace> found_;
  PlaceCounts counts_;
};

}  // namespace rubble::slam
