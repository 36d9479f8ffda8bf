#include "scoring/maps/colours/checkerboard.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

namespace rubble::scoring {
namespace {

constexpr int kEven = 2;        // differences within a square, and of two that are alike
constexpr int kApart = 3;       // least difference of two squares
constexpr int kFarthest = 128;  // greatest one: black and white tiles are a picture of something else
constexpr int kFirst = 3;       // pixels beside the corner that may be blended or sharpened
constexpr int kSide = 4;        // of what is looked at of each square [pixels]
constexpr int kLargest = 100;   // square [pixels]
constexpr int kDistance = 5;    // of two corners at the least [pixels]
constexpr double kEnds = 0.05;  // left out at either end

/// Value of a square beside the corner, or -1 where it is not even. `right`, `below`: which of the four.
int square(const RgbImage& image, int channel, int x, int y, bool right, bool below) {
  int low = 255, high = 0, sum = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int value = image.pixel(right ? x + 1 + kFirst + i : x - kFirst - i,
                                    below ? y + 1 + kFirst + j : y - kFirst - j)[channel];
      low = std::min(low, value);
      high = std::max(high, value);
      sum += value;
    }
  return high - low > kEven ? -1 : (sum + kSide * kSide / 2) / (kSide * kSide);
}

struct Corner {
  int x = 0, y = 0;
  bool dark_first = false;  ///< the upper left square is the darker one
};

/// Whether a corner was found beside this one. They come row by row: what is near was found last.
bool is_known(const std::vector<Corner>& found, int x, int y) {
  for (auto one = found.rbegin(); one != found.rend() && y - one->y < kDistance; ++one)
    if (std::abs(one->x - x) < kDistance) return true;
  return false;
}

/// Corners between pixels (x, y) and (x + 1, y + 1).
std::vector<Corner> corners_of(const RgbImage& image, int channel) {
  std::vector<Corner> out;
  const int reach = kFirst + kSide;
  for (int y = reach; y + reach + 1 < image.height; ++y)
    for (int x = reach; x + reach + 1 < image.width; ++x) {
      const int a = image.pixel(x - reach + 1, y - reach + 1)[channel],
                b = image.pixel(x + reach, y - reach + 1)[channel];
      const int c = image.pixel(x - reach + 1, y + reach)[channel], d = image.pixel(x + reach, y + reach)[channel];
      if (std::abs(a - d) > kEven || std::abs(b - c) > kEven) continue;
      const int apart = std::abs(a - b);
      if (apart < kApart || apart > kFarthest) continue;
      const std::array<int, 4> at{square(image, channel, x, y, false, false), square(image, channel, x, y, true, false),
                                  square(image, channel, x, y, false, true), square(image, channel, x, y, true, true)};
      if (*std::min_element(at.begin(), at.end()) < 0) continue;
      if (std::abs(at[0] - at[3]) > kEven || std::abs(at[1] - at[2]) > kEven) continue;
      if (!is_known(out, x, y)) out.push_back({x, y, a < b});
    }
  return out;
}

/// The corners that have a next one in their row or column at the distance that most have: those of a board.
std::vector<Corner> on_a_lattice(const std::vector<Corner>& corners) {
  std::map<int, int> often;
  std::vector<int> next(corners.size(), 0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = i + 1; k < corners.size() && corners[k].y - corners[i].y <= kLargest; ++k) {
      const int dx = std::abs(corners[k].x - corners[i].x), dy = corners[k].y - corners[i].y;
      if ((dx > 1 && dy > 1) || dx > kLargest) continue;
      if (corners[k].dark_first == corners[i].dark_first) continue;  // squares change from corner to corner
      const int distance = std::max(dx, dy);
      if (next[i] == 0 || distance < next[i]) next[i] = distance;
      if (next[k] == 0 || distance < next[k]) next[k] = distance;
    }
  for (const int distance : next)
    if (distance > 0) ++often[distance];
  int side = 0;
  for (const auto& [distance, times] : often)
    if (side == 0 || times > often[side]) side = distance;
  std::vector<Corner> out;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (side > 0 && std::abs(next[i] - side) <= 1) out.push_back(corners[i]);
  return out;
}

int middle_of(std::vector<int> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

Checkerboard find_checkerboard(const RgbImage& image) {
  std::vector<Corner> corners;
  int of = 0;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<Corner> here = on_a_lattice(corners_of(image, channel));
    if (here.size() <= corners.size()) continue;
    corners = std::move(here);
    of = channel;
  }
  Checkerboard out;
  out.crossings = corners.size();
  if (corners.empty()) return out;
  std::vector<int> levels;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<int> dark, light;
    for (const Corner& c : corners) {
      const int first = image.pixel(c.x - kFirst - 1, c.y - kFirst - 1)[channel];
      const int second = image.pixel(c.x + 1 + kFirst + 1, c.y - kFirst - 1)[channel];
      dark.push_back(c.dark_first ? first : second);
      light.push_back(c.dark_first ? second : first);
    }
    const auto at = static_cast<std::size_t>(channel);
    if (channel == of) levels = dark;
    out.darker[at] = static_cast<std::uint8_t>(middle_of(std::move(dark)));
    out.lighter[at] = static_cast<std::uint8_t>(middle_of(std::move(light)));
  }
  std::sort(levels.begin(), levels.end());
  const auto left_out = static_cast<std::size_t>(kEnds * static_cast<double>(levels.size()));
  out.unevenness = levels[levels.size() - 1 - left_out] - levels[left_out];
  return out;
}

}  // namespace rubble::scoring
