#include "scoring/maps/colours/sample_classes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/grid.h"
#include "base/text/number_text.h"
#include "scoring/maps/colours/free_mask.h"
#include "scoring/maps/colours/half_width.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/colours/two_class_lines.h"

namespace rubble::scoring {
namespace {

constexpr unsigned char kNoClass = 255;  // pixels of no class
constexpr int kUnknownSquare = 9;        // of ground that is unknown [pixels]
constexpr double kSureOfGround = 0.75;   // of free and unknown ground
constexpr double kMoreOfRim = 0.5;       // of the rim, that one ground has more of than the other
constexpr double kAlikeThin = 1.5;       // times as thick: another class may be the walls
constexpr double kMoreOften = 3.0;       // times as many crossings: it is not
constexpr double kFurtherLines = 0.001;  // of the picture: lines of a further class
constexpr int kWallGrey = 0, kFreeGrey = 255, kBetweenGrey = 128;  // greys of samples that mean something
constexpr std::size_t kMostAsked = 40'000'000;                     // of larger pictures no shapes are asked: memory

/// How often a class is crossed, along rows and columns, with this other class on both sides.
using Crossings = std::vector<std::vector<int>>;

void count_crossings(const unsigned char* at, int length, Crossings& out) {
  for (int i = 0; i < length;) {
    const int begin = i;
    const unsigned char own = at[begin];
    while (i < length && at[i] == own) ++i;
    if (own == kNoClass || i - begin > kWidestLine || begin == 0 || i == length) continue;
    const unsigned char before = at[begin - 1];
    if (before != kNoClass && before == at[i]) ++out[own][before];
  }
}

Crossings crossings_of(const cv::Mat& classes, std::size_t count) {
  Crossings out(count, std::vector<int>(count, 0));
  for (int y = 0; y < classes.rows; ++y) count_crossings(classes.ptr(y), classes.cols, out);
  const cv::Mat columns = classes.t();
  for (int y = 0; y < columns.rows; ++y) count_crossings(columns.ptr(y), columns.cols, out);
  return out;
}

/// Mean distance to the rim [pixels]; 0 of a class that is nowhere.
double class_depth(const cv::Mat& mask) {
  cv::Mat padded;
  cv::copyMakeBorder(mask, padded, 1, 1, 1, 1, cv::BORDER_REPLICATE);
  return mean_half_width(padded);
}

std::vector<double> rim_shares(const cv::Mat& classes, std::size_t count) {
  std::vector<double> out(count, 0.0);
  double all = 0.0;
  const auto ask = [&](int x, int y) {
    const unsigned char c = classes.at<unsigned char>(y, x);
    if (c == kNoClass) return;
    all += 1.0;
    out[c] += 1.0;
  };
  for (int x = 0; x < classes.cols; ++x) ask(x, 0), ask(x, classes.rows - 1);
  for (int y = 0; y < classes.rows; ++y) ask(0, y), ask(classes.cols - 1, y);
  for (double& share : out) share = all > 0.0 ? share / all : 0.0;
  return out;
}

/// What the classes of a picture are by their shapes.
struct Told {
  std::size_t wall = 0, free = 0;
  double sure_of_walls = 0.0, sure_of_ground = 1.0;
  bool lies_in_free = false;      ///< free ground has most of the rim, as no map has it that lies in what is unknown
  bool is_unknown_ground = true;  ///< what is unknown covers areas, or there is none: it is no lines or dots
};

/// The thinnest class with one ground on both its sides; nothing where there is none, or another is like it.
std::optional<std::size_t> walls_among(const Crossings& crossed, const std::vector<double>& depth, double& sure) {
  std::optional<std::size_t> out;
  std::size_t ground = 0, often = 0;
  const auto most = [&](std::size_t i) {
    return static_cast<std::size_t>(std::max_element(crossed[i].begin(), crossed[i].end()) - crossed[i].begin());
  };
  const auto may_be = [&](std::size_t i) {
    const std::size_t other = most(i);
    return crossed[i][other] >= kLeastLines && depth[i] <= kThinLine * depth[other];
  };
  for (std::size_t i = 0; i < crossed.size(); ++i)
    if (may_be(i) && (!out || depth[i] < depth[*out])) out = i;
  if (!out) return out;
  ground = most(*out);
  often = static_cast<std::size_t>(crossed[*out][ground]);
  for (std::size_t i = 0; i < crossed.size(); ++i)
    if (i != *out && may_be(i) && depth[i] < kAlikeThin * depth[*out]) {
      const auto here = static_cast<std::size_t>(crossed[i][most(i)]);
      if (static_cast<double>(here) > kMoreOften * static_cast<double>(often)) return i;  // longer lines
      if (kMoreOften * static_cast<double>(here) > static_cast<double>(often)) return std::nullopt;
    }
  sure = depth[ground] / (depth[ground] + depth[*out]);
  return out;
}

std::optional<Told> told_by_shapes(const cv::Mat& classes, std::size_t count) {
  if (classes.total() > kMostAsked) return std::nullopt;
  const Crossings crossed = crossings_of(classes, count);
  std::vector<double> depth(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) depth[i] = class_depth(classes == static_cast<int>(i));
  Told out;
  const std::optional<std::size_t> wall = walls_among(crossed, depth, out.sure_of_walls);
  if (!wall) return std::nullopt;
  out.wall = *wall;
  const std::vector<int>& within = crossed[out.wall];
  out.free = static_cast<std::size_t>(std::max_element(within.begin(), within.end()) - within.begin());
  const std::vector<double> rim = rim_shares(classes, count);
  double all = 0.0;
  std::size_t next = out.free;  // the ground that may be free instead
  for (std::size_t i = 0; i < count; ++i) {
    all += within[i];
    if (i == out.wall || i == out.free) continue;
    if (next == out.free || within[i] > within[next]) next = i;
    // A further class that is lines as well.
    const double pixels = cv::countNonZero(classes == static_cast<int>(i));
    if (count > 3 && depth[i] < kAlikeThin * depth[out.wall] &&
        pixels >= kFurtherLines * static_cast<double>(classes.total()))
      return std::nullopt;
  }
  out.lies_in_free = rim[out.free] >= kMoreOfRim;
  if (next == out.free) return out;
  double by_walls = within[out.free] / std::max(1.0, all);
  // A map lies in what is unknown, and not in what is free.
  if (rim[out.free] - rim[next] >= kMoreOfRim && within[next] >= kLeastLines) {
    std::swap(out.free, next);
    by_walls = within[out.free] / std::max(1.0, all);
  }
  double unknown_rim = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    if (i != out.wall && i != out.free) unknown_rim += rim[i];
  out.sure_of_ground = std::max(by_walls, unknown_rim);
  cv::Mat unknown = cv::Mat::zeros(classes.size(), CV_8U);
  for (std::size_t i = 0; i < count; ++i)
    if (i != out.wall && i != out.free) unknown |= classes == static_cast<int>(i);
  out.is_unknown_ground = covers_ground(unknown, kUnknownSquare, false);
  return out;
}

std::string sure_text(double share) { return cv::format("%.0f %% sure", 100.0 * share); }

LabelImage unknown_ground(const cv::Size& size) {
  return {cv::Mat(size, CV_8U, cv::Scalar(static_cast<int>(Occupancy::Unknown))), ""};
}

void set_class(LabelImage& out, Occupancy o, const cv::Mat& where) { out.classes.setTo(static_cast<int>(o), where); }

/// Free ground, and all else.
std::optional<LabelImage> classify_two(const cv::Mat& grey, const cv::Mat& none) {
  if (cv::countNonZero(none) > 0 || grey.total() > kMostAsked) return std::nullopt;
  const std::optional<FreeMask> mask = free_mask(grey, none);
  if (!mask) return std::nullopt;
  LabelImage out = unknown_ground(grey.size());
  set_class(out, Occupancy::Free, mask->free);
  set_class(out, Occupancy::Occupied, mask->walls);
  out.doubt = kDoubt + mask->doubt;
  return out;
}

/// P(occupied) or per cent: walls 0, free ground 255, all else between.
LabelImage classify_shares(const cv::Mat& grey, const cv::Mat& none, const std::string& meaning) {
  LabelImage out = unknown_ground(grey.size());
  cv::Mat wall = (grey == kWallGrey) & ~none, free = (grey == kFreeGrey) & ~none;
  out.recognised = meaning;
  const std::string of_free = meaning.rfind("P(", 0) == 0 ? "P(free)" + meaning.substr(meaning.find(')') + 1)
                                                          : "per cent free" + meaning.substr(meaning.find(" from"));
  if (auto two = classify_two(grey, ~(wall | free) | none)) {
    const bool is_free_high = cv::countNonZero((two->classes == static_cast<int>(Occupancy::Free)) & wall) > 0;
    two->recognised = (is_free_high ? of_free : meaning) + ", free ground and all else";
    return *two;
  }
  cv::Mat classes(grey.size(), CV_8U, cv::Scalar(kNoClass));
  classes.setTo(0, wall);
  classes.setTo(1, free);
  const std::optional<Told> told = told_by_shapes(classes, 2);
  if (told && told->wall == 1 && !told->lies_in_free) {
    std::swap(wall, free);
    out.doubt = kDoubt + std::string("if it holds the shares of walls, walls and free ground are exchanged");
    out.recognised = of_free + " and not P(occupied): low values are thin lines with high ones on both sides (" +
                     sure_text(told->sure_of_walls) + ")";
  }
  set_class(out, Occupancy::Occupied, wall);
  set_class(out, Occupancy::Free, free);
  return out;
}

std::string list_of(const std::vector<SampleLabel>& labels) {
  std::string out;
  for (const SampleLabel& label : labels) out += (out.empty() ? "" : ", ") + number_text(label.value);
  return out;
}

LabelImage classify_labels(const cv::Mat& places, const cv::Mat& none, const SampleNotes& notes) {
  const std::vector<SampleLabel>& labels = notes.labels;
  cv::Mat classes = places.clone(), usual(places.size(), CV_8U, cv::Scalar(kBetweenGrey));
  classes.setTo(kNoClass, none);
  for (std::size_t i = 0; i < labels.size(); ++i) usual.setTo(labels[i].grey, classes == static_cast<int>(i));
  const std::string list = "labels " + list_of(labels);
  if (labels.size() == 2) {
    cv::Mat grey(places.size(), CV_8U, cv::Scalar(kFreeGrey));
    grey.setTo(kWallGrey, classes == 1);
    if (auto two = classify_two(grey, none)) {
      const bool is_second = cv::countNonZero((two->classes == static_cast<int>(Occupancy::Free)) & (classes == 1)) > 0;
      two->recognised = list + ", free ground " + number_text(labels[is_second ? 1 : 0].value) + " and all else";
      return *two;
    }
  }
  const std::optional<Told> told = told_by_shapes(classes, labels.size());
  const bool as_usual = told && labels[told->wall].grey == kWallGrey && labels[told->free].grey == kFreeGrey;
  LabelImage out = unknown_ground(places.size());
  if (!notes.meaning.empty() &&
      (!told || as_usual || told->sure_of_ground < kSureOfGround || !told->is_unknown_ground || told->lies_in_free)) {
    out.recognised = notes.meaning;
    set_class(out, Occupancy::Occupied, usual == kWallGrey);
    set_class(out, Occupancy::Free, usual == kFreeGrey);
    return out;
  }
  if (!told) {
    out.refusal = "holds the " + list +
                  ", and the shapes of what has them do not tell which are walls; give P(occupied) from 0 "
                  "to 1 with -1 where it is unknown, or greys with walls 0, unknown ground 205 and free ground 254";
    return out;
  }
  set_class(out, Occupancy::Occupied, classes == static_cast<int>(told->wall));
  set_class(out, Occupancy::Free, classes == static_cast<int>(told->free));
  out.recognised = list + " by their shapes: wall " + number_text(labels[told->wall].value) + " (" +
                   sure_text(told->sure_of_walls) + "), free " + number_text(labels[told->free].value);
  if (labels.size() > 2) {
    out.recognised += " (" + sure_text(told->sure_of_ground) + "), unknown";
    std::string comma;
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (i != told->wall && i != told->free) out.recognised += comma + " " + number_text(labels[i].value), comma = ",";
    if (told->sure_of_ground < kSureOfGround || !told->is_unknown_ground)
      out.doubt = kDoubt + std::string("free and unknown ground may be the other way round");
  }
  return out;
}

}  // namespace

LabelImage classify_samples(const RgbImage& image, const SampleNotes& notes) {
  cv::Mat grey(image.height, image.width, CV_8U), none = cv::Mat::zeros(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      grey.at<unsigned char>(y, x) = image.pixel(x, y)[0];
      if (!notes.no_data.empty() && notes.no_data[image.index(x, y)] != 0) none.at<unsigned char>(y, x) = 255;
    }
  return notes.labels.empty() ? classify_shares(grey, none, notes.meaning) : classify_labels(grey, none, notes);
}

}  // namespace rubble::scoring
