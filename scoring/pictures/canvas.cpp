#include "scoring/pictures/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>

namespace rubble::scoring {
namespace {

constexpr int kRow = 26;        // height of a row of the legend [pixels]
constexpr int kMaxSide = 3000;  // of the picture [pixels]

/// Pixels a cell such that a map of usual size can be read and a huge one still fits a screenful or two.
int pixels_per_cell(const GridFrame& frame) {
  const int side = std::max(frame.width, frame.height);
  // Small arenas fill the picture, too.
  return std::max(std::clamp(1800 / std::max(side, 1), 1, 3), std::clamp(1200 / std::max(side, 1), 1, 12));
}

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

/// The longest bar of a round number of metres that fits into so many pixels.
struct ScaleBar {
  int pixels = 0;
  std::string words;
};

ScaleBar scale_bar(const Canvas& canvas, int room) {
  double length = 0.1;
  for (const double candidate : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (candidate * canvas.scale <= room * canvas.frame.resolution) length = candidate;
  return {static_cast<int>(std::lround(length * canvas.scale / canvas.frame.resolution)),
          length < 1.0 ? cv::format("%.1f m", length) : cv::format("%.0f m", length)};
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

void draw_text(Canvas& canvas, const std::string& words, int x, int y) {
  cv::putText(canvas.image, words, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(kInk), 1, cv::LINE_AA);
}

int text_width(const std::string& words) {
  int base = 0;
  return cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, 0.42, 1, &base).width;
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

void put_strip(Canvas& canvas, const std::vector<StripItem>& items) {
  constexpr int kEdge = 10;
  constexpr int kBetween = 14;
  const int bar_room = std::min(240, canvas.image.cols / 5);
  const ScaleBar bar = scale_bar(canvas, bar_room);
  std::vector<cv::Point> places;
  int x = kEdge;
  int row = 0;
  const auto place = [&](int width) {
    if (x > kEdge && x + width + kEdge > canvas.image.cols) {
      x = kEdge;
      ++row;
    }
    places.emplace_back(x, row);
    x += width + kBetween;
  };
  for (const StripItem& item : items) place(item.width);
  const int bar_width = bar.pixels + 6 + text_width(bar.words);
  place(bar_width);
  const int top = canvas.image.rows;
  cv::copyMakeBorder(canvas.image, canvas.image, 0, (row + 1) * kRow + 8, 0, 0, cv::BORDER_CONSTANT,
                     cv::Scalar(250, 250, 250));
  const auto middle = [&](const cv::Point& at) { return top + 4 + at.y * kRow + kRow / 2; };
  for (std::size_t i = 0; i < items.size(); ++i) items[i].draw(places[i].x, middle(places[i]));
  const int y = middle(places.back());
  const int left = std::max(places.back().x, canvas.image.cols - kEdge - bar_width);
  const int right = left + bar.pixels;
  cv::rectangle(canvas.image, {left, y - 2}, {right, y + 2}, cv::Scalar(kInk), cv::FILLED);
  for (const int end : {left, right}) cv::line(canvas.image, {end, y - 6}, {end, y + 6}, cv::Scalar(kInk));
  draw_text(canvas, bar.words, right + 6, y + 5);
}

std::vector<StripItem> legend_items(Canvas& canvas, const std::vector<LegendEntry>& entries) {
  std::vector<StripItem> items;
  for (const LegendEntry& entry : entries)
    items.push_back({17 + text_width(entry.words), [&canvas, entry](int x, int y) {
                       const cv::Rect box(x, y - 6, 12, 12);
                       cv::rectangle(canvas.image, box, cv::Scalar(entry.colour), cv::FILLED);
                       cv::rectangle(canvas.image, box, cv::Scalar(120, 120, 120));
                       draw_text(canvas, entry.words, x + 17, y + 5);
                     }});
  return items;
}

void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries) {
  put_strip(canvas, legend_items(canvas, entries));
}

}  // namespace rubble::scoring
