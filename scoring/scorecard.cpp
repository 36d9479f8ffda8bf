#include "scoring/scorecard.h"

#include <cmath>

#include "scoring/alignment.h"
#include "scoring/overlap.h"
#include "scoring/psi.h"
#include "scoring/resample.h"

namespace rubble::scoring {
namespace {

constexpr double kCanvasMargin = 1.0;  // unknown cells around both maps when psi is taken [m]

double known_share(const OccupancyGrid& map, const OccupancyGrid& truth) {
  std::size_t known = 0;
  std::size_t total = 0;
  for (std::size_t i = 0; i < truth.cells().size(); ++i) {
    if (truth.cells()[i] == Occupancy::Unknown) continue;
    ++total;
    if (map.cells()[i] != Occupancy::Unknown) ++known;
  }
  return total == 0 ? 0.0 : static_cast<double>(known) / static_cast<double>(total);
}

void fill_psi(MapScore& out, const Psi& psi) {
  out.psi_m = psi.mean;
  out.psi_literal_m = psi.literal;
  out.psi_occupied_map_m = psi.occupied.map_to_truth;
  out.psi_occupied_truth_m = psi.occupied.truth_to_map;
  out.psi_free_map_m = psi.free.map_to_truth;
  out.psi_free_truth_m = psi.free.truth_to_map;
}

/// Without a pose no class has a counterpart.
Psi psi_of_strangers(double cap) {
  const PsiClass absent{cap, cap};
  return {absent, absent, absent, 6.0 * cap, cap};
}

}  // namespace

MapScore score_map(const OccupancyGrid& map, const OccupancyGrid& truth, const ScoreConfig& config) {
  MapScore out;
  const OccupancyGrid map_known = crop_to_known(map, 0.0);
  const OccupancyGrid truth_known = crop_to_known(truth, 0.0);
  const Alignment alignment = align(map_known, truth_known);
  out.aligned = alignment.aligned;
  out.note = alignment.note;
  out.T_truth_map = alignment.T_truth_map;
  out.runner_up = alignment.runner_up;
  if (!out.aligned) {
    fill_psi(out, psi_of_strangers(config.colour_absent_cap));
    return out;
  }
  Overlap walls = overlap(map_known, truth_known, out.T_truth_map, config.tau);
  if (const Overlap drawn = overlap(map_known, truth_known, alignment.T_walls, config.tau); drawn.score > walls.score) {
    walls = drawn;
    out.T_truth_map = alignment.T_walls;
  }
  out.precision = walls.precision;
  out.recall = walls.recall;
  out.score = walls.score;
  const GridFrame frame = common_frame(map_known, truth_known, out.T_truth_map, kCanvasMargin);
  const OccupancyGrid map_on_frame = resample(map_known, out.T_truth_map, frame);
  const OccupancyGrid truth_on_frame = resample(truth_known, {}, frame);
  fill_psi(out, psi(map_on_frame, truth_on_frame, config.colour_absent_cap));
  out.known = known_share(map_on_frame, truth_on_frame);
  return out;
}

}  // namespace rubble::scoring
