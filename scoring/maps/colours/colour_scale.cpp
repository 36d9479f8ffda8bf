#include "scoring/maps/colours/colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scoring/maps/colours/league_pixels.h"
#include "scoring/maps/colours/tint.h"

namespace rubble::scoring {
namespace {

struct NamedScale {
  const char* name;
  cv::ColormapTypes type;
  bool is_even = true;  ///< brightness goes one way: what lies between two of its colours lies between their values
};

/// Scales that begin or end in greys, or are nearly grey, are not among them: too many other pictures have their
/// colours.
constexpr std::array<NamedScale, 7> kScales{{{"viridis", cv::COLORMAP_VIRIDIS},
                                             {"plasma", cv::COLORMAP_PLASMA},
                                             {"inferno", cv::COLORMAP_INFERNO},
                                             {"magma", cv::COLORMAP_MAGMA},
                                             {"jet", cv::COLORMAP_JET, false},
                                             {"turbo", cv::COLORMAP_TURBO, false},
                                             {"parula", cv::COLORMAP_PARULA}}};

/// Its colours in order.
class Scale {
 public:
  explicit Scale(cv::ColormapTypes type) {
    cv::Mat values(1, 256, CV_8U), colours;
    for (int i = 0; i < 256; ++i) values.at<unsigned char>(i) = static_cast<unsigned char>(i);
    cv::applyColorMap(values, colours, type);
    for (int i = 0; i < 256; ++i) {
      const cv::Vec3b& bgr = colours.at<cv::Vec3b>(i);
      tints_[static_cast<std::size_t>(i)] = tint_of(Rgb{bgr[2], bgr[1], bgr[0]});
    }
  }
  struct Value {
    std::uint8_t at = 0;
    double off = 0.0;  ///< from the colour there
  };
  /// The colour that is nearest. Brightness counts more: JPEG smears the rest.
  Value value_of(const Rgb& colour) const {
    constexpr double kOfColour = 0.4;
    const Tint own = tint_of(colour);
    Value out{0, std::numeric_limits<double>::max()};
    for (std::size_t i = 0; i < tints_.size(); ++i) {
      const double light = tints_[i].light - own.light, blue = kOfColour * (tints_[i].blue - own.blue),
                   red = kOfColour * (tints_[i].red - own.red);
      const double off = light * light + blue * blue + red * red;
      if (off < out.off) out = {static_cast<std::uint8_t>(i), off};
    }
    out.off = std::sqrt(out.off);
    return out;
  }

 private:
  std::array<Tint, 256> tints_{};
};

/// How many pixels have each colour, all that differ by less than a step of a sixteenth together.
std::vector<std::pair<Rgb, std::size_t>> coarse_colours(const RgbImage& image) {
  constexpr int kBits = 4;
  std::vector<std::size_t> count(std::size_t{1} << 3 * kBits);
  std::vector<std::array<std::size_t, 3>> sum(count.size());
  league::each_run(image, [&](const league::Colour& c, int, int, int length) {
    const auto part = [](int value) { return static_cast<std::size_t>(value >> (8 - kBits)); };
    const std::size_t bin = (part(c.r) << 2 * kBits) + (part(c.g) << kBits) + part(c.b);
    const auto pixels = static_cast<std::size_t>(length);
    count[bin] += pixels;
    sum[bin][0] += pixels * static_cast<std::size_t>(c.r);
    sum[bin][1] += pixels * static_cast<std::size_t>(c.g);
    sum[bin][2] += pixels * static_cast<std::size_t>(c.b);
  });
  std::vector<std::pair<Rgb, std::size_t>> out;
  for (std::size_t i = 0; i < count.size(); ++i) {
    if (count[i] == 0) continue;
    const auto mean = [&](std::size_t k) { return static_cast<std::uint8_t>(sum[i][k] / count[i]); };
    out.push_back({Rgb{mean(0), mean(1), mean(2)}, count[i]});
  }
  return out;
}

/// Whether a picture's colours are this scale's, and many of them. Of scales that are not even, blended and lossy
/// pictures say nothing.
bool is_drawn_in(const Scale& scale, bool is_even, const std::vector<std::pair<Rgb, std::size_t>>& colours) {
  constexpr double kNear = 8.0, kFar = 30.0;            // off the scale; where JPEG and blending move colours
  constexpr double kMostNear = 0.8, kNearlyAll = 0.98;  // of the pixels
  constexpr double kMostColoured = 0.8;                 // have a colour and not only a brightness
  constexpr int kColoured = 24;                         // difference of the channels
  constexpr int kTenth = 26;                            // of the scale
  constexpr std::size_t kLeastTenths = 4;               // of which a hundredth of the pixels is
  constexpr int kLeastColours = 10;                     // with a thousandth each; areas in flat colours have fewer
  double all = 0.0, near = 0.0, about = 0.0, coloured = 0.0;
  for (const auto& [colour, count] : colours) all += static_cast<double>(count);
  int many = 0;
  std::array<double, 10> tenths{};
  for (const auto& [colour, count] : colours) {
    const auto pixels = static_cast<double>(count);
    const Scale::Value value = scale.value_of(colour);
    const auto [low, high] = std::minmax({colour[0], colour[1], colour[2]});
    many += value.off <= kNear && 1000.0 * pixels >= all ? 1 : 0;
    near += value.off <= kNear ? pixels : 0.0;
    about += value.off <= kFar ? pixels : 0.0;
    coloured += high - low >= kColoured ? pixels : 0.0;
    tenths[static_cast<std::size_t>(value.at / kTenth)] += pixels;
  }
  const auto used = std::count_if(tenths.begin(), tenths.end(), [&](double pixels) { return 100.0 * pixels >= all; });
  return all > 0.0 && many >= kLeastColours && near >= (is_even ? kMostNear : kNearlyAll) * all &&
         about >= kNearlyAll * all && coloured >= kMostColoured * all && static_cast<std::size_t>(used) >= kLeastTenths;
}

}  // namespace

std::optional<ScaledValues> values_of_colour_scale(const RgbImage& image) {
  const std::vector<std::pair<Rgb, std::size_t>> colours = coarse_colours(image);
  for (const NamedScale& named : kScales) {
    const Scale scale(named.type);
    if (!is_drawn_in(scale, named.is_even, colours)) continue;
    ScaledValues out{image, named.name};
    std::unordered_map<std::uint32_t, std::uint8_t> known;
    league::each_run(image, [&](const league::Colour&, int first, int y, int length) {
      const Rgb colour = league::rgb_of(image.pixel(first, y));
      const std::uint32_t key = std::uint32_t{colour[0]} << 16U | std::uint32_t{colour[1]} << 8U | colour[2];
      const auto [at, is_new] = known.try_emplace(key);
      if (is_new) at->second = scale.value_of(colour).at;
      std::fill_n(out.greys.pixel(first, y), 3 * length, at->second);
    });
    return out;
  }
  return std::nullopt;
}

}  // namespace rubble::scoring
