#include "scoring/maps/colours/tone_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace rubble::scoring {
namespace {

constexpr int kRounding = 1;  // of what editors make of a value

template <class Function>
ToneCurve curve_of(ToneCurve::Kind kind, const Function& f, const char* format, double a, double b) {
  ToneCurve out;
  out.kind = kind;
  for (std::size_t v = 0; v < out.of.size(); ++v)
    out.of[v] = static_cast<std::uint8_t>(std::clamp(std::lround(f(static_cast<double>(v))), 0L, 255L));
  char name[80];
  std::snprintf(name, sizeof name, format, a, b);
  out.name = name;
  return out;
}

Rgb changed(const ToneCurve& curve, const Rgb& colour) {
  return {curve.of[colour[0]], curve.of[colour[1]], curve.of[colour[2]]};
}

/// Greatest difference of a channel.
int difference(const Rgb& a, const Rgb& b) {
  int most = 0;
  for (std::size_t i = 0; i < 3; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

std::vector<ToneCurve> tone_curves(const Rgb& darker, const Rgb& lighter, const FloorTone& floor, int rounding) {
  using Kind = ToneCurve::Kind;
  std::vector<ToneCurve> out;
  const auto offer = [&](ToneCurve curve) {
    const bool fits = difference(changed(curve, league::kUnexplored), darker) <= rounding &&
                      difference(changed(curve, league::kUnexploredLight), lighter) <= rounding &&
                      difference(changed(curve, floor.own), floor.now) <= rounding;
    const auto same = [&](const ToneCurve& other) { return other.of == curve.of; };
    if (fits && std::none_of(out.begin(), out.end(), same)) out.push_back(std::move(curve));
  };
  const double dark = darker[0], light = lighter[0], of_floor = floor.now[0];
  const bool is_gamma = floor.own != league::kFree || of_floor == 255.0;  // which leaves white as it is
  if (dark > 0.0 && is_gamma) {
    const double power = std::log(dark / 255.0) / std::log(league::kUnexplored[0] / 255.0);
    for (int i = 0; i <= 24; ++i) {  // from the middle outwards
      const double p = power + 0.005 * (i % 2 == 0 ? i / 2 : -(i + 1) / 2);
      if (p > 0.0)
        offer(curve_of(
            Kind::Gamma, [p](double v) { return 255.0 * std::pow(v / 255.0, p); }, "gamma %.2f", p, 0.0));
    }
  }
  // A line through the squares and the floor, or through the two squares where the floor is clipped.
  const auto lines = [&](double from, double to, double at_from, double at_to) {
    constexpr std::array<double, 7> kRounded{0.0, -0.15, 0.15, -0.3, 0.3, -0.45, 0.45};
    for (const double low : kRounded)
      for (const double high : kRounded) {
        const double gain = (at_to + high - at_from - low) / (to - from);
        const double offset = at_from + low - gain * from;
        if (gain > 0.1)
          offer(curve_of(
              Kind::Line, [=](double v) { return gain * v + offset; }, "%.2f times the value %+.0f", gain, offset));
      }
  };
  lines(league::kUnexplored[0], floor.own[0], dark, of_floor);
  lines(league::kUnexplored[0], league::kUnexploredLight[0], dark, light);
  return out;
}

BeforeCurve::BeforeCurve(const ToneCurve& curve) {
  for (std::size_t value = 0; value < before_.size(); ++value) {
    const auto nearer = [value = static_cast<int>(value)](std::uint8_t a, std::uint8_t b) {
      return std::abs(a - value) < std::abs(b - value);
    };
    before_[value] =
        static_cast<std::uint8_t>(std::min_element(curve.of.begin(), curve.of.end(), nearer) - curve.of.begin());
  }
  std::transform(league::kAll.begin(), league::kAll.end(), leagues_.begin(),
                 [&](const Rgb& own) { return changed(curve, own); });
}

Rgb BeforeCurve::operator()(const Rgb& colour) const {
  // The nearest, and of those the first: clipped, white and the lighter squares may be one value apart.
  const auto nearest = std::min_element(leagues_.begin(), leagues_.end(), [&](const Rgb& a, const Rgb& b) {
    return difference(a, colour) < difference(b, colour);
  });
  if (difference(*nearest, colour) <= kRounding)
    return league::kAll[static_cast<std::size_t>(nearest - leagues_.begin())];
  return {before_[colour[0]], before_[colour[1]], before_[colour[2]]};
}

}  // namespace rubble::scoring
