#include "scoring/measures/lattice_shifts.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;

constexpr double kCell = 0.1;         // of the correlation [m]
constexpr double kApart = 0.6;        // half a pallet [m]
constexpr double kLeastCommon = 0.2;  // of the walls on known ground
constexpr double kBlur = 0.8;         // of the walls, so that the coarse cells do not matter [cells]

struct Shift {
  double agreement = 0.0;
  int dx = 0;  ///< [cells]
  int dy = 0;
};

/// Sum of a(p) b(p + shift) over all shifts, by FFT; both in the corner of a canvas twice their size.
cv::Mat correlated(const cv::Mat& a_spectrum, const cv::Mat& b_spectrum) {
  cv::Mat out;
  cv::mulSpectrums(b_spectrum, a_spectrum, out, 0, true);
  cv::idft(out, out, cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return out;
}

bool is_peak(const cv::Mat& m, int x, int y) {
  const float here = m.at<float>(y, x);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (m.at<float>((y + dy + m.rows) % m.rows, (x + dx + m.cols) % m.cols) > here) return false;
  return true;
}

}  // namespace

std::vector<TPoint2D> lattice_shifts(const OccupancyGrid& grid, std::size_t count) {
  const int factor = std::max(1, static_cast<int>(std::lround(kCell / grid.resolution())));
  const double cell = factor * grid.resolution();
  const cv::Size size((grid.width() + factor - 1) / factor, (grid.height() + factor - 1) / factor);
  const cv::Size canvas(cv::getOptimalDFTSize(2 * size.width), cv::getOptimalDFTSize(2 * size.height));
  cv::Mat walls = cv::Mat::zeros(canvas, CV_32F);
  cv::Mat known = cv::Mat::zeros(canvas, CV_32F);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      if (grid[{x, y}] == Occupancy::Unknown) continue;
      known.at<float>(y / factor, x / factor) = 1.0f;
      if (grid[{x, y}] == Occupancy::Occupied) walls.at<float>(y / factor, x / factor) = 1.0f;
    }
  const double all_walls = cv::sum(walls)[0];
  if (all_walls <= 0.0) return {};
  cv::Mat blurred = cv::Mat::zeros(canvas, CV_32F);
  cv::GaussianBlur(walls(cv::Rect({0, 0}, size)), blurred(cv::Rect({0, 0}, size)), {3, 3}, kBlur, kBlur,
                   cv::BORDER_CONSTANT | cv::BORDER_ISOLATED);
  for (cv::Mat* m : {&walls, &known, &blurred}) cv::dft(*m, *m);
  const cv::Mat met = correlated(walls, blurred);
  const cv::Mat on_known = correlated(walls, known);
  std::vector<Shift> peaks;
  for (int y = 0; y < canvas.height; ++y)
    for (int x = 0; x < canvas.width; ++x) {
      if (on_known.at<float>(y, x) < kLeastCommon * all_walls || !is_peak(met, x, y)) continue;
      const int dx = x > canvas.width / 2 ? x - canvas.width : x;
      const int dy = y > canvas.height / 2 ? y - canvas.height : y;
      if (std::hypot(dx, dy) * cell < kApart) continue;
      peaks.push_back(
          {static_cast<double>(met.at<float>(y, x)) / static_cast<double>(on_known.at<float>(y, x)), dx, dy});
    }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Shift& a, const Shift& b) { return a.agreement > b.agreement; });
  std::vector<TPoint2D> out;
  for (const Shift& peak : peaks) {
    const TPoint2D shift(peak.dx * cell, peak.dy * cell);
    const auto near = [&](const TPoint2D& other) { return (other - shift).norm() < kApart; };
    if (std::any_of(out.begin(), out.end(), near)) continue;
    out.push_back(shift);
    if (out.size() == count) break;
  }
  return out;
}

}  // namespace rubble::scoring
