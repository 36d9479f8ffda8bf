#include "scoring/pose_score.h"

namespace rubble::scoring {

MapScore score_at(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                  const ScoreConfig& config) {
  MapScore out = score_at_pose(map, truth, T_truth_map, config);
  out.note = "pose given, not searched" + (out.note.empty() ? "" : "; " + out.note);
  return out;
}

OccupancyGrid scaled_frame(const OccupancyGrid& map, double factor) {
  GridFrame frame = map.frame();
  frame.resolution *= factor;
  frame.x0 *= factor;
  frame.y0 *= factor;
  return with_frame(map, frame);
}

}  // namespace rubble::scoring
