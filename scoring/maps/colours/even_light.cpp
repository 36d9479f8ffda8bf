#include "scoring/maps/colours/even_light.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace rubble::scoring {
namespace {

constexpr int kStep = 3;           // greys between neighbours on one ground
constexpr double kLeast = 0.1;     // of the picture, to be a ground
constexpr int kDarkest = 60;       // of a ground
constexpr int kUneven = 20;        // greys, without a twentieth at either end
constexpr double kMostLeft = 0.4;  // of that, when the surface was taken out
constexpr int kLeftInAnyCase = 6;  // greys that are left in any case
constexpr int kEvery = 16;         // pixels between places from where grounds are looked for

using Surface = Eigen::Matrix<double, 6, 1>;

/// 1, x, y, x^2, xy, y^2 with x and y from -1 to 1 over the picture.
Surface terms(const cv::Size& size, int column, int row) {
  const double x = 2.0 * column / size.width - 1.0, y = 2.0 * row / size.height - 1.0;
  return (Surface() << 1.0, x, y, x * x, x * y, y * y).finished();
}

int spread_of(std::vector<int> greys) {
  std::sort(greys.begin(), greys.end());
  const std::size_t tail = greys.size() / 20;
  return greys[greys.size() - 1 - tail] - greys[tail];
}

std::vector<int> greys_of(const cv::Mat& grey, const std::vector<cv::Point>& places) {
  std::vector<int> out;
  for (const cv::Point& p : places) out.push_back(grey.at<unsigned char>(p));
  return out;
}

/// The ground that differs most, pixel by pixel.
std::vector<cv::Point> most_uneven(const cv::Mat& smooth) {
  cv::Mat filled = cv::Mat::zeros(smooth.rows + 2, smooth.cols + 2, CV_8U);
  std::vector<cv::Point> best;
  int most = 0, label = 1;
  for (int y = kEvery / 2; y < smooth.rows; y += kEvery)
    for (int x = kEvery / 2; x < smooth.cols; x += kEvery) {
      if (filled.at<unsigned char>(y + 1, x + 1) != 0 || smooth.at<unsigned char>(y, x) < kDarkest) continue;
      cv::Rect box;
      label = label == 255 ? 2 : label + 1;
      const int count = cv::floodFill(smooth, filled, {x, y}, cv::Scalar(), &box, cv::Scalar(kStep), cv::Scalar(kStep),
                                      4 | (label << 8) | cv::FLOODFILL_MASK_ONLY);
      if (count < kLeast * static_cast<double>(smooth.total())) continue;
      std::vector<cv::Point> places;
      for (int row = box.y; row < box.y + box.height; ++row)
        for (int column = box.x; column < box.x + box.width; ++column)
          if (filled.at<unsigned char>(row + 1, column + 1) == label) places.emplace_back(column, row);
      if (const int spread = spread_of(greys_of(smooth, places)); spread > most) {
        most = spread;
        best = std::move(places);
      }
    }
  return most >= kUneven ? best : std::vector<cv::Point>();
}

/// Three greys cover most of it: no light falls off over a drawing, though it may have been blended with what is
/// beside.
bool is_of_few_greys(const cv::Mat& grey) {
  constexpr double kMost = 0.8;
  std::array<int, 256> count{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x) ++count[grey.at<unsigned char>(y, x)];
  std::partial_sort(count.begin(), count.begin() + 3, count.end(), std::greater<>());
  return count[0] + count[1] + count[2] >= kMost * static_cast<double>(grey.total());
}

}  // namespace

std::optional<EvenLight> with_even_light(const cv::Mat& grey) {
  if (is_of_few_greys(grey)) return std::nullopt;
  cv::Mat smooth;
  cv::medianBlur(grey, smooth, 5);
  const std::vector<cv::Point> ground = most_uneven(smooth);
  if (ground.empty()) return std::nullopt;
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  Surface b = Surface::Zero();
  for (const cv::Point& p : ground) {
    const Surface t = terms(grey.size(), p.x, p.y);
    a += t * t.transpose();
    b += static_cast<double>(smooth.at<unsigned char>(p)) * t;
  }
  a.diagonal().array() += 1e-6 * static_cast<double>(ground.size());
  const Surface surface = a.ldlt().solve(b);
  double brightest = 0.0;
  for (const cv::Point& p : ground) brightest = std::max(brightest, surface.dot(terms(grey.size(), p.x, p.y)));
  const auto evened = [&](const cv::Mat& from) {
    cv::Mat out(from.size(), CV_8U);
    for (int y = 0; y < from.rows; ++y)
      for (int x = 0; x < from.cols; ++x) {
        const double light = std::max(0.1 * brightest, surface.dot(terms(from.size(), x, y)));
        out.at<unsigned char>(y, x) =
            cv::saturate_cast<unsigned char>(from.at<unsigned char>(y, x) * brightest / light);
      }
    return out;
  };
  const int before = spread_of(greys_of(smooth, ground)), after = spread_of(greys_of(evened(smooth), ground));
  if (after > std::max<double>(kLeftInAnyCase, kMostLeft * before)) return std::nullopt;
  return EvenLight{evened(grey), before};
}

}  // namespace rubble::scoring
