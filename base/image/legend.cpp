#include "base/image/legend.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/round_step.h"

namespace rubble {
namespace {

constexpr int kRow = 26;  // height of a row of the legend [pixels]
cv::Scalar scalar(const Bgr& colour) { return {double(colour[0]), double(colour[1]), double(colour[2])}; }

const cv::Scalar kInk = scalar(kInkBgr);
const cv::Scalar kMargin(250, 250, 250);

/// The longest bar of a round number of metres that fits into so many pixels.
struct ScaleBar {
  int pixels = 0;
  std::string words;
};

ScaleBar scale_bar(const GridFrame& frame, int scale, int room) {
  double length = 0.1;
  for (const double candidate : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (candidate * scale <= room * frame.resolution) length = candidate;
  return {static_cast<int>(std::lround(length * scale / frame.resolution)),
          length < 1.0 ? cv::format("%.1f m", length) : cv::format("%.0f m", length)};
}

void draw_arrow(cv::Mat& picture, const cv::Point& tail, const cv::Point& tip, const cv::Scalar& colour) {
  cv::arrowedLine(picture, tail, tip, colour, 2, cv::LINE_AA, 0, 0.4);
}

void draw_sign(cv::Mat& picture, const LegendEntry& entry, const cv::Rect& box) {
  const cv::Scalar colour = scalar(entry.colour), rim(120, 120, 120);
  const cv::Point middle(box.x + box.width / 2, box.y + box.height / 2), last = box.br() - cv::Point(1, 1);
  switch (entry.sign) {
    case Sign::Ring:
      return cv::circle(picture, middle, 5, colour, 2, cv::LINE_AA);
    case Sign::Dot:
      cv::circle(picture, middle, 4, colour, cv::FILLED, cv::LINE_AA);
      return cv::circle(picture, middle, 4, rim, 1, cv::LINE_AA);
    case Sign::Cross:
      cv::line(picture, box.tl(), last, colour, 2, cv::LINE_AA);
      return cv::line(picture, {box.x, last.y}, {last.x, box.y}, colour, 2, cv::LINE_AA);
    case Sign::Arrow:
      return draw_arrow(picture, {middle.x, last.y}, {middle.x, box.y}, colour);
    case Sign::Arrows:
      for (const int x : {box.x + 2, last.x - 2}) draw_arrow(picture, {x, last.y}, {x, box.y}, colour);
      return;
    case Sign::Field:
    case Sign::Quarters:
    case Sign::Grid:
    case Sign::Stripes:
      break;
  }
  cv::rectangle(picture, box, colour, cv::FILLED);
  const int apart = entry.sign == Sign::Quarters ? 6 : entry.sign == Sign::Field ? box.width : 3;
  for (int at = apart; at < box.width; at += apart) {
    cv::line(picture, {box.x, box.y + at}, {last.x, box.y + at}, rim);
    if (entry.sign != Sign::Stripes) cv::line(picture, {box.x + at, box.y}, {box.x + at, last.y}, rim);
  }
  cv::rectangle(picture, box, rim);
}

}  // namespace

int pixels_per_cell(const GridFrame& frame) {
  const int side = std::max(frame.width, frame.height);
  // Small arenas fill the picture, too.
  return std::max(std::clamp(1800 / std::max(side, 1), 1, 3), std::clamp(1200 / std::max(side, 1), 1, 12));
}

void draw_text(cv::Mat& picture, const std::string& words, int x, int y) {
  cv::putText(picture, words, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.42, kInk, 1, cv::LINE_AA);
}

int text_width(const std::string& words) {
  int base = 0;
  return cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, 0.42, 1, &base).width;
}

void draw_label(cv::Mat& picture, const std::string& words, int x, int y) {
  const cv::Rect around = cv::Rect(x - 2, y - 11, text_width(words) + 4, 15) & cv::Rect({}, picture.size());
  if (around.empty()) return;
  cv::Mat ground = picture(around);
  cv::addWeighted(ground, 0.15, cv::Mat(ground.size(), ground.type(), kMargin), 0.85, 0.0, ground);
  draw_text(picture, words, x, y);
}

void put_axes(cv::Mat& picture, const GridFrame& frame, int scale) {
  constexpr int kApart = 60, kTick = 5, kBelow = 22;  // [pixels]
  const double pixels = scale / frame.resolution;
  const double step = round_step(kApart / pixels);
  struct Tick {
    int at;  ///< [pixels] from the frame's lower left corner
    std::string words;
  };
  const auto ticks = [&](double from, int length) {
    std::vector<Tick> out;
    for (double k = std::ceil(from / step); (k * step - from) * pixels <= length; ++k)
      out.push_back({static_cast<int>(std::lround((k * step - from) * pixels)), cv::format("%.10g", k * step + 0.0)});
    return out;
  };
  const std::vector<Tick> east = ticks(frame.x0, frame.width * scale);
  const std::vector<Tick> north = ticks(frame.y0, frame.height * scale);
  const int unit = text_width("m");
  int left = unit;
  for (const Tick& tick : north) left = std::max(left, text_width(tick.words));
  left += kTick + 6;
  cv::copyMakeBorder(picture, picture, 0, kBelow, left, 0, cv::BORDER_CONSTANT, kMargin);
  const int bottom = frame.height * scale;
  for (const Tick& tick : north) {
    const int y = std::min(bottom - tick.at, bottom - 1);
    cv::line(picture, {left - kTick, y}, {left - 1, y}, kInk);
    draw_text(picture, tick.words, left - kTick - 3 - text_width(tick.words), std::max(y + 4, 10));
  }
  for (const Tick& tick : east) {
    const int x = left + tick.at;
    cv::line(picture, {x, bottom}, {x, bottom + kTick - 1}, kInk);
    const int half = text_width(tick.words) / 2;
    const int begin = std::clamp(x - half, unit + 12, std::max(unit + 12, picture.cols - 2 * half - 2));
    draw_text(picture, tick.words, begin, bottom + kTick + 12);
  }
  draw_text(picture, "m", 3, bottom + kTick + 12);
}

void put_strip(cv::Mat& picture, const std::vector<StripItem>& items, const GridFrame& frame, int scale) {
  constexpr int kEdge = 10;
  constexpr int kBetween = 14;
  const int bar_room = std::min(240, picture.cols / 5);
  const ScaleBar bar = scale_bar(frame, scale, bar_room);
  std::vector<cv::Point> places;
  int x = kEdge;
  int row = 0;
  const auto place = [&](int width) {
    if (x > kEdge && x + width + kEdge > picture.cols) {
      x = kEdge;
      ++row;
    }
    places.emplace_back(x, row);
    x += width + kBetween;
  };
  for (const StripItem& item : items) place(item.width);
  const int bar_width = bar.pixels + 6 + text_width(bar.words);
  place(bar_width);
  const int top = picture.rows;
  cv::copyMakeBorder(picture, picture, 0, (row + 1) * kRow + 8, 0, 0, cv::BORDER_CONSTANT, kMargin);
  const auto middle = [&](const cv::Point& at) { return top + 4 + at.y * kRow + kRow / 2; };
  for (std::size_t i = 0; i < items.size(); ++i) items[i].draw(places[i].x, middle(places[i]));
  const int y = middle(places.back());
  const int left = std::max(places.back().x, picture.cols - kEdge - bar_width);
  const int right = left + bar.pixels;
  cv::rectangle(picture, {left, y - 2}, {right, y + 2}, kInk, cv::FILLED);
  for (const int end : {left, right}) cv::line(picture, {end, y - 6}, {end, y + 6}, kInk);
  draw_text(picture, bar.words, right + 6, y + 5);
}

std::vector<StripItem> legend_items(cv::Mat& picture, const std::vector<LegendEntry>& entries) {
  std::vector<StripItem> items;
  for (const LegendEntry& entry : entries)
    items.push_back({17 + text_width(entry.words), [&picture, entry](int x, int y) {
                       draw_sign(picture, entry, {x, y - 6, 12, 12});
                       draw_text(picture, entry.words, x + 17, y + 5);
                     }});
  return items;
}

StripItem bar_item(cv::Mat& picture, const std::string& least, const std::string& most,
                   const std::function<Bgr(double share)>& colour) {
  constexpr int kLong = 60;  // [pixels]
  const int begin = text_width(least) + 8;
  return {begin + kLong + 6 + text_width(most), [&picture, least, most, begin, colour](int x, int y) {
            draw_text(picture, least, x, y + 5);
            for (int i = 0; i < kLong; ++i)
              cv::line(picture, {x + begin + i, y - 6}, {x + begin + i, y + 6}, scalar(colour(i / (kLong - 1.0))));
            draw_text(picture, most, x + begin + kLong + 6, y + 5);
          }};
}

void draw_legend(cv::Mat& picture, const std::vector<LegendEntry>& entries, const GridFrame& frame, int scale) {
  put_strip(picture, legend_items(picture, entries), frame, scale);
}

GridFrame frame_of_pixels(double metre) { return {1, 1, 1.0 / metre, 0.0, 0.0}; }

void draw_legend(RgbImage& picture, const std::vector<LegendEntry>& entries, double metre) {
  cv::Mat strip(1, picture.width, CV_8UC3, kMargin);  // a row to begin with, that is not taken
  draw_legend(strip, entries, frame_of_pixels(metre), 1);
  cv::cvtColor(strip, strip, cv::COLOR_BGR2RGB);
  picture.rgb.insert(picture.rgb.end(), strip.ptr(1), strip.data + strip.total() * strip.elemSize());
  picture.height += strip.rows - 1;
}

}  // namespace rubble
