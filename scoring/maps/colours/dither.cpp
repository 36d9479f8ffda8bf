#include "scoring/maps/colours/dither.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/half_width.h"
#include "scoring/maps/colours/nearest_ground.h"

namespace rubble::scoring {
namespace {

constexpr std::size_t kMostGreys = 8;  // of a dithered picture
constexpr double kLeastDots = 0.02;    // of the pixels: greys that differ from all four around
constexpr double kMostPairs = 0.5;     // of few dots those that touch another: dithers keep them apart, salt does not
constexpr double kFewDots = 0.12;      // of the pixels around, where that is asked
constexpr int kRun = 5;                // pixels of the darkest grey in a line that no dots make
constexpr int kFarEnough = 25;         // greys of two grounds that dots can tell apart
constexpr int kRounds = 4;             // of looking for walls: those found make grounds purer, and purer ones show more
constexpr int kSteps = 24;             // of spreading, each by a pixel: half of a passage of 1.2 m at 0.025 m
constexpr double kLeastOfGround = 0.01;  // of the pixels
constexpr int kOneGround = 12;           // greys that the means of one ground differ by

/// Pixels that differ from all four around them.
cv::Mat dots_of(const cv::Mat& grey) {
  cv::Mat out(grey.size(), CV_8U, cv::Scalar(0));
  for (int y = 1; y + 1 < grey.rows; ++y)
    for (int x = 1; x + 1 < grey.cols; ++x) {
      const unsigned char own = grey.at<unsigned char>(y, x);
      if (own != grey.at<unsigned char>(y - 1, x) && own != grey.at<unsigned char>(y + 1, x) &&
          own != grey.at<unsigned char>(y, x - 1) && own != grey.at<unsigned char>(y, x + 1))
        out.at<unsigned char>(y, x) = 255;
    }
  return out;
}

/// Salt falls anywhere: of few dots many touch another one. A dither keeps them as far apart as it can.
bool keep_apart(const cv::Mat& dots) {
  constexpr int kAround = 9;           // [pixels]: the periods of ordered dithers, 2 to 8, and no less than a few dots
  constexpr double kLeastAsked = 0.2;  // of the dots: fewer say nothing
  constexpr double kNeighbours = 8.0;  // any of which a dot at random may be
  cv::Mat around;
  cv::Mat there;
  dots.convertTo(there, CV_32F, 1.0 / 255.0);
  cv::boxFilter(there, around, CV_32F, {kAround, kAround});
  const cv::Mat few = dots & (around < kFewDots);
  const int asked = cv::countNonZero(few);
  if (asked < static_cast<int>(kLeastAsked * cv::countNonZero(dots))) return true;
  cv::Mat ring = cv::Mat::ones(3, 3, CV_32F), touching;
  ring.at<float>(1, 1) = 0.0F;
  cv::filter2D(there, touching, CV_32F, ring);
  // As often as at random, or less than half of that.
  const double share = cv::mean(around, few)[0];
  const double random = 1.0 - std::pow(1.0 - share, kNeighbours);
  return cv::countNonZero(few & (touching > 0.5F)) < kMostPairs * random * asked;
}

/// OpenCV's own opening shifts by a pixel where the brush is of even width.
cv::Mat opened(const cv::Mat& mask, int width, int height) {
  const cv::Mat brush = cv::Mat::ones(height, width, CV_8U);
  cv::Mat out;
  cv::erode(mask, out, brush, {width / 2, height / 2}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::dilate(out, out, brush, {width - 1 - width / 2, height - 1 - height / 2});
  return out;
}

/// What is solid: runs along a row or a column, with what touches them and is not alone.
cv::Mat solid(const cv::Mat& dark, int run) {
  const cv::Mat sure = opened(dark, run, 1) | opened(dark, 1, run) | opened(dark, 3, 2) | opened(dark, 2, 3);
  cv::Mat near;  // where it goes on
  cv::dilate(sure, near, cv::Mat::ones(3, 3, CV_8U));
  return sure | ((opened(dark, 2, 1) | opened(dark, 1, 2)) & near);
}

/// Mean of the ground around each pixel, as far as it is connected with it.
cv::Mat spread_within(const cv::Mat& grey, const cv::Mat& walls) {
  cv::Mat weight, sum;
  cv::Mat(~walls).convertTo(weight, CV_32F, 1.0 / 255.0);
  grey.convertTo(sum, CV_32F);
  sum = sum.mul(weight);
  const cv::Mat ground = weight.clone();
  const cv::Mat cross = (cv::Mat_<float>(3, 3) << 0, 1, 0, 1, 1, 1, 0, 1, 0);
  cv::Mat mean = sum.clone();
  for (int i = 0; i < kSteps; ++i) {
    cv::filter2D(mean, sum, CV_32F, cross, {-1, -1}, 0, cv::BORDER_REPLICATE);
    if (i == 0) cv::filter2D(ground, weight, CV_32F, cross, {-1, -1}, 0, cv::BORDER_REPLICATE);
    mean = sum.mul(ground) / cv::max(weight, 1.0F);
  }
  return mean;
}

/// Means that most of the ground has, the most frequent first.
std::vector<int> means_of_grounds(const cv::Mat& mean, const cv::Mat& walls) {
  std::array<double, 256> count{};
  for (int y = 0; y < mean.rows; ++y)
    for (int x = 0; x < mean.cols; ++x)
      if (walls.at<unsigned char>(y, x) == 0)
        count[static_cast<std::size_t>(std::clamp(std::lround(mean.at<float>(y, x)), 0L, 255L))] += 1.0;
  std::vector<int> out;
  const double least = kLeastOfGround * static_cast<double>(mean.total());
  constexpr std::size_t kMost = 4;  // free, unknown, a page and a window around
  constexpr int kSpread = 2;        // of the means of one ground, beside the most frequent
  while (out.size() < kMost) {
    int best = -1;
    double most = 0.0;
    for (int g = 0; g < 256; ++g) {
      double here = 0.0;
      for (int k = std::max(0, g - kSpread); k <= std::min(255, g + kSpread); ++k)
        here += count[static_cast<std::size_t>(k)];
      if (here <= most) continue;
      most = here;
      best = g;
    }
    if (best < 0) break;
    for (int k = std::max(0, best - kOneGround); k <= std::min(255, best + kOneGround); ++k)
      count[static_cast<std::size_t>(k)] = 0.0;
    if (most < least) break;
    out.push_back(best);
  }
  return out;
}

/// Least difference of two grounds.
int least_apart(std::vector<int> grounds) {
  std::sort(grounds.begin(), grounds.end());
  int least = 255;
  for (std::size_t i = 0; i + 1 < grounds.size(); ++i) least = std::min(least, grounds[i + 1] - grounds[i]);
  return least;
}

/// Each pixel's ground: the one whose mean is nearest.
cv::Mat nearest_ground_of(const cv::Mat& mean, const std::vector<int>& grounds) {
  cv::Mat out(mean.size(), CV_8U);
  for (int y = 0; y < mean.rows; ++y)
    for (int x = 0; x < mean.cols; ++x) {
      const auto here = static_cast<int>(std::lround(mean.at<float>(y, x)));
      out.at<unsigned char>(y, x) = static_cast<unsigned char>(*std::min_element(
          grounds.begin(), grounds.end(), [here](int a, int b) { return std::abs(a - here) < std::abs(b - here); }));
    }
  return out;
}

/// Those that cover areas; beside ragged walls the mean may be any.
std::vector<int> broad_grounds(const cv::Mat& mean, const cv::Mat& walls) {
  constexpr int kArea = 9;  // [pixels]
  const std::vector<int> all = means_of_grounds(mean, walls);
  if (all.empty()) return all;
  const cv::Mat nearest = nearest_ground_of(mean, all);
  std::vector<int> out;
  for (const int ground : all) {
    const cv::Mat here = (nearest == ground) & ~walls;
    if (2 * cv::countNonZero(opened(here, kArea, kArea)) >= cv::countNonZero(here)) out.push_back(ground);
  }
  return out;
}

/// Without patches of a ground that are narrow, as beside ragged walls: they are of the ground around.
void drop_patches(const std::vector<int>& grounds, const cv::Mat& walls, cv::Mat& ground) {
  constexpr int kNarrow = 7;  // [pixels]
  cv::Mat kept = cv::Mat::zeros(ground.size(), CV_8U), near;
  for (const int level : grounds) {
    const cv::Mat here = (ground == level) & ~walls;
    cv::dilate(opened(here | walls, kNarrow, kNarrow) & here, near, cv::Mat::ones(3, 3, CV_8U));
    kept |= near & here;
  }
  if (cv::countNonZero(kept) > 0) carry_ground(~kept, ground);
}

/// Darkest pixels that have more of their kind around them than dots of that ground can have: these keep apart. Ground
/// lighter than the `next` grey has none.
cv::Mat crowded(const cv::Mat& dark, const cv::Mat& walls, const cv::Mat& ground, int darkest, int next) {
  constexpr double kNone = 0.02;  // share of dots: of two in 5 x 5 pixels one is none
  // Dots in 3 x 3 pixels, at the most, of grounds with less than such a share of them: nine times the share and what is
  // missing to the next whole number, since dithers spread their dots evenly. From 0.56 on nine are nothing strange.
  struct Bound {
    double share;
    int dots;
  };
  constexpr std::array<Bound, 6> kBounds{{{0.0, 0}, {0.1, 1}, {0.16, 2}, {0.27, 3}, {0.4, 4}, {0.56, 6}}};
  constexpr int kAll = 9;
  cv::Mat there, count, wide, out = cv::Mat::zeros(dark.size(), CV_8U);
  dark.convertTo(there, CV_8U, 1.0 / 255.0);
  cv::boxFilter(there, count, CV_8U, {3, 3}, {-1, -1}, false, cv::BORDER_REPLICATE);
  cv::boxFilter(there, wide, CV_8U, {5, 5}, {-1, -1}, false, cv::BORDER_REPLICATE);
  cv::Mat darkest_near;  // where two grounds meet
  cv::erode(ground, darkest_near, cv::Mat::ones(5, 5, CV_8U));
  for (int y = 0; y < dark.rows; ++y)
    for (int x = 0; x < dark.cols; ++x) {
      if (dark.at<unsigned char>(y, x) == 0 || walls.at<unsigned char>(y, x) != 0) continue;
      const double share = static_cast<double>(next - darkest_near.at<unsigned char>(y, x)) / (next - darkest);
      const auto* const bound =
          std::find_if(kBounds.begin(), kBounds.end(), [share](const Bound& b) { return share < b.share; });
      const int most = bound == kBounds.end() ? kAll : bound->dots;
      if (count.at<unsigned char>(y, x) > most || (share < kNone && wide.at<unsigned char>(y, x) > 1))
        out.at<unsigned char>(y, x) = 255;
    }
  return out;
}

/// What is solid in the darkest grey covers areas, in the lightest it is thin.
bool are_lines_white(const cv::Mat& grey) {
  constexpr double kThinLine = 2.5;  // mean distance to the rim [pixels]
  double least = 0.0, most = 0.0;
  cv::minMaxLoc(grey, &least, &most);
  const double light = mean_half_width(solid(grey == most, kRun));
  return light > 0.0 && light <= kThinLine && mean_half_width(solid(grey == least, kRun)) > kThinLine;
}

std::optional<Undithered> with_dark_walls(const cv::Mat& grey) {
  const std::vector<int> greys = greys_there(grey);
  const cv::Mat dots = dots_of(grey);
  if (cv::countNonZero(dots) < kLeastDots * static_cast<double>(grey.total()) || !keep_apart(dots)) return std::nullopt;
  Undithered out;
  out.how = "dots of " + std::to_string(greys.size()) + " greys read as those between";
  const cv::Mat dark = grey == greys.front();
  cv::Mat walls = solid(dark, kRun), ground;
  for (int i = 0; i < kRounds; ++i) {
    const cv::Mat mean = spread_within(grey, walls);
    const std::vector<int> grounds = broad_grounds(mean, walls);
    if (grounds.empty()) return std::nullopt;
    ground = nearest_ground_of(mean, grounds);
    drop_patches(grounds, walls, ground);
    out.lost.clear();
    if (least_apart(grounds) < kFarEnough)
      out.lost = "was dithered to " + std::to_string(greys.size()) +
                 " greys, and the grounds that its dots stand for are too much alike to be told apart; give it in the "
                 "greys or colours that it had";
    if (i + 1 < kRounds) walls |= crowded(dark, walls, ground, greys[0], greys[1]);
  }
  out.grey = ground;
  out.grey.setTo(greys.front(), walls);
  return out;
}

}  // namespace

std::optional<Undithered> without_dither(const cv::Mat& grey) {
  const std::size_t greys = greys_there(grey).size();
  if (greys < 2 || greys > kMostGreys) return std::nullopt;
  if (!are_lines_white(grey)) return with_dark_walls(grey);
  std::optional<Undithered> out = with_dark_walls(~grey);
  if (out) out->grey = ~out->grey;
  return out;
}

}  // namespace rubble::scoring
