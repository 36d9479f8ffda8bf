#include "scoring/maps/colours/window_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>
#include <vector>

#include "scoring/maps/colours/half_width.h"

namespace rubble::scoring {
namespace {

using Tone = cv::Vec3f;

constexpr int kGroundSpread = 12;        // of a channel: what JPEG leaves of one colour
constexpr int kOtherColour = 24;         // of a channel: two colours for sure
constexpr double kLeastGround = 0.02;    // of the picture, to begin the view with
constexpr std::size_t kMostGrounds = 6;  // that may do so
constexpr double kLeastView = 0.2;       // of the picture
constexpr int kLeastSide = 60;           // of the view [pixels]
constexpr int kLeastFrame = 8;           // on its broadest side [pixels]
constexpr double kBroaderThanWalls = 3.0;
constexpr double kUnbroken = 0.98;  // of a side of the view that is unknown ground
constexpr int kSmearOfFrame = 16;   // of its colours into the view through JPEG, at the most [pixels]
constexpr double kMuchOfFrame = 0.1, kMostOfFrame = 0.4;
constexpr std::size_t kMostFrameColours = 10;
constexpr double kNothingWithin = 0.003;  // of the view
constexpr double kLeastFree = 0.02;       // of the view
constexpr int kThickestWall = 16;         // [pixels]
constexpr float kOffMixtures = 22.0F;     // off the mixtures of two grounds
constexpr int kFewestMeetings = 20;       // places at which one stands between unknown and free ground
constexpr double kWallsBetween = 0.25;    // of all places at which these meet

constexpr unsigned char kNeither = 0, kUnknownGround = 1, kFreeGround = 2;

float tone_step(const Tone& a, const Tone& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// How far it is from the mixtures of two.
float off_mixtures_of(const Tone& c, const Tone& a, const Tone& b) {
  const Tone way = b - a;
  const float length = way.dot(way);
  const float share = length > 0.0F ? std::clamp((c - a).dot(way) / length, 0.0F, 1.0F) : 0.0F;
  return static_cast<float>(cv::norm(c - a - share * way));
}

cv::Mat near_tone(const cv::Mat& colours, const Tone& tone, int within) {
  const auto bound = [&](double by) { return cv::Scalar(tone[0] + by, tone[1] + by, tone[2] + by); };
  cv::Mat out;
  cv::inRange(colours, bound(-within), bound(within), out);
  return out;
}

/// Colours that cover `least` pixels of those that are not 0 in `of` (empty: of all), the most frequent first.
std::vector<Tone> frequent_tones(const cv::Mat& colours, const cv::Mat& of, double least, std::size_t most) {
  constexpr int kBin = 16, kSide = 256 / kBin;
  struct Bin {
    double count = 0.0;
    cv::Vec3d sum{};
    Tone mean() const { return sum * (1.0 / count); }
  };
  std::vector<Bin> bins(static_cast<std::size_t>(kSide * kSide * kSide));
  for (int y = 0; y < colours.rows; ++y)
    for (int x = 0; x < colours.cols; ++x) {
      if (!of.empty() && of.at<unsigned char>(y, x) == 0) continue;
      const cv::Vec3b& c = colours.at<cv::Vec3b>(y, x);
      Bin& bin = bins[static_cast<std::size_t>((c[0] / kBin * kSide + c[1] / kBin) * kSide + c[2] / kBin)];
      bin.count += 1.0;
      bin.sum += cv::Vec3d(c[0], c[1], c[2]);
    }
  std::vector<Tone> out;
  while (out.size() < most) {
    Bin& best =
        *std::max_element(bins.begin(), bins.end(), [](const Bin& a, const Bin& b) { return a.count < b.count; });
    if (best.count < 0.5 * least || best.count <= 0.0) break;  // a colour may lie half in the next bin
    const Tone centre = best.mean();
    double all = 0.0;
    for (Bin& bin : bins) {
      if (bin.count <= 0.0 || tone_step(bin.mean(), centre) > kGroundSpread) continue;
      all += bin.count;
      bin = {};
    }
    if (all >= least) out.push_back(centre);
  }
  return out;
}

double filled_share(const cv::Mat& mask) {
  return mask.total() == 0 ? 0.0 : cv::countNonZero(mask) / static_cast<double>(mask.total());
}

enum FrameSide { kLeft, kTop, kRight, kBottom };
constexpr std::array<FrameSide, 4> kFourSides{kLeft, kTop, kRight, kBottom};

/// The line of pixels along a side of `view`, so many within it (less than 0: beyond).
cv::Rect line_along(const cv::Rect& view, FrameSide side, int within) {
  const int right = view.x + view.width - 1, bottom = view.y + view.height - 1;
  if (side == kLeft) return {view.x + within, view.y, 1, view.height};
  if (side == kTop) return {view.x, view.y + within, view.width, 1};
  if (side == kRight) return {right - within, view.y, 1, view.height};
  return {view.x, bottom - within, view.width, 1};
}

void move_side(cv::Rect& view, FrameSide side) {
  if (side == kLeft) ++view.x;
  if (side == kTop) ++view.y;
  if (side == kLeft || side == kRight) --view.width;
  if (side == kTop || side == kBottom) --view.height;
}

/// Width of the frame on each side.
std::array<int, 4> frame_of(const cv::Size& picture, const cv::Rect& view) {
  return {view.x, view.y, picture.width - view.x - view.width, picture.height - view.y - view.height};
}

/// The box of the connected ground that reaches farthest; nothing where that is the whole picture, or small.
std::optional<cv::Rect> reach_of(const cv::Mat& ground, cv::Mat& connected) {
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(ground, labels, stats, centres, 4, CV_32S);
  int farthest = 0;
  const auto box_of = [&](int i) {
    return cv::Rect(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                    stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
  };
  for (int i = 1; i < count; ++i)
    if (farthest == 0 || box_of(i).area() > box_of(farthest).area()) farthest = i;
  if (farthest == 0) return std::nullopt;
  const cv::Rect box = box_of(farthest);
  const bool is_all = box.size() == ground.size();
  if (is_all || box.area() < kLeastView * static_cast<double>(ground.total()) ||
      std::min(box.width, box.height) < kLeastSide)
    return std::nullopt;
  connected = labels == farthest;
  return box;
}

/// The box without the lines along its sides that the frame has smeared into; nothing: its sides are not unbroken.
std::optional<cv::Rect> unbroken_box(const cv::Mat& connected, cv::Rect box) {
  std::array<int, 4> moved{};
  for (bool again = true; again;) {
    again = false;
    for (const FrameSide side : kFourSides) {
      if (filled_share(connected(line_along(box, side, 0))) >= kUnbroken) continue;
      if (++moved[side] > kSmearOfFrame) return std::nullopt;
      move_side(box, side);
      again = true;
    }
  }
  return box;
}

/// Without the one or two lines in which the ground is blended with the frame.
cv::Rect unblended_box(const cv::Mat& colours, const Tone& ground, cv::Rect box) {
  constexpr int kBlends = 3, kExact = 3;
  constexpr double kClearly = 0.2;
  for (const FrameSide side : kFourSides)
    for (int i = 0; i < kBlends; ++i) {
      const auto exact = [&](int within) {
        return filled_share(near_tone(colours(line_along(box, side, within)), ground, kExact));
      };
      if (exact(0) + kClearly > exact(1)) break;
      move_side(box, side);
    }
  return box;
}

/// Another colour begins beyond each side that is not the picture's.
bool ends_all_around(const cv::Mat& ground, const cv::Rect& view) {
  constexpr int kBlended = 3;
  constexpr double kMostAlike = 0.1;
  const std::array<int, 4> frame = frame_of(ground.size(), view);
  return std::all_of(kFourSides.begin(), kFourSides.end(), [&](FrameSide side) {
    return frame[side] < kBlended || filled_share(ground(line_along(view, side, -kBlended))) <= kMostAlike;
  });
}

/// What is beyond `box`, the view with the lines that the frame has smeared into, covers nothing within the view.
bool has_colours_of_its_own(const cv::Mat& colours, const cv::Rect& box, const cv::Rect& view) {
  constexpr int kSame = 3, kThickLine = 9;
  cv::Mat frame(colours.size(), CV_8U, cv::Scalar(255));
  frame(box).setTo(0);
  const double all = cv::countNonZero(frame);
  const std::vector<Tone> main = frequent_tones(colours, frame, kMuchOfFrame * all, kMostFrameColours);
  double covered = 0.0;
  for (const Tone& tone : main) {
    covered += cv::countNonZero(near_tone(colours, tone, kGroundSpread) & frame);
    cv::Mat within = near_tone(colours(view), tone, kSame);
    cv::morphologyEx(within, within, cv::MORPH_OPEN, cv::Mat::ones(kThickLine, kThickLine, CV_8U));
    if (filled_share(within) > kNothingWithin) return false;
  }
  return covered >= kMostOfFrame * all;
}

/// Even areas of the view in other colours than its ground's.
cv::Mat other_areas(const cv::Mat& colours, const cv::Mat& ground) {
  constexpr int kEvenSteps = 10, kLeastWidth = 5;
  cv::Mat least, most, steps, out;
  cv::erode(colours, least, cv::Mat::ones(3, 3, CV_8U));
  cv::dilate(colours, most, cv::Mat::ones(3, 3, CV_8U));
  cv::subtract(most, least, steps);
  cv::inRange(steps, cv::Scalar::all(0), cv::Scalar::all(kEvenSteps), out);
  out &= ~ground;
  cv::morphologyEx(out, out, cv::MORPH_OPEN, cv::Mat::ones(kLeastWidth, kLeastWidth, CV_8U));
  return out;
}

/// So few colours that none is a mixture.
bool is_unblended(const cv::Mat& colours) {
  constexpr std::size_t kMost = 32;
  std::set<int> seen;
  for (int y = 0; y < colours.rows; ++y)
    for (int x = 0; x < colours.cols; ++x) {
      const cv::Vec3b& c = colours.at<cv::Vec3b>(y, x);
      if (x > 0 && c == colours.at<cv::Vec3b>(y, x - 1)) continue;
      seen.insert(c[0] << 16 | c[1] << 8 | c[2]);
      if (seen.size() > kMost) return false;
    }
  return true;
}

/// Where unknown and free ground meet: with a wall between, or without.
struct Meetings {
  int walls = 0, direct = 0;
  cv::Vec3d sum{};         ///< of the walls' colours
  double thickness = 0.0;  ///< sum over walls [pixels]

  void count_row(const unsigned char* label, const cv::Vec3b* colour, int length, const Tone& unknown, bool unblended) {
    for (int i = 1; i < length; ++i) {
      if (label[i - 1] == kNeither || label[i] == label[i - 1]) continue;
      const int first = i;
      while (i < length && label[i] == kNeither) ++i;
      if (i == length) return;
      if (label[i] == label[first - 1] || i - first > kThickestWall) continue;
      const Tone free = label[i] == kFreeGround ? colour[i] : colour[first - 1];
      Tone wall;
      float farthest = 0.0F;
      for (int k = first; k < i; ++k) {
        const Tone c = colour[k];
        const float here =
            unblended ? std::min(tone_step(c, unknown), tone_step(c, free)) : off_mixtures_of(c, unknown, free);
        if (here > farthest) farthest = here, wall = c;
      }
      if (farthest <= kOffMixtures) {
        ++direct;
        continue;
      }
      ++walls;
      sum += cv::Vec3d(wall);
      thickness += i - first;
    }
  }
  bool are_walls() const { return walls >= kFewestMeetings && walls >= kWallsBetween * (walls + direct); }
  Tone wall() const { return sum * (1.0 / std::max(1, walls)); }
};

Meetings meetings_of(const cv::Mat& colours, const cv::Mat& labels, const Tone& unknown) {
  const bool unblended = is_unblended(colours);
  Meetings out;
  const auto count = [&](const cv::Mat& label, const cv::Mat& colour) {
    for (int y = 0; y < label.rows; ++y)
      out.count_row(label.ptr(y), colour.ptr<cv::Vec3b>(y), label.cols, unknown, unblended);
  };
  count(labels, colours);
  count(labels.t(), colours.t());
  return out;
}

/// A line in the walls' colour runs along the view, with another colour beyond it: the walls around an arena.
bool is_walled(const cv::Mat& colours, const cv::Rect& view, const Tone& wall) {
  constexpr int kAsWall = 45, kBeside = 20, kBeyond = 6;
  constexpr double kMost = 0.8;
  const std::array<int, 4> frame = frame_of(colours.size(), view);
  int walled = 0;
  for (const FrameSide side : kFourSides) {
    const auto as_wall = [&](int beyond) {
      return filled_share(near_tone(colours(line_along(view, side, -beyond)), wall, kAsWall));
    };
    const auto mean = [&](int beyond) {
      const cv::Scalar of = cv::mean(colours(line_along(view, side, -beyond)));
      return Tone(static_cast<float>(of[0]), static_cast<float>(of[1]), static_cast<float>(of[2]));
    };
    // With nothing beyond it is the border of a window.
    bool here = false;
    for (int d = 1; d <= std::min(kBeside, frame[side] - 1) && !here; ++d) {
      const int beyond = std::min(d + kBeyond, frame[side]);
      here = as_wall(d) >= kMost && as_wall(beyond) < kMost && tone_step(mean(d), mean(beyond)) > kOtherColour;
    }
    walled += here ? 1 : 0;
  }
  return walled >= 2;
}

/// Colours in which broad bars run along the picture's sides, over its whole width or height: a title bar, a panel.
std::vector<Tone> bars_of(const cv::Mat& colours, const cv::Rect& view) {
  constexpr double kOfBar = 0.6;
  std::vector<Tone> out;
  const std::array<int, 4> frame = frame_of(colours.size(), view);
  const cv::Rect all({0, 0}, colours.size());
  for (const FrameSide side : kFourSides) {
    Tone bar;
    int lines = 0;
    for (int i = 0; i < frame[side]; ++i) {
      const cv::Mat line = colours(line_along(all, side, i));
      const std::vector<Tone> main = frequent_tones(line, {}, kOfBar * static_cast<double>(line.total()), 1);
      if (main.empty()) continue;
      lines = lines > 0 && tone_step(main.front(), bar) <= kGroundSpread ? lines + 1 : 1;
      bar = main.front();
      if (lines == kLeastFrame &&
          std::all_of(out.begin(), out.end(), [&](const Tone& t) { return tone_step(t, bar) > kOtherColour; }))
        out.push_back(bar);
    }
  }
  return out;
}

/// A colour that may be the unknown ground's.
struct Candidate {
  Tone tone;
  int spread = kGroundSpread;
};

/// The colours of the picture's areas: to the digit, as a screenshot has them, and with what JPEG leaves of them.
std::vector<Candidate> candidates_in(const cv::Mat& colours) {
  constexpr int kLeastRun = 8, kDigit = 3;
  const double least = kLeastGround * static_cast<double>(colours.total());
  std::map<int, double> count;  // of pixels in runs of one colour
  for (int y = 0; y < colours.rows; ++y) {
    const cv::Vec3b* const row = colours.ptr<cv::Vec3b>(y);
    for (int x = 0; x < colours.cols;) {
      const int first = x;
      while (x < colours.cols && row[x] == row[first]) ++x;
      if (x - first >= kLeastRun) count[row[first][0] << 16 | row[first][1] << 8 | row[first][2]] += x - first;
    }
  }
  std::vector<std::pair<double, int>> most;
  for (const auto& [colour, pixels] : count)
    if (pixels >= least) most.emplace_back(pixels, colour);
  std::sort(most.rbegin(), most.rend());
  if (most.size() > kMostGrounds) most.resize(kMostGrounds);
  std::vector<Candidate> out;
  for (const auto& [pixels, colour] : most)
    out.push_back({Tone(static_cast<float>(colour >> 16), static_cast<float>(colour >> 8 & 255),
                        static_cast<float>(colour & 255)),
                   kDigit});
  for (const Tone& tone : frequent_tones(colours, {}, least, kMostGrounds)) out.push_back({tone});
  return out;
}

/// A rectangle that may be the view.
struct View {
  cv::Rect box;
  bool has_walls = false;  ///< stand between its two grounds; else bars along the picture's sides say that it is one
  bool is_better_than(const View& other) const {
    return has_walls != other.has_walls ? has_walls : box.area() < other.box.area();
  }
};

/// The view that begins with this ground.
std::optional<View> view_on(const cv::Mat& colours, const Candidate& candidate) {
  const Tone& tone = candidate.tone;
  constexpr double kThickLines = 3.0;  // half the width of ground is more [pixels]
  const cv::Mat ground = near_tone(colours, tone, candidate.spread);
  cv::Mat connected;
  const std::optional<cv::Rect> reach = reach_of(ground, connected);
  if (!reach) return std::nullopt;
  const std::optional<cv::Rect> unbroken = unbroken_box(connected, *reach);
  if (!unbroken) return std::nullopt;
  const cv::Rect view = unblended_box(colours, tone, *unbroken);
  const std::array<int, 4> frame = frame_of(colours.size(), view);
  const int broadest = *std::max_element(frame.begin(), frame.end());
  if (broadest < kLeastFrame || !ends_all_around(ground, *reach)) return std::nullopt;
  const cv::Mat within = colours(view);
  cv::Mat labels(view.size(), CV_8U, cv::Scalar(kNeither));
  // Words through JPEG leave even pixels nearly of the ground's colour beside them.
  const cv::Mat free = other_areas(within, near_tone(within, tone, kGroundSpread));
  labels.setTo(kUnknownGround, connected(view));
  labels.setTo(kFreeGround, free);
  if (filled_share(free) < kLeastFree || mean_half_width(connected(view)) <= kThickLines ||
      !has_colours_of_its_own(colours, *reach, view))
    return std::nullopt;
  const Meetings meetings = meetings_of(within, labels, tone);
  const bool has_bars = bars_of(colours, view).size() >= 2;
  if (has_bars && meetings.walls + meetings.direct >= kFewestMeetings) return View{view, meetings.are_walls()};
  if (!meetings.are_walls() || broadest < kBroaderThanWalls * meetings.thickness / meetings.walls ||
      is_walled(colours, view, meetings.wall()))
    return std::nullopt;
  return View{view, true};
}

}  // namespace

std::optional<cv::Rect> view_in_window(const RgbImage& image) {
  if (std::min(image.width, image.height) < kLeastSide) return std::nullopt;
  cv::Mat colours(image.height, image.width, CV_8UC3);
  std::copy(image.rgb.begin(), image.rgb.end(), colours.data);
  std::optional<View> out;
  for (const Candidate& candidate : candidates_in(colours))
    if (const std::optional<View> view = view_on(colours, candidate); view && (!out || view->is_better_than(*out)))
      out = view;
  return out ? std::optional(out->box) : std::nullopt;
}

std::string told_of_frame(const RgbImage& image, const cv::Rect& view) {
  const std::array<int, 4> frame = frame_of({image.width, image.height}, view);
  return cv::format("a window's frame taken off (pixels: left %d, top %d, right %d, bottom %d), ", frame[kLeft],
                    frame[kTop], frame[kRight], frame[kBottom]);
}

RgbImage cut_out(const RgbImage& image, const cv::Rect& view) {
  RgbImage out(view.width, view.height);
  out.white = image.white;
  for (int y = 0; y < view.height; ++y) {
    std::copy_n(image.pixel(view.x, view.y + y), 3 * view.width, out.pixel(0, y));
    if (!image.alpha.empty()) {
      const auto first = image.alpha.begin() + static_cast<std::ptrdiff_t>(image.index(view.x, view.y + y));
      out.alpha.insert(out.alpha.end(), first, first + view.width);
    }
  }
  return out;
}

SampleNotes cut_out(const SampleNotes& notes, const RgbImage& image, const cv::Rect& view) {
  SampleNotes out;
  out.meaning = notes.meaning;
  out.labels = notes.labels;
  for (int y = 0; y < view.height && !notes.no_data.empty(); ++y) {
    const auto first = notes.no_data.begin() + static_cast<std::ptrdiff_t>(image.index(view.x, view.y + y));
    out.no_data.insert(out.no_data.end(), first, first + view.width);
  }
  return out;
}

}  // namespace rubble::scoring
