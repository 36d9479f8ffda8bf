#include "scoring/proposals/features.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "base/angle.h"
#include "scoring/proposals/surf.h"
#include "scoring/walls/resample.h"

namespace rubble::scoring {
namespace {

constexpr unsigned char kGrey[] = {150, 255, 0};  // unknown, free, occupied
constexpr double kMargin = 2.0;                   // unknown around the map, so that features at its rim are found [m]

/// The grid as an image whose rows run north, so that angles count as in the map's frame.
cv::Mat draw(const OccupancyGrid& grid) {
  cv::Mat image(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < grid.height(); ++y)
    std::transform(grid.row(y), grid.row(y) + grid.width(), image.ptr(y),
                   [](Occupancy o) { return kGrey[static_cast<std::size_t>(o)]; });
  return image;
}

/// Strongest first; of equals, in the order of the image.
void sort_by_strength(std::vector<cv::KeyPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    if (a.response != b.response) return a.response > b.response;
    if (a.pt.y != b.pt.y) return a.pt.y < b.pt.y;
    return a.pt.x < b.pt.x;
  });
}

std::vector<cv::KeyPoint> opencv_points(cv::Feature2D& method, const cv::Mat& image, std::size_t max_points,
                                        cv::Mat& descriptors) {
  std::vector<cv::KeyPoint> points;
  method.detect(image, points);
  sort_by_strength(points);
  if (points.size() > max_points) points.resize(max_points);
  method.compute(image, points, descriptors);
  return points;
}

}  // namespace

const char* name_of(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::Surf:
      return "SURF";
    case FeatureKind::Akaze:
      return "AKAZE";
    case FeatureKind::Orb:
      return "ORB";
  }
  return "";
}

FeatureSet find_features(const OccupancyGrid& grid, FeatureKind kind, const FeatureConfig& config) {
  FeatureSet out;
  out.kind = kind;
  const std::optional<GridFrame> known = known_frame(grid, kMargin);
  if (!known) return out;
  GridFrame frame = *known;
  frame.resolution = config.cell;
  frame.width = static_cast<int>(std::ceil(known->width * known->resolution / config.cell));
  frame.height = static_cast<int>(std::ceil(known->height * known->resolution / config.cell));
  cv::Mat image = draw(resample(grid, {}, frame));
  cv::GaussianBlur(image, image, {}, config.blur / config.cell);

  std::vector<cv::KeyPoint> points;
  if (kind == FeatureKind::Surf) {
    points = surf_points(image, config.max_features, out.descriptors);
  } else if (kind == FeatureKind::Akaze) {
    points = opencv_points(*cv::AKAZE::create(), image, config.max_features, out.descriptors);
  } else {
    // ORB's patch of 31 pixels is too small for rooms: start from a pyramid that goes up to 3.6 times the size.
    const int wanted = static_cast<int>(2 * config.max_features);
    points = opencv_points(*cv::ORB::create(wanted, 1.2F, 8), image, config.max_features, out.descriptors);
  }
  for (const cv::KeyPoint& point : points)
    out.features.push_back({{frame.x0 + (static_cast<double>(point.pt.x) + 0.5) * config.cell,
                             frame.y0 + (static_cast<double>(point.pt.y) + 0.5) * config.cell},
                            static_cast<double>(point.size) * config.cell,
                            deg_to_rad(static_cast<double>(point.angle))});
  return out;
}

double descriptor_distance(const FeatureSet& a, std::size_t i, const FeatureSet& b, std::size_t j) {
  const cv::Mat row_a = a.descriptors.row(static_cast<int>(i));
  const cv::Mat row_b = b.descriptors.row(static_cast<int>(j));
  if (a.binary()) return cv::norm(row_a, row_b, cv::NORM_HAMMING) / (8.0 * row_a.cols);
  return cv::norm(row_a, row_b, cv::NORM_L2);
}

}  // namespace rubble::scoring
