#include "scoring/pictures/labels.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "base/image/legend.h"

namespace rubble::scoring {
namespace {

// As draw_label() has them [pixels].
constexpr int kHeight = 15;
constexpr int kAside = 2;
constexpr int kAbove = 11;

cv::Rect around(const cv::Point& at, int radius) {
  return {at.x - radius, at.y - radius, 2 * radius + 1, 2 * radius + 1};
}

}  // namespace

void Labels::add(const std::string& words, const cv::Point& at, int radius) {
  keep_free(at, radius);
  if (!words.empty()) wanted_.push_back({words, {0, 0, text_width(words) + 2 * kAside, kHeight}, at, radius, false});
}

void Labels::keep_free(const cv::Point& at, int radius) { points_.push_back(around(at, radius)); }

std::vector<Labels::Label> Labels::placed() const {
  constexpr int kSteps = 12;  // up and down
  std::vector<Label> out;
  const auto covers = [&](const cv::Rect& box) {
    const auto hit = [&](const cv::Rect& other) { return !(box & other).empty(); };
    return std::any_of(points_.begin(), points_.end(), hit) ||
           std::any_of(out.begin(), out.end(), [&](const Label& other) { return hit(other.box); });
  };
  const cv::Rect whole({}, picture_);
  for (Label label : wanted_) {
    const cv::Size size = label.box.size();
    const int right = label.at.x + label.radius + 1;
    const int left = label.at.x - label.radius - 1 - size.width;
    const int level = label.at.y - kHeight / 2;
    const auto inside = [&](const cv::Rect& box) { return (box & whole) == box; };
    const cv::Rect beside({right, level}, size);
    label.box = inside(beside) ? beside : cv::Rect({left, level}, size);
    bool found = false;
    for (int step = 0; step <= kSteps && !found; ++step) {
      for (const int sign : {-1, 1}) {
        for (const int x : {right, left, label.at.x - size.width / 2}) {
          const int y = level + sign * step * (kHeight + 1);
          const cv::Rect box({x, y}, size);
          if (found || !inside(box) || covers(box)) continue;
          label.box = box;
          label.far = step > 1;
          found = true;
        }
      }
    }
    out.push_back(label);
  }
  return out;
}

void draw_labels(cv::Mat& image, const Labels& labels) {
  const std::vector<Labels::Label> placed = labels.placed();
  for (const Labels::Label& label : placed) {
    if (!label.far) continue;
    const int y = label.box.y > label.at.y ? label.box.y : label.box.br().y - 1;
    const int x = std::clamp(label.at.x, label.box.x, label.box.br().x - 1);
    const cv::Point from(label.at.x, label.at.y + (y > label.at.y ? label.radius : -label.radius));
    cv::line(image, from, {x, y}, cv::Scalar(kInkBgr[0], kInkBgr[1], kInkBgr[2]), 1, cv::LINE_AA);
  }
  for (const Labels::Label& label : placed) draw_label(image, label.words, label.box.x + kAside, label.box.y + kAbove);
}

}  // namespace rubble::scoring
