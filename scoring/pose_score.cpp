#include "scoring/pose_score.h"

#include "scoring/overlap.h"
#include "scoring/psi.h"
#include "scoring/resample.h"

namespace rubble::scoring {
namespace {

constexpr double kCanvasMargin = 1.0;  // unknown cells around both maps when psi is taken, as in score_map [m]

}  // namespace

MapScore score_at(const OccupancyGrid& map, const OccupancyGrid& truth, const mrpt::math::TPose2D& T_truth_map,
                  const ScoreConfig& config) {
  const OccupancyGrid map_known = crop_to_known(map, 0.0);
  const OccupancyGrid truth_known = crop_to_known(truth, 0.0);
  MapScore out;
  out.aligned = true;
  out.note = "pose given, not searched";
  out.T_truth_map = T_truth_map;
  const Overlap walls = overlap(map_known, truth_known, T_truth_map, config.tau);
  out.precision = walls.precision;
  out.recall = walls.recall;
  out.score = walls.score;
  const GridFrame frame = common_frame(map_known, truth_known, T_truth_map, kCanvasMargin);
  const OccupancyGrid map_on_frame = resample(map_known, T_truth_map, frame);
  const OccupancyGrid truth_on_frame = resample(truth_known, {}, frame);
  const Psi figures = psi(map_on_frame, truth_on_frame, config.colour_absent_cap);
  out.psi_m = figures.mean;
  out.psi_literal_m = figures.literal;
  out.psi_occupied_map_m = figures.occupied.map_to_truth;
  out.psi_occupied_truth_m = figures.occupied.truth_to_map;
  out.psi_free_map_m = figures.free.map_to_truth;
  out.psi_free_truth_m = figures.free.truth_to_map;
  std::size_t both = 0;
  std::size_t total = 0;
  for (std::size_t i = 0; i < truth_on_frame.cells().size(); ++i) {
    if (truth_on_frame.cells()[i] == Occupancy::Unknown) continue;
    ++total;
    if (map_on_frame.cells()[i] != Occupancy::Unknown) ++both;
  }
  out.known = total == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(total);
  return out;
}

OccupancyGrid scaled_frame(const OccupancyGrid& map, double factor) {
  GridFrame frame = map.frame();
  frame.resolution *= factor;
  frame.x0 *= factor;
  frame.y0 *= factor;
  OccupancyGrid out(frame);
  out.cells() = map.cells();
  return out;
}

}  // namespace rubble::scoring
