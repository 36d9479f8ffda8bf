#include "scoring/maps/colours/half_width.h"

#include <opencv2/imgproc.hpp>

namespace rubble::scoring {

double mean_half_width(const cv::Mat& mask) {
  cv::Mat depth;
  cv::distanceTransform(mask, depth, cv::DIST_L2, 3);
  return cv::mean(depth, mask)[0];
}

}  // namespace rubble::scoring
