#include "scoring/maps/colours/checkerboard.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
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

/// Where corners were found last, column by column: a large picture may have a million of them.
class Found {
 public:
  explicit Found(int width) : last_(static_cast<std::size_t>(width), -kDistance) {}
  void add(int x, int y) { last_[static_cast<std::size_t>(x)] = y; }
  /// Whether one was found beside this place. They come row by row.
  bool near(int x, int y) const {
    const auto first = last_.begin() + std::max(0, x - kDistance + 1);
    const auto end = last_.begin() + std::min(static_cast<int>(last_.size()), x + kDistance);
    return std::any_of(first, end, [y](int row) { return y - row < kDistance; });
  }

 private:
  std::vector<int> last_;  ///< row
};

/// Corners between pixels (x, y) and (x + 1, y + 1).
std::vector<Corner> corners_of(const RgbImage& image, int channel) {
  std::vector<Corner> out;
  Found found(image.width);
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
      if (found.near(x, y)) continue;
      found.add(x, y);
      out.push_back({x, y, a < b});
    }
  return out;
}

/// Lessens `next` to each corner's distance to the nearest one in its line (or in those beside it) whose squares are
/// the other way round, where a square reaches as far; 0: none yet. `along`, `across`: x and y for rows, y and x for
/// columns.
void look_along(const std::vector<Corner>& corners, int Corner::*along, int Corner::*across, std::vector<int>& next) {
  std::vector<Corner> lines = corners;
  const auto place_of = [&](const Corner& c) { return std::pair(c.*across, c.*along); };
  std::sort(lines.begin(), lines.end(), [&](const Corner& a, const Corner& b) { return place_of(a) < place_of(b); });
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& own = corners[i];
    // Squares change from corner to corner, so the first one that is the other way round is near.
    const auto try_it = [&](const Corner& other, int line) {
      const int distance = std::abs(other.*along - own.*along);
      if (other.*across != line || distance > kLargest) return true;
      if (other.dark_first == own.dark_first) return false;
      if (next[i] == 0 || distance < next[i]) next[i] = distance;
      return true;
    };
    for (int line = own.*across - 1; line <= own.*across + 1; ++line) {
      const auto from = std::lower_bound(lines.begin(), lines.end(), std::pair(line, own.*along),
                                         [&](const Corner& c, const auto& place) { return place_of(c) < place; });
      for (auto ahead = from; ahead != lines.end() && !try_it(*ahead, line);) ++ahead;
      for (auto behind = from; behind != lines.begin() && !try_it(*std::prev(behind), line);) --behind;
    }
  }
}

/// The corners that have a next one in their row or column at the distance that most have: those of a board.
std::vector<Corner> on_a_lattice(const std::vector<Corner>& corners) {
  std::map<int, int> often;
  std::vector<int> next(corners.size(), 0);
  look_along(corners, &Corner::x, &Corner::y, next);
  look_along(corners, &Corner::y, &Corner::x, next);
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
