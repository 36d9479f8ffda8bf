#include "scoring/measures/detached.h"

#include <opencv2/imgproc.hpp>
#include <vector>

namespace rubble::scoring {
namespace {

constexpr double kLegend = 0.1;

}  // namespace

double detached_share(const OccupancyGrid& map, const OccupancyGrid& truth, const PlanarTransform& T_truth_map) {
  if (map.cells().empty()) return 0.0;
  cv::Mat known(map.height(), map.width(), CV_8U);
  for (std::size_t i = 0; i < map.cells().size(); ++i) known.data[i] = map.cells()[i] != Occupancy::Unknown ? 255 : 0;
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int pieces = cv::connectedComponentsWithStats(known, labels, stats, centres, 8);
  std::vector<bool> touches(static_cast<std::size_t>(pieces), false);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const auto piece = static_cast<std::size_t>(labels.at<int>(y, x));
      if (piece == 0 || touches[piece]) continue;
      const Cell c = truth.cell(T_truth_map(map.centre({x, y})));
      touches[piece] = truth.inside(c) && truth[c] != Occupancy::Unknown;
    }
  const auto area = [&](int piece) { return static_cast<double>(stats.at<int>(piece, cv::CC_STAT_AREA)); };
  double here = 0.0;
  for (int i = 1; i < pieces; ++i) here += touches[static_cast<std::size_t>(i)] ? area(i) : 0.0;
  double away = 0.0;
  for (int i = 1; i < pieces; ++i)
    away += !touches[static_cast<std::size_t>(i)] && area(i) >= kLegend * here ? area(i) : 0.0;
  return here + away > 0.0 ? away / (here + away) : 0.0;
}

}  // namespace rubble::scoring
