#include "scoring/proposals/surf.h"

#include <dlib/image_keypoint.h>
#include <dlib/opencv.h>

#include <algorithm>

#include "base/angle.h"

namespace rubble::scoring {
namespace {

constexpr double kThreshold = 30.0;  // of the Hessian's determinant; dlib's own choice
constexpr double kBox = 20.0;        // edge of the descriptor's box, in scales (Bay 2006, section 4)

}  // namespace

std::vector<cv::KeyPoint> surf_points(const cv::Mat& image, std::size_t max_points, cv::Mat& descriptors) {
  const dlib::cv_image<unsigned char> view(image);
  std::vector<dlib::surf_point> points = dlib::get_surf_points(view, static_cast<long>(10 * max_points), kThreshold);
  std::stable_sort(points.begin(), points.end(),
                   [](const dlib::surf_point& a, const dlib::surf_point& b) { return a.p.score > b.p.score; });
  if (points.size() > max_points) points.resize(max_points);
  std::vector<cv::KeyPoint> out;
  descriptors.create(static_cast<int>(points.size()), 64, CV_32F);
  for (const dlib::surf_point& s : points) {
    float* const row = descriptors.ptr<float>(static_cast<int>(out.size()));
    for (long i = 0; i < 64; ++i) row[i] = static_cast<float>(s.des(i));
    out.emplace_back(static_cast<float>(s.p.center.x()), static_cast<float>(s.p.center.y()),
                     static_cast<float>(kBox * s.p.scale), static_cast<float>(rad_to_deg(s.angle)),
                     static_cast<float>(s.p.score));
  }
  return out;
}

}  // namespace rubble::scoring
