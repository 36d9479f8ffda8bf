#pragma once

#include <mrpt/maps/CSimplePointsMap.h>

#include <cstdint>
#include <vector>

namespace rubble::slam {

/// The points a scan is matched with. Gives CICP the same pairs as its base class, which looks them up in a kd-tree,
/// but from buckets of a raster: the scans change ten times a second and lie within centimetres of each other, so that
/// the tree costs more to build and to search than the whole rest of the ICP.
class MatchTarget : public mrpt::maps::CSimplePointsMap {
 public:
  /// Sorts the points into buckets; to be called when all are inserted, before the first match.
  void index();

  /// For each point of `other`, moved by `other_pose`, the closest point of this map that is nearer than
  /// params.maxDistForCorrespondence. Other members of `params` must have CICP's plain values (no angular distance, no
  /// decimation, no unique pairs): throws std::invalid_argument else.
  void determineMatching2D(const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose2D& other_pose,
                           mrpt::tfest::TMatchingPairList& pairs, const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& result) const override;

 private:
  struct Point {
    float x;
    float y;
    std::uint32_t index;
  };
  struct Nearest {
    float square;  ///< of the distance [m^2]
    const Point* point = nullptr;
  };
  int column(float x) const;
  int row(float y) const;
  Nearest nearest(float x, float y, float reach) const;
  void search_row(int y, int first, int last, float px, float py, Nearest& best) const;

  float x0_ = 0.0f;
  float y0_ = 0.0f;
  float inverse_edge_ = 1.0f;  ///< 1 / edge of a bucket [1/m]
  float edge_ = 1.0f;
  int width_ = 0;
  int height_ = 0;
  std::vector<Point> points_;         ///< bucket by bucket, row by row
  std::vector<std::uint32_t> first_;  ///< of each bucket in points_; one more at the end
};

}  // namespace rubble::slam
