#include "scoring/maps/colours/grey_roles.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "scoring/maps/colours/half_width.h"

namespace rubble::scoring {
namespace {

constexpr int kTolerance = 12;          // of the levels of a picture that is not pure
constexpr double kShare = 0.01;         // of all pixels, to be a level and not the fringe of the walls
constexpr double kWallShare = 0.001;    // of all pixels
constexpr double kPureShare = 0.999;    // of the pixels on the main levels
constexpr std::size_t kPureLevels = 4;  // three and a canvas
constexpr int kAlike = 2;               // greys apart
constexpr double kThin = 2.5;           // mean distance of a wall's pixels to its rim, at the most [pixels]
constexpr double kThinner = 0.4;        // of the darkest level's, for another level to be the walls
constexpr double kGround = 1.8;         // mean distance to the rim; fringes of walls have less [pixels]
constexpr double kClosedGround = 1.6;   // the same without the speckles of a lossy picture; fringes have 1.3
constexpr double kBroad = 4.0;          // mean distance to the rim in an area [pixels]
constexpr int kWidest = 16;             // wall that has two sides [pixels]
constexpr int kFringe = 4;              // pixels between a wall and what lies beside it in a blended picture
constexpr double kConvincing = 3.0;     // times as many walls inside the other ground: the order of greys is wrong
constexpr int kAnywhere = 20;           // walls with two sides: fewer say nothing
constexpr unsigned char kMixed = 255;   // pixels of no level

struct Level {
  int grey = 0;
  double count = 0.0;
  double depth = 0.0;  ///< mean distance to the rim [pixels]
};

std::array<double, 256> histogram(const cv::Mat& grey, const cv::Mat& apart) {
  std::array<double, 256> out{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (apart.at<unsigned char>(y, x) == 0) out[grey.at<unsigned char>(y, x)] += 1.0;
  return out;
}

/// The most frequent grey, then the next that is clearly different, and so on. `tolerance`: of one level.
std::vector<Level> find_levels(std::array<double, 256> count, double total, int tolerance) {
  std::vector<Level> out;
  const auto within = [&](int grey, int reach) {
    double sum = 0.0;
    for (int g = std::max(0, grey - reach); g <= std::min(255, grey + reach); ++g)
      sum += count[static_cast<std::size_t>(g)];
    return sum;
  };
  while (out.size() < 12) {
    Level level;
    double most = 0.0;
    for (int g = 0; g < 256; ++g) {
      if (count[static_cast<std::size_t>(g)] <= 0.0) continue;
      // Of greys with as many around them the most frequent one.
      const double here = within(g, tolerance / 3) + 0.5 * count[static_cast<std::size_t>(g)];
      if (here <= most) continue;
      most = here;
      level.grey = g;
    }
    level.count = within(level.grey, tolerance);
    if (level.count < kWallShare * total || level.count <= 0.0) break;
    for (int g = std::max(0, level.grey - tolerance); g <= std::min(255, level.grey + tolerance); ++g)
      count[static_cast<std::size_t>(g)] = 0.0;
    out.push_back(level);
  }
  std::sort(out.begin(), out.end(), [](const Level& a, const Level& b) { return a.grey < b.grey; });
  return out;
}

/// Of two levels that nobody can tell apart the more frequent one.
void drop_alike(std::vector<Level>& levels) {
  for (std::size_t i = 0; i + 1 < levels.size();) {
    const bool alike = levels[i + 1].grey - levels[i].grey <= kAlike;
    if (alike)
      levels.erase(levels.begin() + static_cast<std::ptrdiff_t>(levels[i].count < levels[i + 1].count ? i : i + 1));
    if (!alike) ++i;
  }
}

cv::Mat label(const cv::Mat& grey, const cv::Mat& apart, const std::vector<Level>& levels, int tolerance) {
  cv::Mat table(1, 256, CV_8U, cv::Scalar(kMixed));
  for (std::size_t i = 0; i < levels.size(); ++i)
    for (int g = std::max(0, levels[i].grey - tolerance); g <= std::min(255, levels[i].grey + tolerance); ++g)
      table.at<unsigned char>(g) = static_cast<unsigned char>(i);
  cv::Mat out;
  cv::LUT(grey, table, out);
  out.setTo(kMixed, apart);
  return out;
}

/// `closed`: of the level without speckles in it.
double mean_depth(const cv::Mat& labels, std::size_t level, bool closed = false) {
  cv::Mat mask = labels == static_cast<int>(level);
  if (closed) cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  cv::copyMakeBorder(mask, mask, 1, 1, 1, 1, cv::BORDER_REPLICATE);
  return mean_half_width(mask);
}

/// What blending left between walls and a ground, where so few greys are left that each is a level: as light as that
/// ground or nearly, and nowhere but beside walls.
bool is_fringe(const cv::Mat& labels, const std::vector<Level>& levels, std::size_t level, std::size_t wall) {
  constexpr int kNearlyGround = 28;     // greys
  constexpr double kBesideWalls = 0.9;  // of its pixels
  const Level& own = levels[level];
  const bool shades = std::any_of(levels.begin(), levels.end(), [&](const Level& ground) {
    const bool between = (own.grey - levels[wall].grey > 0) == (ground.grey - own.grey > 0);
    return ground.depth >= kBroad && ground.grey != own.grey && std::abs(ground.grey - own.grey) <= kNearlyGround &&
           between;
  });
  if (level == wall || own.depth > kThin || !shades) return false;
  cv::Mat beside;
  cv::dilate(labels == static_cast<int>(wall), beside, cv::Mat::ones(3, 3, CV_8U));
  return cv::countNonZero(beside & (labels == static_cast<int>(level))) >= kBesideWalls * own.count;
}

/// How many walls have these two levels on their sides.
using Sides = std::vector<std::vector<double>>;

/// `fringe`: pixels beside a wall that are blended with it.
void count_sides(const unsigned char* at, int length, std::size_t wall, int fringe, Sides& out) {
  for (int i = 0; i < length; ++i) {
    if (at[i] != wall) continue;
    const int begin = i;
    while (i < length && at[i] == wall) ++i;
    const int before = begin - 1 - fringe, behind = i + fringe;
    if (i - begin > kWidest || before < 0 || behind >= length) continue;
    const unsigned char a = at[before], b = at[behind];
    if (a == kMixed || b == kMixed || a == wall || b == wall) continue;
    out[a][b] += 0.5;
    out[b][a] += 0.5;
  }
}

Sides sides_of(const cv::Mat& labels, std::size_t wall, std::size_t levels, int fringe) {
  Sides out(levels, std::vector<double>(levels, 0.0));
  for (int y = 0; y < labels.rows; ++y) count_sides(labels.ptr(y), labels.cols, wall, fringe, out);
  const cv::Mat columns = labels.t();
  for (int y = 0; y < columns.rows; ++y) count_sides(columns.ptr(y), columns.cols, wall, fringe, out);
  return out;
}

/// Walls that have the same ground on both sides.
double inner(const Sides& sides) {
  double most = 0.0;
  for (std::size_t i = 0; i < sides.size(); ++i) most = std::max(most, sides[i][i]);
  return most;
}

/// The darkest level is what white lines on dark ground leave beside them through JPEG or a sharp filter: it differs
/// far less from the grounds than they do.
bool are_ripples_beside(const std::vector<Level>& levels, int fringe) {
  constexpr int kStronger = 3;
  const Level &darkest = levels.front(), &lightest = levels.back();
  if (fringe == 0 || lightest.depth > kThin) return false;
  int low = 256, high = -1;  // grounds
  for (const Level& level : levels)
    if (level.depth > kThin) low = std::min(low, level.grey), high = std::max(high, level.grey);
  return high >= 0 && lightest.grey - high >= kStronger * (low - darkest.grey);
}

/// The level of the thin lines: the darkest, unless that covers areas and another one has grounds on both its sides;
/// then the lightest, or one between.
std::size_t wall_level(const std::vector<Level>& levels, const cv::Mat& labels, int fringe) {
  const Level& darkest = levels.front();
  if (darkest.depth <= kThin) return are_ripples_beside(levels, fringe) ? levels.size() - 1 : 0;
  const auto inner_walls = [&](std::size_t i) {
    return levels[i].depth > kThin || levels[i].depth > kThinner * darkest.depth
               ? 0.0
               : inner(sides_of(labels, i, levels.size(), fringe));
  };
  if (inner_walls(levels.size() - 1) >= kAnywhere) return levels.size() - 1;
  std::size_t best = 0;
  double most = kAnywhere;
  for (std::size_t i = 1; i + 1 < levels.size(); ++i) {
    const double here = inner_walls(i);
    if (here <= most) continue;
    most = here;
    best = i;
  }
  return best;
}

/// Share of the picture's rim that is of this level.
double rim_share(const cv::Mat& labels, std::size_t level) {
  double here = 0.0;
  double all = 0.0;
  const auto ask = [&](int x, int y) {
    const unsigned char l = labels.at<unsigned char>(y, x);
    if (l == kMixed) return;
    all += 1.0;
    here += l == level ? 1.0 : 0.0;
  };
  for (int x = 0; x < labels.cols; ++x) ask(x, 0), ask(x, labels.rows - 1);
  for (int y = 0; y < labels.rows; ++y) ask(0, y), ask(labels.cols - 1, y);
  return all > 0.0 ? here / all : 0.0;
}

/// Walls of a blended picture have many greys: all that are nearer to the darkest (or lightest) than to the nearest
/// ground.
void gather_walls(const cv::Mat& grey, const cv::Mat& apart, const std::vector<Level>& levels, std::size_t wall,
                  const Level& ground, const Level& other_ground, cv::Mat& labels) {
  const int darkest = std::min(ground.grey, other_ground.grey);
  const int lightest = std::max(ground.grey, other_ground.grey);
  const bool dark = levels[wall].grey < darkest;
  const int bound = (levels[wall].grey + (dark ? darkest : lightest)) / 2;
  const cv::Mat beyond = dark ? grey < bound : grey > bound;
  labels.setTo(static_cast<int>(wall), beyond & (apart == 0));
}

}  // namespace

std::string GreyRoles::text() const {
  return "wall " + std::to_string(wall) + (unknown < 0 ? "" : ", unknown " + std::to_string(unknown)) + ", free " +
         std::to_string(free);
}

GreyRoles grey_roles(const cv::Mat& grey, const cv::Mat& apart) {
  GreyRoles out;
  const std::array<double, 256> count = histogram(grey, apart);
  double total = 0.0;
  for (const double n : count) total += n;
  if (total <= 0.0) return out;
  std::array<double, 256> sorted = count;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  double most = 0.0;
  for (std::size_t i = 0; i < kPureLevels; ++i) most += sorted[i];
  out.pure = most >= kPureShare * total;
  const int tolerance = out.pure ? 0 : kTolerance;
  const int fringe = out.pure ? 0 : kFringe;
  std::vector<Level> levels = find_levels(count, total, tolerance);
  // White beside nearly white (paper around a map): no picture has two classes that nobody can tell apart.
  if (out.pure && levels.size() == kPureLevels) drop_alike(levels);
  cv::Mat labels = label(grey, apart, levels, tolerance);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].depth = mean_depth(labels, i);
    if (levels[i].depth >= kBroad && levels[i].count >= kShare * total) ++out.areas;
  }
  if (levels.empty()) return out;
  const std::size_t wall = wall_level(levels, labels, fringe);
  out.wall = levels[wall].grey;
  out.between = wall != 0 && wall + 1 != levels.size();
  std::vector<std::size_t> grounds;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (i != wall && levels[i].count >= kShare * total && !is_fringe(labels, levels, i, wall) &&
        (out.pure || levels[i].depth >= kGround || mean_depth(labels, i, true) >= kClosedGround))
      grounds.push_back(i);
  if (grounds.empty()) {
    out.free = out.wall < 128 ? 255 : 0;
    return out;
  }
  // Two greys that together cover most of the ground; others are shades of them.
  std::sort(grounds.begin(), grounds.end(),
            [&](std::size_t a, std::size_t b) { return levels[a].count > levels[b].count; });
  if (grounds.size() == 1) {
    out.free = levels[grounds[0]].grey;
    return out;
  }
  std::size_t free = grounds[0];
  std::size_t unknown = grounds[1];
  // In order: the one further from the walls is free.
  if (std::abs(levels[free].grey - out.wall) < std::abs(levels[unknown].grey - out.wall)) std::swap(free, unknown);
  if (!out.pure && !out.between) gather_walls(grey, apart, levels, wall, levels[free], levels[unknown], labels);
  const Sides sides = sides_of(labels, wall, levels.size(), fringe);
  const double within_free = sides[free][free];
  const double within_unknown = sides[unknown][unknown];
  const double free_rim = rim_share(labels, free);
  const double unknown_rim = rim_share(labels, unknown);
  // Laser maps of buildings leave specks of wall in unknown ground, many more than there are walls between two free
  // places. But a map lies in what is unknown, not in what is free: the picture's rim contradicts them.
  bool turn_about =
      within_unknown >= kAnywhere && within_unknown > kConvincing * within_free && free_rim >= unknown_rim;
  if (out.between && within_free + within_unknown < kAnywhere) turn_about = free_rim > unknown_rim;
  if (turn_about) std::swap(free, unknown);
  out.free = levels[free].grey;
  out.unknown = levels[unknown].grey;
  for (const std::size_t i : grounds)
    if (i != free && i != unknown && levels[i].depth > kThin) out.others.push_back(levels[i].grey);
  for (std::size_t i = 0; out.pure && i < levels.size(); ++i) {
    const int grey = levels[i].grey;
    if (i != wall && i != free && i != unknown && levels[i].depth <= kThin &&
        std::abs(grey - out.wall) > std::min(std::abs(grey - out.free), std::abs(grey - out.unknown)))
      out.drawn.push_back(grey);
  }
  const double all = within_free + within_unknown;
  const double by_walls = all < kAnywhere ? 0.5 : (turn_about ? within_unknown : within_free) / all;
  out.sure = std::max(by_walls, turn_about ? free_rim : unknown_rim);
  return out;
}

}  // namespace rubble::scoring
