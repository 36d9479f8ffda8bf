#include "scoring/pictures/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <vector>

namespace rubble::scoring {
namespace {

constexpr int kMaxSide = 3000;  // of the picture [pixels]

/// The frame of the picture: large maps are drawn with coarser cells.
GridFrame picture_frame(GridFrame frame) {
  const int side = std::max(frame.width, frame.height);
  const int shrink = (side + kMaxSide - 1) / kMaxSide;
  if (shrink <= 1) return frame;
  frame.resolution *= shrink;
  frame.width = (frame.width + shrink - 1) / shrink;
  frame.height = (frame.height + shrink - 1) / shrink;
  return frame;
}

}  // namespace

Canvas::Canvas(const GridFrame& map_frame) : frame(picture_frame(map_frame)), scale(pixels_per_cell(frame)) {
  const int width = std::max(frame.width * scale, kLeastWidth);
  image = cv::Mat(frame.height * scale, width, CV_8UC3, cv::Scalar(kUnknown));
}

cv::Point Canvas::pixel(const mrpt::math::TPoint2D& p) const {
  const double pixels = scale / frame.resolution;
  return {static_cast<int>(std::lround((p.x - frame.x0) * pixels)),
          map_rows() - static_cast<int>(std::lround((p.y - frame.y0) * pixels))};
}

Colour mixed(const Colour& a, const Colour& b, double share) {
  Colour out;
  for (int i = 0; i < 3; ++i) out[i] = cv::saturate_cast<unsigned char>((1.0 - share) * a[i] + share * b[i]);
  return out;
}

void draw_warning(Canvas& canvas, const std::string& words) {
  constexpr int kLine = 22;
  constexpr double kSize = 0.5;
  if (words.empty()) return;
  const auto width = [](const std::string& line) {
    int base = 0;
    return cv::getTextSize(line, cv::FONT_HERSHEY_SIMPLEX, kSize, 1, &base).width;
  };
  std::vector<std::string> lines(1);
  std::stringstream all(words);
  for (std::string word; all >> word;) {
    if (!lines.back().empty() && width(lines.back() + " " + word) > canvas.image.cols - 20) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  const int bottom = static_cast<int>(lines.size()) * kLine + 4;
  cv::rectangle(canvas.image, {0, 0}, {canvas.image.cols - 1, bottom}, cv::Scalar(kMapOnly), cv::FILLED);
  for (std::size_t i = 0; i < lines.size(); ++i)
    cv::putText(canvas.image, lines[i], {10, 18 + static_cast<int>(i) * kLine}, cv::FONT_HERSHEY_SIMPLEX, kSize,
                cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
}

}  // namespace rubble::scoring
