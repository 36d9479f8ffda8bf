#include "scoring/maps/colours/map_colours.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>

#include "scoring/maps/colours/added_drawings.h"
#include "scoring/maps/colours/canvas_corners.h"
#include "scoring/maps/colours/colour_scale.h"
#include "scoring/maps/colours/coloured_areas.h"
#include "scoring/maps/colours/costmap_colours.h"
#include "scoring/maps/colours/dither.h"
#include "scoring/maps/colours/even_light.h"
#include "scoring/maps/colours/free_mask.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/league_classes.h"
#include "scoring/maps/colours/league_colours.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/lettering.h"
#include "scoring/maps/colours/lossy_tones.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/colours/sample_classes.h"
#include "scoring/maps/colours/turned_canvas.h"
#include "scoring/maps/colours/window_frame.h"

namespace rubble::scoring {

namespace {

/// A layer over some other picture, whose free ground lets that show through.
struct Layer {
  cv::Mat free;     ///< 255: transparent
  cv::Mat unknown;  ///< 255: the opaque ground
  int ground = 0;   ///< its grey
};

/// The opaque pixels of a layer have walls and one ground, that ground is all around, and what is transparent lies
/// within it. Elsewhere what is transparent is unknown.
std::optional<Layer> layer_of(const RgbImage& image, const cv::Mat& transparent) {
  constexpr double kLeastLayer = 0.02;  // of the picture
  constexpr double kMostOfRim = 0.02;   // that is transparent
  constexpr double kGroundOfRim = 0.5;
  constexpr int kAsGround = 6;            // difference of its pixels
  constexpr double kLeastOfGround = 0.9;  // of the opaque pixels that are no lines
  if (cv::countNonZero(transparent) < kLeastLayer * static_cast<double>(transparent.total())) return std::nullopt;
  const cv::Mat grey = grey_of(image);
  std::array<int, 256> rim{};
  int all = 0, open = 0;
  const auto ask = [&](int x, int y) {
    ++all;
    if (transparent.at<unsigned char>(y, x) != 0)
      ++open;
    else
      ++rim[grey.at<unsigned char>(y, x)];
  };
  for (int x = 0; x < grey.cols; ++x) ask(x, 0), ask(x, grey.rows - 1);
  for (int y = 0; y < grey.rows; ++y) ask(0, y), ask(grey.cols - 1, y);
  const auto most = std::max_element(rim.begin(), rim.end());
  if (open > kMostOfRim * all || *most < kGroundOfRim * all) return std::nullopt;
  const int ground = static_cast<int>(most - rim.begin());
  const cv::Mat opaque = ~transparent, of_ground = (grey >= ground - kAsGround) & (grey <= ground + kAsGround) & opaque;
  cv::Mat areas;
  constexpr int kLine = 9;  // wider ones are areas [pixels]
  cv::morphologyEx(opaque, areas, cv::MORPH_OPEN, cv::Mat::ones(kLine, kLine, CV_8U));
  const bool is_layer = cv::countNonZero(of_ground) >= kLeastOfGround * cv::countNonZero(areas) &&
                        cv::countNonZero(opaque & ~of_ground) > 0;
  return is_layer ? std::optional(Layer{transparent.clone(), of_ground, ground}) : std::nullopt;
}

/// The grey for what is transparent, by which it is told from the ground around.
RgbImage shown(const RgbImage& image, const Layer& layer) {
  constexpr int kTold = 15, kWhite = 255, kGrey = 190;
  RgbImage out = image;
  if (std::abs(layer.ground - int{league::kUnexplored[1]}) >= kTold) return out;  // blended it is told already
  const int grey = kWhite - layer.ground >= kTold ? kWhite : kGrey;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (layer.free.at<unsigned char>(y, x) != 0) std::fill_n(out.pixel(x, y), 3, static_cast<std::uint8_t>(grey));
  return out;
}

/// Pixels that the file says are no data. Tags that programs set unasked also cover the walls: thin lines stay.
cv::Mat no_data_areas(const RgbImage& image, const SampleNotes& notes) {
  cv::Mat out = cv::Mat::zeros(image.height, image.width, CV_8U);
  if (notes.no_data.empty()) return out;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (notes.no_data[image.index(x, y)] != 0) out.at<unsigned char>(y, x) = 255;
  cv::Mat areas;
  cv::Mat near;
  cv::copyMakeBorder(out, areas, 8, 8, 8, 8, cv::BORDER_CONSTANT, cv::Scalar(255));
  cv::morphologyEx(areas, areas, cv::MORPH_OPEN, cv::Mat::ones(9, 9, CV_8U));
  areas = areas(cv::Rect(8, 8, image.width, image.height)).clone();
  if (10 * cv::countNonZero(areas) >= 9 * cv::countNonZero(out)) return out;
  cv::dilate(areas, near, cv::Mat::ones(3, 3, CV_8U));
  return near & out;
}

/// Coloured lines were taken for drawings, but what is left for walls is much paler and less than they.
bool are_walls_among_the_drawings(const cv::Mat& before, const cv::Mat& after, const cv::Mat& walls) {
  constexpr int kPaler = 60;
  constexpr int kShare = 5;  // one in so many
  const cv::Mat drawn = before != after;
  const int count = cv::countNonZero(walls);
  if (count == 0) return false;
  const double wall = cv::mean(after, walls)[0];
  return kShare * cv::countNonZero(drawn & (before < wall - kPaler)) >= count;
}

/// Areas of it, not only lines.
bool is_coloured(const RgbImage& image) {
  constexpr int kColoured = 24;
  constexpr std::size_t kOneIn = 10;
  std::size_t coloured = 0;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    coloured += high - low >= kColoured ? 1 : 0;
  }
  return kOneIn * coloured >= image.rgb.size() / 3;
}

/// Larger ones would take more memory than is promised (docs/reliability.md).
bool small_enough(const RgbImage& image) {
  constexpr std::size_t kMostPixels = 40'000'000;
  return image.rgb.size() / 3 <= kMostPixels;
}

/// Walls and ground that was never seen have one grey.
LabelImage classify_mask(const FreeMask& mask) {
  LabelImage out{cv::Mat(mask.free.size(), CV_8U, cv::Scalar(static_cast<int>(Occupancy::Unknown))), mask.recognised};
  out.classes.setTo(static_cast<int>(Occupancy::Free), mask.free);
  out.classes.setTo(static_cast<int>(Occupancy::Occupied), mask.walls);
  out.doubt = kDoubt + mask.doubt;
  out.by_level = true;
  return out;
}

/// Of evenly bright greys, their canvas taken off. `given`: as they were before any colour was changed; empty: there
/// are too many, or they were dots.
LabelImage classify_levels(const cv::Mat& grey, const cv::Mat& given, const cv::Mat& nothing) {
  const TurnedCanvas turned = canvas_of_the_walls_grey(grey);
  if (turned.mask.empty() && !given.empty())
    if (const std::optional<FreeMask> mask = free_mask(given, nothing)) return classify_mask(*mask);
  const cv::Mat canvas = turned.mask.empty() ? canvas_corners(grey) : turned.mask;
  cv::Mat levels = grey.clone(), apart = canvas.clone();
  if (turned.ground >= 0) {  // the map's margin goes on
    levels.setTo(turned.ground, canvas);
    apart.setTo(0);
  }
  LabelImage out = classify_grey(levels, nothing | apart, apart);
  out.classes.setTo(static_cast<int>(Occupancy::Unknown), canvas);
  if (cv::countNonZero(canvas) > 0) out.recognised += ", corners of the canvas are unknown";
  return out;
}

LabelImage classify_by_grey(const RgbImage& image, const cv::Mat& nothing) {
  const bool small = small_enough(image);
  const std::optional<GreyedAreas> areas = small ? greys_of_coloured_areas(image, nothing) : std::nullopt;
  cv::Mat grey = areas ? areas->grey : grey_of(image);
  double least = 0.0, most = 0.0;
  cv::minMaxLoc(grey, &least, &most);
  if (least == most)
    return {cv::Mat(grey.size(), CV_8U, cv::Scalar(static_cast<int>(Occupancy::Unknown))),
            "of one colour: nothing is drawn on it"};
  const std::optional<Undithered> undithered = small ? without_dither(grey) : std::nullopt;
  if (undithered) grey = undithered->grey;
  const std::optional<EvenLight> even = with_even_light(grey);
  if (even) grey = even->grey;
  const cv::Mat as_it_was = grey.clone();
  const bool painted = !areas && paint_over_colours(image, nothing, grey);
  const bool many_pens = !areas && !painted && even_out_coloured_walls(image, nothing, grey);
  LabelImage out = classify_levels(grey, small && !undithered ? grey_of(image) : cv::Mat(), nothing);
  if (undithered && out.refusal.empty()) out.refusal = undithered->lost;
  if (undithered) out.recognised += ", " + undithered->how;
  if (even) out.recognised += ", darker by up to " + std::to_string(even->differed) + " towards its rim before";
  if (areas) out.recognised += ", " + areas->how;
  out.by_level |= areas || undithered;
  if (even && is_coloured(image))
    out.refusal = "is not evenly bright (ground of one kind differs by " + std::to_string(even->differed) +
                  " of 255 over the picture, as in a photograph), and coloured; give it as the robot saved it";
  if (painted) out.recognised += ", coloured drawings removed";
  if (many_pens) out.recognised += ", lines in many colours are walls";
  if (painted && are_walls_among_the_drawings(as_it_was, grey, out.classes == static_cast<int>(Occupancy::Occupied)))
    out.refusal =
        "has dark lines in colour and pale grey ones, and nothing says which are walls; give it in the league's "
        "colours, or draw walls "
        "in black";
  if (out.refusal.empty() && erase_lettering(out.classes) > 0) out.recognised += ", words on free ground removed";
  if (clear_around_panel(out.classes)) out.recognised += ", what stands around the map is unknown";
  return out;
}

/// By its greys, which tell its walls; what else it is says the file.
LabelImage classify_layer(const RgbImage& image, const Layer& layer, const cv::Mat& nothing) {
  LabelImage out = classify_by_grey(shown(image, layer), nothing);
  out.classes.setTo(static_cast<int>(Occupancy::Unknown), layer.unknown);
  out.classes.setTo(static_cast<int>(Occupancy::Free), layer.free);
  out.recognised += ", what is transparent is ground";
  return out;
}

/// `scale`: the colour scale whose values the picture's greys are; empty: it is as it was given.
ClassImage classify_as(const RgbImage& original, const SampleNotes& notes, const std::string& scale) {
  ClassImage out;
  const bool direct = notes.are_measured();
  std::optional<RestoredColours> restored = direct ? std::nullopt : restored_league_colours(original);
  const RgbImage& image = restored ? restored->image : original;
  const Blur undone = restored ? restored->blur : Blur{};
  out.is_league = undone.sigma > 0.0 || (!direct && is_league_map(image));
  cv::Mat nothing = transparent_pixels(image);
  const std::optional<LabelImage> costmap =
      direct || out.is_league || !small_enough(image) ? std::nullopt : classify_costmap(image);
  const std::optional<Layer> layer = direct || out.is_league || costmap ? std::nullopt : layer_of(image, nothing);
  if (layer) nothing.setTo(0);
  nothing |= no_data_areas(image, notes);
  const LabelImage labels = direct          ? classify_samples(image, notes)
                            : costmap       ? *costmap
                            : layer         ? classify_layer(image, *layer, nothing)
                            : out.is_league ? classify_league(image, undone)
                                            : classify_by_grey(image, nothing);
  out.recognised = labels.recognised;
  out.refusal = labels.refusal;
  if (!scale.empty()) out.recognised += ", values of the colour scale " + scale;
  if (restored) out.recognised += ", " + restored->how;
  if (!direct && !costmap && (undone.sigma == 0.0 || !out.refusal.empty()))
    if (const std::string why = why_colours_are_lost(image, is_league_map(image)); !why.empty()) out.refusal = why;
  if (image.white > 0)
    out.recognised += ", scaled so that the brightest sample, " + std::to_string(image.white) + ", is white";
  out.recognised += (restored ? restored->doubt : "") + labels.doubt;
  if (out.is_league && !labels.by_level && small_enough(original) && out.refusal.empty())
    out.recognised += doubt_about_tones(image);
  if (!direct && small_enough(original) && out.refusal.empty())
    out.recognised +=
        doubts_about(undone.sigma > 0.0 ? image : original, restored && restored->as_drawn ? image : original,
                     {labels.classes, out.is_league, labels.by_level, costmap.has_value(), !scale.empty()});
  cv::Mat classes = labels.classes;
  classes.setTo(static_cast<int>(Occupancy::Unknown), nothing);
  clear_canvas_corners(classes);
  if (out.is_league && clear_around_league_map(classes)) out.recognised += ", what stands around the map is unknown";
  out.classes = Grid<Occupancy>(GridFrame{image.width, image.height, 1.0, 0.0, 0.0});
  for (int y = 0; y < image.height; ++y) {
    const unsigned char* row = classes.ptr<unsigned char>(image.height - 1 - y);
    for (int x = 0; x < image.width; ++x) out.classes[{x, y}] = static_cast<Occupancy>(row[x]);
  }
  if (restored) out.restored = std::move(restored->image);
  return out;
}

/// Of a picture that is all map, or nearly.
ClassImage classify_map(const RgbImage& image, const SampleNotes& notes) {
  if (!notes.are_measured() && small_enough(image))
    if (const std::optional<ScaledValues> values = values_of_colour_scale(image))
      return classify_as(values->greys, notes, values->name);
  return classify_as(image, notes, "");
}

/// The picture that was in the view with nothing but unexplored ground around.
RgbImage set_into(const RgbImage& around, const cv::Rect& view, const RgbImage& within) {
  RgbImage out(around.width, around.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const bool is_within = view.contains({x, y});
      const std::uint8_t* const from = is_within ? within.pixel(x - view.x, y - view.y) : league::kUnexplored.data();
      std::copy_n(from, 3, out.pixel(x, y));
    }
  return out;
}

/// What is around the view is unknown: the map keeps the picture's size, and with it its place.
ClassImage classify_view(const RgbImage& image, const SampleNotes& notes, const cv::Rect& view) {
  const RgbImage within = cut_out(image, view);
  ClassImage out = classify_map(within, cut_out(notes, image, view));
  out.recognised = told_of_frame(image, view) + out.recognised;
  if (!out.refusal.empty()) return out;
  Grid<Occupancy> classes(GridFrame{image.width, image.height, 1.0, 0.0, 0.0}, Occupancy::Unknown);
  const int low = image.height - view.y - view.height;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) classes[{view.x + x, low + y}] = out.classes[{x, y}];
  out.classes = std::move(classes);
  if (out.is_league) out.restored = set_into(image, view, out.restored ? *out.restored : within);
  return out;
}

}  // namespace

ClassImage classify(const RgbImage& image, const SampleNotes& notes) {
  if (!notes.are_measured() && small_enough(image))
    if (const std::optional<cv::Rect> view = view_in_window(image)) return classify_view(image, notes, *view);
  return classify_map(image, notes);
}

}  // namespace rubble::scoring
