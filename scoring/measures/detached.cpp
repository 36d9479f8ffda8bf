#include "scoring/measures/detached.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "scoring/measures/sight.h"

namespace rubble::scoring {
namespace {

constexpr double kLegend = 0.1;  // of what lies on the truth: less is a legend or specks

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
  // Strips of unknown ground do not make many small pieces of a drawing, as they do not hide walls on the truth.
  cv::Mat apart = cv::Mat::zeros(known.size(), CV_8U);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const int piece = labels.at<int>(y, x);
      if (piece > 0 && !touches[static_cast<std::size_t>(piece)]) apart.at<unsigned char>(y, x) = 255;
    }
  const int reach = static_cast<int>(std::ceil(0.5 * kNarrowUnknown / map.resolution()));
  cv::Mat grown, groups;
  cv::dilate(apart, grown, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  std::vector<double> areas(static_cast<std::size_t>(cv::connectedComponents(grown, groups, 8)), 0.0);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (apart.at<unsigned char>(y, x) != 0) areas[static_cast<std::size_t>(groups.at<int>(y, x))] += 1.0;
  double away = 0.0;
  for (const double group : areas) away += group >= kLegend * here ? group : 0.0;
  return here + away > 0.0 ? away / (here + away) : 0.0;
}

}  // namespace rubble::scoring
