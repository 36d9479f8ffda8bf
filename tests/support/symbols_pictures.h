#pragma once

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "base/image/geotiff.h"

/// League maps as other teams draw them, and what happens to pictures on their way. Places in pixels, x right, y down,
/// (0, 0) the upper-left corner of the image. Colours as RGB.
namespace rubble::symbols_test {

inline cv::Mat view(RgbImage& image) { return {image.height, image.width, CV_8UC3, image.rgb.data()}; }

/// A floor of 8 x 6 m: checkerboard, white floor with the half-metre grid, a wall around it and one across.
inline RgbImage floor_plan(double resolution) {
  const auto px = [&](double metres) { return static_cast<int>(std::lround(metres / resolution)); };
  RgbImage image(px(8.0), px(6.0));
  cv::Mat m = view(image);
  for (int y = 0; y < m.rows; ++y)
    for (int x = 0; x < m.cols; ++x) {
      const int metres = static_cast<int>(x * resolution) + static_cast<int>(y * resolution);
      m.at<cv::Vec3b>(y, x) = metres % 2 == 0 ? cv::Vec3b(226, 226, 227) : cv::Vec3b(237, 237, 238);
    }
  cv::rectangle(m, {px(1.0), px(1.0)}, {px(7.0), px(5.0)}, {255, 255, 255}, cv::FILLED);
  for (double at = 1.0; at < 7.0; at += 0.5) {
    cv::line(m, {px(at), px(1.0)}, {px(at), px(5.0)}, {190, 190, 191});
    if (at < 5.0) cv::line(m, {px(1.0), px(at)}, {px(7.0), px(at)}, {190, 190, 191});
  }
  cv::rectangle(m, {px(1.0), px(1.0)}, {px(7.0), px(5.0)}, {0, 40, 120}, px(0.1));
  cv::line(m, {px(4.0), px(1.0)}, {px(4.0), px(3.5)}, {0, 40, 120}, px(0.1));
  return image;
}

inline void draw_path(RgbImage& image, double resolution) {
  const auto px = [&](double metres) { return static_cast<int>(std::lround(metres / resolution)); };
  cv::Mat m = view(image);
  const std::vector<cv::Point> path = {{px(1.5), px(1.5)}, {px(3.5), px(2.2)}, {px(3.5), px(4.2)}, {px(6.5), px(4.5)}};
  cv::polylines(m, path, false, {120, 0, 140}, std::max(1, px(0.03)));
  cv::arrowedLine(m, {px(1.4), px(1.7)}, {px(1.4), px(1.4)}, {255, 200, 0}, std::max(1, px(0.05)), cv::LINE_AA, 0, 0.5);
}

enum class Shape { Circle, Diamond };

/// A symbol with smooth edges and white lettering in its middle: hector's, to a sixteenth of a pixel.
inline void draw_symbol(RgbImage& image, double resolution, cv::Point2d centre, const cv::Scalar& colour, Shape shape,
                        const std::string& lettering, double side = 0.35) {
  cv::Mat m = view(image);
  constexpr int kShift = 4;
  const auto fixed = [&](cv::Point2d p) {  // OpenCV counts from the centre of the first pixel
    return cv::Point(static_cast<int>(std::lround((p.x - 0.5) * (1 << kShift))),
                     static_cast<int>(std::lround((p.y - 0.5) * (1 << kShift))));
  };
  const double half = 0.5 * side / resolution;
  if (shape == Shape::Circle) {
    cv::circle(m, fixed(centre), static_cast<int>(std::lround((half - 0.5) * (1 << kShift))), colour, cv::FILLED,
               cv::LINE_AA, kShift);
  } else {
    const double r = half * std::sqrt(2.0);
    const std::vector<cv::Point> corners = {fixed(centre + cv::Point2d(r, 0)), fixed(centre + cv::Point2d(0, r)),
                                            fixed(centre - cv::Point2d(r, 0)), fixed(centre - cv::Point2d(0, r))};
    cv::fillConvexPoly(m, corners, colour, cv::LINE_AA, kShift);
  }
  const double scale = half / 24.0 * (lettering.size() > 1 ? 0.7 : 1.0);
  int below = 0;
  const cv::Size size = cv::getTextSize(lettering, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &below);
  cv::putText(m, lettering,
              {static_cast<int>(std::lround(centre.x - 0.5 - 0.5 * size.width)),
               static_cast<int>(std::lround(centre.y - 0.5 + 0.5 * size.height))},
              cv::FONT_HERSHEY_SIMPLEX, scale, {255, 255, 255}, 1, cv::LINE_AA);
}

/// The image turned by `degrees` counter-clockwise on a canvas that holds it, and where its points went.
struct Turned {
  RgbImage image;
  cv::Matx23d T;
  cv::Point2d operator()(const cv::Point2d& p) const {
    return {T(0, 0) * p.x + T(0, 1) * p.y + T(0, 2), T(1, 0) * p.x + T(1, 1) * p.y + T(1, 2)};
  }
};

inline Turned turned(RgbImage image, double degrees, int interpolation) {
  const cv::Mat from = view(image);
  const double side = std::ceil(std::hypot(from.cols, from.rows)) + 2.0;
  cv::Mat T = cv::getRotationMatrix2D(cv::Point2d(0.5 * from.cols, 0.5 * from.rows), degrees, 1.0);
  T.at<double>(0, 2) += 0.5 * (side - from.cols);
  T.at<double>(1, 2) += 0.5 * (side - from.rows);
  Turned out{RgbImage(static_cast<int>(side), static_cast<int>(side)), cv::Matx23d(T.ptr<double>())};
  // warpAffine counts from pixel centres; T maps corners.
  cv::Matx23d centres = out.T;
  centres(0, 2) += 0.5 * (out.T(0, 0) + out.T(0, 1)) - 0.5;
  centres(1, 2) += 0.5 * (out.T(1, 0) + out.T(1, 1)) - 0.5;
  cv::Mat to = view(out.image);
  cv::warpAffine(from, to, centres, to.size(), interpolation, cv::BORDER_CONSTANT, {255, 255, 255});
  return out;
}

/// Through a JPEG of this quality and back.
inline RgbImage jpeg(RgbImage image, int quality) {
  cv::Mat bgr;
  cv::cvtColor(view(image), bgr, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  RgbImage out(image.width, image.height);
  cv::Mat to = view(out);
  cv::cvtColor(cv::imdecode(bytes, cv::IMREAD_COLOR), to, cv::COLOR_BGR2RGB);
  return out;
}

inline void save(const std::string& path, RgbImage image) {
  cv::Mat bgr;
  cv::cvtColor(view(image), bgr, cv::COLOR_RGB2BGR);
  cv::imwrite(path, bgr);
}

}  // namespace rubble::symbols_test
