#include "scoring/maps/canvas_corners.h"

#include <opencv2/imgproc.hpp>

#include "base/grid.h"

namespace rubble::scoring {
namespace {

constexpr double kBorderUnknown = 0.95;  // share of the region's rim that must be unknown
constexpr double kBroad = 4.0;           // half width of the region [pixels]: thinner ones are walls at the border

bool is_canvas(const cv::Mat& region, const cv::Mat& classes) {
  cv::Mat padded;
  cv::copyMakeBorder(region, padded, 1, 1, 1, 1, cv::BORDER_REPLICATE);
  cv::Mat inner;
  cv::distanceTransform(padded, inner, cv::DIST_L2, 3);
  double broadest = 0.0;
  cv::minMaxLoc(inner, nullptr, &broadest);
  if (broadest < kBroad) return false;
  cv::Mat rim;
  cv::dilate(region, rim, cv::Mat::ones(5, 5, CV_8U));
  rim &= ~region;
  // The first ring holds the interpolated edge; judge by what lies one pixel further out.
  cv::Mat first;
  cv::dilate(region, first, cv::Mat::ones(3, 3, CV_8U));
  rim &= ~first;
  const int total = cv::countNonZero(rim);
  if (total == 0) return false;
  const int unknown = cv::countNonZero(rim & (classes == static_cast<int>(Occupancy::Unknown)));
  return unknown >= kBorderUnknown * total;
}

}  // namespace

void clear_canvas_corners(cv::Mat& classes) {
  const auto unknown = static_cast<unsigned char>(Occupancy::Unknown);
  if (classes.empty()) return;
  const cv::Point corners[4] = {
      {0, 0}, {classes.cols - 1, 0}, {0, classes.rows - 1}, {classes.cols - 1, classes.rows - 1}};
  for (const cv::Point& corner : corners) {
    if (classes.at<unsigned char>(corner) == unknown) continue;
    cv::Mat mask = cv::Mat::zeros(classes.rows + 2, classes.cols + 2, CV_8U);
    cv::floodFill(classes, mask, corner, cv::Scalar(), nullptr, cv::Scalar(), cv::Scalar(),
                  4 | cv::FLOODFILL_MASK_ONLY | (255 << 8));
    // A copy: filters look beyond a part of an image, and flood fill writes a border into its mask.
    const cv::Mat region = mask(cv::Rect(1, 1, classes.cols, classes.rows)).clone();
    if (!is_canvas(region, classes)) continue;
    cv::Mat grown;
    cv::dilate(region, grown, cv::Mat::ones(3, 3, CV_8U));
    classes.setTo(unknown, grown);
  }
}

}  // namespace rubble::scoring
