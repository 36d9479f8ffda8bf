#include "scoring/proposals/surf.h"

#include <dlib/image_keypoint.h>
#include <dlib/opencv.h>

#include <algorithm>
#include <vector>

#include "base/angle.h"

namespace rubble::scoring {
namespace {

constexpr double kThreshold = 30.0;  // of the Hessian's determinant; dlib's own choice
constexpr double kBox = 20.0;        // edge of the descriptor's box, in scales (Bay 2006, section 4)
constexpr double kReach = 32.0;      // a point's neighbourhood must lie in the image so far, in scales: dlib's own, too
constexpr std::size_t kLooked = 10;  // so many times the points wanted are looked at

using Integral = dlib::integral_image_generic<int>;

/// dlib::get_surf_points(), which describes all points that it finds: here no more than are kept, the strongest.
std::vector<dlib::surf_point> strongest(const Integral& image, std::size_t max_points) {
  dlib::hessian_pyramid pyramid;
  pyramid.build_pyramid(image, 4, 6, 2);
  std::vector<dlib::interest_point> found;
  dlib::get_interest_points(pyramid, kThreshold, found);
  std::sort(found.rbegin(), found.rend());
  if (found.size() > kLooked * max_points) found.resize(kLooked * max_points);
  std::vector<dlib::surf_point> out;
  for (const dlib::interest_point& p : found) {
    if (out.size() == max_points) break;
    const auto reach = static_cast<unsigned long>(kReach * p.scale);
    if (!dlib::get_rect(image).contains(dlib::centered_rect(p.center, reach, reach))) continue;
    dlib::surf_point described;
    described.p = p;
    described.angle = dlib::compute_dominant_angle(image, p.center, p.scale);
    dlib::compute_surf_descriptor(image, p.center, p.scale, described.angle, described.des);
    out.push_back(described);
  }
  return out;
}

}  // namespace

std::vector<cv::KeyPoint> surf_points(const cv::Mat& image, std::size_t max_points, cv::Mat& descriptors) {
  Integral integral;
  integral.load(dlib::cv_image<unsigned char>(image));
  const std::vector<dlib::surf_point> points = strongest(integral, max_points);
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
