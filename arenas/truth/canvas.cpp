#include "arenas/truth/canvas.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/geometry.h"
#include "base/angle.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr int kSamples = 4;  ///< a pixel, along x and along y

}  // namespace

Canvas::Canvas(const TPoint2D& min, const TPoint2D& max, double pixels_per_metre, const Colour& paper, int first_row,
               int rows)
    : min_(min),
      scale_(pixels_per_metre * kSamples),
      width_(std::max(1, static_cast<int>(std::ceil((max.x - min.x) * pixels_per_metre)))),
      height_(std::max(1, static_cast<int>(std::ceil((max.y - min.y) * pixels_per_metre)))),
      first_row_(first_row),
      rows_(std::min(rows, height_ - first_row)),
      samples_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows_) * kSamples * kSamples,
               {static_cast<float>(paper[0]), static_cast<float>(paper[1]), static_cast<float>(paper[2])}) {}

TPoint2D Canvas::to_samples(const TPoint2D& p) const {
  return {(p.x - min_.x) * scale_, height_ * kSamples - (p.y - min_.y) * scale_};
}

void Canvas::blend(int x, int y, const Colour& colour, double opacity) {
  const auto row = static_cast<std::size_t>(y - first_row_ * kSamples);
  auto& sample = samples_[row * static_cast<std::size_t>(width_ * kSamples) + static_cast<std::size_t>(x)];
  for (std::size_t i = 0; i < 3; ++i) {
    sample[i] = static_cast<float>(static_cast<double>(sample[i]) * (1.0 - opacity) + colour[i] * opacity);
  }
}

template <class Paint>
void Canvas::for_samples(const Outline& outline, const Paint& paint) {
  Outline shape;
  double top = height_ * kSamples;
  double bottom = 0.0;
  for (const TPoint2D& p : outline) {
    shape.push_back(to_samples(p));
    top = std::min(top, shape.back().y);
    bottom = std::max(bottom, shape.back().y);
  }
  if (signed_area(shape) < 0.0) std::reverse(shape.begin(), shape.end());  // y points down in the picture
  const double right = width_ * kSamples;
  const int end = std::min((first_row_ + rows_) * kSamples, static_cast<int>(bottom) + 1);
  for (int y = std::max(first_row_ * kSamples, static_cast<int>(top)); y < end; ++y) {
    const auto span = clip(shape, {0.0, y + 0.5}, {right, y + 0.5});
    if (!span) continue;
    const int first = static_cast<int>(std::ceil(span->from * right - 0.5));
    const int last = static_cast<int>(std::ceil(span->to * right - 0.5));
    for (int x = first; x < last; ++x) paint(x, y);
  }
}

void Canvas::fill(const Outline& outline, const Colour& colour, double opacity) {
  for_samples(outline, [&](int x, int y) { blend(x, y, colour, opacity); });
}

void Canvas::fill(const Outline& outline, const std::function<Colour(const TPoint2D&)>& colour) {
  for_samples(outline, [&](int x, int y) {
    const TPoint2D p{min_.x + (x + 0.5) / scale_, min_.y + (height_ * kSamples - y - 0.5) / scale_};
    blend(x, y, colour(p), 1.0);
  });
}

void Canvas::disc(const TPoint2D& centre, double radius, const Colour& colour, double opacity) {
  constexpr int kCorners = 40;
  Outline outline;
  for (int i = 0; i < kCorners; ++i) {
    const double bearing = 2.0 * kPi * i / kCorners;
    outline.push_back({centre.x + radius * std::cos(bearing), centre.y + radius * std::sin(bearing)});
  }
  fill(outline, colour, opacity);
}

void Canvas::line(const TPoint2D& from, const TPoint2D& to, double width, const Colour& colour, double opacity) {
  fill(strip(from, to, width), colour, opacity);
}

void Canvas::arrow(const TPoint2D& tail, const TPoint2D& tip, double width, const Colour& colour, double opacity) {
  const TPoint2D along = tip - tail;
  const double length = std::hypot(along.x, along.y);
  const TPoint2D forward{along.x / length, along.y / length};
  const TPoint2D left{-forward.y, forward.x};
  const TPoint2D neck = tip - forward * (4.0 * width);
  line(tail, neck, width, colour, opacity);
  fill({neck - left * (2.0 * width), tip, neck + left * (2.0 * width)}, colour, opacity);
}

void Canvas::copy_to(RgbImage& picture) const {
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < width_; ++x) {
      Colour sum{};
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const std::size_t row = static_cast<std::size_t>(y * kSamples + k / kSamples);
        const std::size_t column = static_cast<std::size_t>(x * kSamples + k % kSamples);
        const auto& sample = samples_[row * static_cast<std::size_t>(width_ * kSamples) + column];
        for (std::size_t i = 0; i < 3; ++i) sum[i] += static_cast<double>(sample[i]);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        picture.pixel(x, first_row_ + y)[i] = static_cast<std::uint8_t>(std::lround(sum[i] / (kSamples * kSamples)));
      }
    }
  }
}

}  // namespace rubble::arenas
