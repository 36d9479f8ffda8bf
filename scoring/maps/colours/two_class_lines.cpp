#include "scoring/maps/colours/two_class_lines.h"

#include <array>
#include <cstddef>
#include <opencv2/imgproc.hpp>

namespace rubble::scoring {
namespace {

using LineWidths = std::array<int, kWidestLine + 1>;

void count_widths(const unsigned char* some, const unsigned char* others, int length, LineWidths& out) {
  for (int i = 0; i < length; ++i) {
    if (some[i] == 0) continue;
    const int begin = i;
    while (i < length && some[i] != 0) ++i;
    if (i - begin <= kWidestLine && begin > 0 && i < length && others[begin - 1] != 0 && others[i] != 0)
      ++out[static_cast<std::size_t>(i - begin)];
  }
}

}  // namespace

ClassLines lines_of(const cv::Mat& some, const cv::Mat& others) {
  LineWidths widths{};
  for (int y = 0; y < some.rows; ++y) count_widths(some.ptr(y), others.ptr(y), some.cols, widths);
  const cv::Mat columns = some.t(), beside = others.t();
  for (int y = 0; y < columns.rows; ++y) count_widths(columns.ptr(y), beside.ptr(y), columns.cols, widths);
  ClassLines out;
  for (const int n : widths) out.crossed += n;
  for (int below = 0; out.width < kWidestLine && 2 * below < out.crossed;)
    below += widths[static_cast<std::size_t>(++out.width)];
  return out;
}

bool covers_ground(const cv::Mat& some, int side, bool goes_on) {
  constexpr double kLeast = 0.02;  // of the picture
  cv::Mat areas;
  cv::copyMakeBorder(some, areas, side, side, side, side, goes_on ? cv::BORDER_REPLICATE : cv::BORDER_CONSTANT);
  cv::morphologyEx(areas, areas, cv::MORPH_OPEN, cv::Mat::ones(side, side, CV_8U));
  return cv::countNonZero(areas(cv::Rect(side, side, some.cols, some.rows))) >=
         kLeast * static_cast<double>(some.total());
}

}  // namespace rubble::scoring
