#include "scoring/maps/colours/lossy_colours.h"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

namespace rubble::scoring {
namespace {

/// The pieces of `weak` that have so many pixels of `sure` in them.
cv::Mat grown_from(const cv::Mat& sure, const cv::Mat& weak, int least = 1) {
  cv::Mat labels;
  const int count = cv::connectedComponents(weak, labels, 8, CV_32S);
  std::vector<int> holds(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (sure.at<unsigned char>(y, x) != 0) ++holds[static_cast<std::size_t>(labels.at<int>(y, x))];
  cv::Mat out = weak.clone();
  for (int y = 0; y < weak.rows; ++y)
    for (int x = 0; x < weak.cols; ++x)
      if (holds[static_cast<std::size_t>(labels.at<int>(y, x))] < least) out.at<unsigned char>(y, x) = 0;
  return out;
}

constexpr float kWallBrightness = 37.0F;  // of 0,40,120
constexpr float kWallBlue = 46.8F, kWallRed = -26.3F;
constexpr float kFloorBlue = -33.1F, kFloorRed = -41.8F;  // of searched floor
constexpr float kMostBlue = 60.0F;                        // Cb of walls; smeared blue letters keep 65
constexpr double kWide = 2.5;                             // sigma of the wider smear [pixels]
constexpr int kReach = 48;  // of all filters together, where a band of rows is cut off [pixels]
constexpr int kBand = 512;  // rows that are worked on at a time

/// Brightness and the two differences of colour of YCbCr: JPEG keeps the first sharp and smears the others.
struct Planes {
  cv::Mat light;  ///< CV_32F
  cv::Mat blue;   ///< CV_32F, Cb: 47 in a wall, 50 in the path, -39 in a victim, 115 in QR codes, -33 on searched floor
  cv::Mat red;    ///< CV_32F, Cr: -26 in a wall, 48 in the path, 115 in a victim, -42 on searched floor
};

/// Of these rows.
Planes planes_of(const RgbImage& image, const cv::Range& rows) {
  Planes out;
  for (cv::Mat* m : {&out.light, &out.blue, &out.red}) *m = cv::Mat(rows.size(), image.width, CV_32F);
  for (int y = 0; y < rows.size(); ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, rows.start + y);
      const float light = 0.299F * p[0] + 0.587F * p[1] + 0.114F * p[2];
      out.light.at<float>(y, x) = light;
      out.blue.at<float>(y, x) = 0.564F * (p[2] - light);
      out.red.at<float>(y, x) = 0.713F * (p[0] - light);
    }
  return out;
}

/// What the picture would be without lines: as bright as the brightest within a wall's width, and of the colour that
/// such pixels near by have on the average.
Planes ground_of(const Planes& picture) {
  constexpr int kWidestLine = 9;      // [pixels]
  constexpr float kDarkest = 150.0F;  // of ground
  constexpr float kAsBright = 24.0F;  // as the ground, or nearly
  constexpr double kNear = 4.0, kFar = 12.0;
  Planes out;
  cv::morphologyEx(picture.light, out.light, cv::MORPH_CLOSE, cv::Mat::ones(kWidestLine, kWidestLine, CV_8U));
  out.light = cv::max(out.light, kDarkest);
  cv::Mat bare;  // without the pixels to which a line gave of its colour
  cv::Mat(picture.light >= out.light - kAsBright).convertTo(bare, CV_32F, 1.0 / 255.0);
  const auto mean = [&](const cv::Mat& plane) {
    cv::Mat sum, weight, far_sum, far_weight;
    cv::GaussianBlur(plane.mul(bare), sum, {}, kNear);
    cv::GaussianBlur(bare, weight, {}, kNear);
    cv::GaussianBlur(plane.mul(bare), far_sum, {}, kFar);
    cv::GaussianBlur(bare, far_weight, {}, kFar);
    constexpr float kLittle = 0.02F;  // of the nearer ones: those further off say the rest
    return cv::Mat((sum + kLittle * far_sum) / (weight + kLittle * far_weight + 1e-6F));
  };
  out.light = mean(picture.light);  // the brightest are so by the ripples beside lines
  cv::erode(bare, bare, cv::Mat::ones(3, 3, CV_8U));
  const cv::Mat blue = mean(picture.blue), red = mean(picture.red);
  // Ground is grey or searched floor. Of what lines gave it, it keeps nothing: that would count against them.
  const float both = kWallBlue * kFloorRed - kFloorBlue * kWallRed;
  const cv::Mat green = cv::max((kWallBlue * red - kWallRed * blue) / both, 0.0F);
  out.blue = kFloorBlue * green;
  out.red = kFloorRed * green;
  return out;
}

/// The colour of the ink itself: what it adds to the ground's around each pixel (Gaussian, `sigma`), summed and divided
/// by the ink: all that is as dark as `least` counts. JPEG leaves ripples of ink beside lines, blurring skirts of them.
Planes of_ink(const Planes& picture, const Planes& ground, const cv::Mat& ink, double sigma, float least) {
  cv::Mat counted = ink.clone(), around, blue, red;
  counted.setTo(0.0F, ink < least);
  cv::GaussianBlur(counted, around, {}, sigma);
  around = cv::max(around, 1e-6F);
  cv::GaussianBlur(picture.blue - ground.blue, blue, {}, sigma);
  cv::GaussianBlur(picture.red - ground.red, red, {}, sigma);
  return {around, ground.blue + blue / around, ground.red + red / around};
}

/// The middles of thin lines, along one direction at least: no paler than the pixels beside them, and those two to
/// `widest` pixels off are less than half as dark. Pictures made smaller, or blurred, have walls that are nowhere as
/// dark as they were.
cv::Mat thin_lines(const cv::Mat& ink, const cv::Mat& ground, int widest) {
  constexpr float kPalest = 0.25F;
  constexpr float kGridLine = 190.0F, kDarker = 0.15F;
  cv::Mat out = cv::Mat::zeros(ink.size(), CV_8U);
  const auto is_middle = [&](int x, int y, int dx, int dy) {
    const auto at = [&](int k) { return ink.at<float>(y + k * dy, x + k * dx); };
    const float own = at(0);
    if (own < at(-1) || own < at(1)) return false;
    for (int k = 2; k <= widest; ++k)
      if (2.0F * std::max(at(-k), at(k)) < own) return true;
    return false;
  };
  for (int y = widest; y + widest < ink.rows; ++y)
    for (int x = widest; x + widest < ink.cols; ++x) {
      const float light = ground.at<float>(y, x);
      const float of_grid = (light - kGridLine) / (light - kWallBrightness);  // 0.3 on white
      if (ink.at<float>(y, x) >= std::max(kPalest, of_grid + kDarker) &&
          (is_middle(x, y, 1, 0) || is_middle(x, y, 0, 1)))
        out.at<unsigned char>(y, x) = 255;
    }
  return out;
}

/// What is as dark and blue as a wall in these rows: perhaps (`weak`) and without doubt.
void dark_in(const RgbImage& image, const cv::Range& band, cv::Mat& weak, cv::Mat& sure) {
  constexpr float kSure = 0.62F;
  constexpr float kWall = 0.48F;
  constexpr float kSureLine = 0.35F, kBlurredLine = 0.28F;
  constexpr float kLine = 0.25F, kSkirt = 0.03F;  // ink that counts
  constexpr float kClearly = 42.0F, kMostMore = 70.0F, kRedder = 12.0F, kBluer = 16.0F;
  const cv::Range rows(std::max(0, band.start - kReach), std::min(image.height, band.end + kReach));
  const Planes picture = planes_of(image, rows);
  const Planes ground = ground_of(picture);
  const cv::Mat ink = (ground.light - picture.light) / (ground.light - kWallBrightness);
  // Between symbols the colour near by is the wall's own, in the open the one around.
  const Planes near = of_ink(picture, ground, ink, 1.0, kLine);
  const Planes wide = of_ink(picture, ground, ink, kWide, kLine);
  const Planes with_skirts = of_ink(picture, ground, ink, kWide, kSkirt);
  const cv::Mat line = thin_lines(ink, ground.light, 2);
  const cv::Mat blurred_line = thin_lines(ink, ground.light, 4);
  cv::Mat blurred = cv::Mat::zeros(weak.size(), CV_8U);
  for (int y = 0; y < weak.rows; ++y) {
    const int at = band.start - rows.start + y;
    for (int x = 0; x < weak.cols; ++x) {
      const float a = ink.at<float>(at, x);
      // Blue less red is 73 for walls, 2 for the path, 0 for black and 9 for searched floor, to which smears tend, and
      // more for blue letters.
      const auto is = [&](const Planes& c, float least, float most_red, float most_blue) {
        const float blue = c.blue.at<float>(at, x), red = c.red.at<float>(at, x), more = blue - red;
        const bool plain = more > least && red < most_red && blue < most_blue;
        return plain || (more > kClearly && more < kMostMore && red < most_red + kRedder && blue < most_blue + kBluer);
      };
      const bool thin = line.at<unsigned char>(at, x) != 0;
      const bool dark = a >= kWall || thin, very_dark = a >= kSure || (thin && a >= kSureLine);
      weak.at<unsigned char>(y, x) =
          dark && (is(wide, 21.0F, 8.0F, kMostBlue) || is(near, 27.0F, 4.0F, 46.0F)) ? 255 : 0;
      sure.at<unsigned char>(y, x) = very_dark && is(wide, 31.0F, 2.0F, kMostBlue) ? 255 : 0;
      if (blurred_line.at<unsigned char>(at, x) != 0 && a >= kBlurredLine && is(with_skirts, 31.0F, 2.0F, kMostBlue))
        blurred.at<unsigned char>(y, x) = 255;
    }
  }
  // Sharp pictures have such pixels, too: where two walls meet.
  if (cv::countNonZero(blurred) < 2 * cv::countNonZero(sure)) return;
  weak |= blurred;
  sure |= blurred;
}

}  // namespace

bool has_few_colours(const RgbImage& image, std::size_t most) {
  std::set<Rgb> seen;
  const std::uint8_t* last = nullptr;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const std::uint8_t* const p = &image.rgb[i];
    if (last != nullptr && std::equal(p, p + 3, last)) continue;
    last = p;
    seen.insert({p[0], p[1], p[2]});
    if (seen.size() > most) return false;
  }
  return true;
}

bool has_run_colours(const RgbImage& image) {
  constexpr std::size_t kPalette = 256;
  if (has_few_colours(image, kPalette)) return false;
  constexpr int kFaint = 3;  // spread of the channels
  constexpr int kStrong = 24;
  std::size_t faint = 0;
  std::size_t strong = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const auto [low, high] = std::minmax({int{p[0]}, int{p[1]}, int{p[2]}});
      const bool searched = p[1] == high && std::abs(p[0] - p[2]) <= 4;
      if (high - low >= kStrong)
        ++strong;
      else if (high - low >= kFaint && !searched)
        ++faint;
    }
  return 20 * faint > 21 * strong;
}

cv::Mat walls_by_brightness(const RgbImage& image) {
  cv::Mat weak(image.height, image.width, CV_8U);
  cv::Mat sure(image.height, image.width, CV_8U);
  for (int from = 0; from < image.height; from += kBand) {
    const cv::Range band(from, std::min(image.height, from + kBand));
    cv::Mat weak_here = weak.rowRange(band), sure_here = sure.rowRange(band);
    dark_in(image, band, weak_here, sure_here);
  }
  constexpr int kSpeck = 3;  // pixels of the grid that JPEG made darker and tinted are fewer
  return grown_from(sure & weak, weak, kSpeck);
}

cv::Mat unexplored_by_brightness(const RgbImage& image) {
  constexpr int kEven = 7;       // [pixels]
  constexpr float kWay = 12.0F;  // Cb and Cr of what may be the way, whose own are 50 and 48
  cv::Mat brightness(image.height, image.width, CV_8U);
  cv::Mat by_the_way(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const float light = 0.299F * p[0] + 0.587F * p[1] + 0.114F * p[2];
      const bool may_be_way = 0.564F * (p[2] - light) > kWay && 0.713F * (p[0] - light) > kWay;
      by_the_way.at<unsigned char>(y, x) = may_be_way ? 255 : 0;
      brightness.at<unsigned char>(y, x) =
          static_cast<unsigned char>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  // Where the way of the robot meets the grid, both blur to the same shade; ground has it evenly somewhere, or away
  // from the way.
  cv::dilate(by_the_way, by_the_way, cv::Mat::ones(kEven, kEven, CV_8U));
  cv::Mat darkest, lightest;
  cv::erode(brightness, darkest, cv::Mat::ones(kEven, kEven, CV_8U));
  cv::dilate(brightness, lightest, cv::Mat::ones(kEven, kEven, CV_8U));
  // The grid of explored ground, lines of a pixel or two, is no shade of it.
  cv::morphologyEx(brightness, brightness, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat middle;
  cv::medianBlur(brightness, middle, 5);
  const cv::Mat weak = (middle >= 220) & (middle <= 246);
  const cv::Mat even = (darkest >= 212) & (lightest <= 248);
  return grown_from(weak & (even | ~by_the_way), weak);
}

}  // namespace rubble::scoring
